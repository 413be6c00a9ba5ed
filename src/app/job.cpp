// Gathers a job's tools and stock.
#include "app/job.h"

#include <algorithm>
#include <fmt/format.h>

#include "kerf/machine_files.h"
#include "kerf/number.h"
#include "kerf/stock_files.h"
#include "kerf/tool_files.h"

namespace kerf::app {

const char* const kJobHelp =
    R"(
Tools (--tool), the last word over tool files, the program's comments and the built-in table:
  --tool "square d=3.175 flute=12.7"   for every tool number that has no --tool N=... of its own,
                                       and for programs without a tool change
  --tool 2="V d=12.7 angle=90"         for tool 2
  --tool 2=301                         tool 2 is the built-in tool 301 (see: kerf tools list)
Stock (--stock), lengths in mm or with "in"; else the program's comments, else a block around the cuts:
  --stock "100x60x12"                  program zero at the lower left of the top
  --stock "100x60x12 at centre bottom" or lower-left, top-right ..., top or bottom
  --stock "0,0,-12 to 100,60,0"        lowest and highest corner
)";

namespace {

const Length kStockMargin = mm(2);  // of an assumed block, beyond the largest tool's radius
const Length kStockFloor = mm(1);   // of an assumed block, below the deepest cut

/// Splits "102=square d=3" or "102 = square d=3" into 102 and the rest; no number where none stands before
/// the first '='.
std::pair<std::optional<int>, std::string_view> split_number(std::string_view text) {
  constexpr std::size_t kMostDigits = 9;  // fits an int
  const std::size_t digits = text.find_first_not_of("0123456789");
  const std::size_t equals = text.find_first_not_of(' ', digits);
  if (digits == 0 || digits > kMostDigits || equals == std::string_view::npos || text[equals] != '=')
    return {std::nullopt, text};
  const std::size_t rest = std::min(text.find_first_not_of(' ', equals + 1), text.size());
  return {std::stoi(std::string(text.substr(0, digits))), text.substr(rest)};
}

void read_tool_files(const std::vector<std::string>& names, JobSettings& settings, Diagnostics& diagnostics) {
  for (const std::string& name : names) {
    const auto file = InputFile::open(name, diagnostics);
    if (!file) continue;
    ToolTable table;
    read_tool_file(file->bytes(), name, table, diagnostics);
    for (const auto& [number, tool] : table.tools()) {
      settings.table.set(number, tool);
      settings.from_file[number] = name;
    }
  }
}

/// The tool numbers of a path in order of first use, and whether something is cut before the first tool
/// change.
struct Uses {
  std::vector<int> numbers;
  bool cuts_before = false;
  bool motions_before = false;
};

Uses uses_of(const Toolpath& path) {
  Uses uses;
  for (const Step& s : path.steps()) {
    if (s.kind() == StepKind::tool_change) {
      const int number = s.tool_change().tool;
      if (std::find(uses.numbers.begin(), uses.numbers.end(), number) == uses.numbers.end())
        uses.numbers.push_back(number);
    }
    if (!uses.numbers.empty() || !s.is_motion()) continue;
    uses.motions_before = true;
    uses.cuts_before = uses.cuts_before || s.is_cutting();
  }
  return uses;
}

/// The tool for what comes before any tool change: the one option, else the one tool that the program
/// describes.
std::optional<std::pair<Tool, ToolSource>> tool_for_start(const LoadedProgram& program,
                                                          const JobSettings& settings, const Uses& uses) {
  if (settings.any_number) return {{*settings.any_number, ToolSource::option}};
  if (!uses.numbers.empty()) return std::nullopt;
  if (settings.numbered.size() == 1) return {{settings.numbered.begin()->second, ToolSource::option}};
  if (settings.numbered.empty() && program.tools.size() == 1)
    return {{program.tools.begin()->second, ToolSource::comment}};
  return std::nullopt;
}

Toolpath with_tool_before(const Toolpath& path, int number) {
  Toolpath out;
  out.reserve(path.size() + 1);
  out.origins() = path.origins();
  out.add(step::ToolChange{number}, OriginId::none);
  for (std::size_t i = 0; i < path.size(); ++i) out.add_copy(path, i);
  return out;
}

/// Gives motions before the first tool change a tool, where something tells which.
void give_start_tool(Job& job, const JobSettings& settings, const Uses& uses) {
  if (!uses.motions_before) return;
  const auto chosen = tool_for_start(job.program, settings, uses);
  if (!chosen) return;
  int number = std::max(chosen->first.number, 1);
  while (std::find(uses.numbers.begin(), uses.numbers.end(), number) != uses.numbers.end()) ++number;
  job.program.path = with_tool_before(job.program.path, number);
  job.tools.set(number, chosen->first);
  job.tool_sources[number] = chosen->second;
}

struct Choice {
  const Tool* tool = nullptr;
  ToolSource source = ToolSource::unknown;
};

/// Where the program first asks for a tool.
Origin first_use_of(int number, const Toolpath& path) {
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].kind() == StepKind::tool_change && path[i].tool_change().tool == number)
      return path.origin_of(i);
  return {};
}

Choice choose(int number, const LoadedProgram& program, const JobSettings& settings,
              Diagnostics& diagnostics) {
  if (const auto it = settings.numbered.find(number); it != settings.numbered.end())
    return {&it->second, ToolSource::option};
  if (settings.any_number) return {&*settings.any_number, ToolSource::option};
  const Tool* in_table = settings.table.find(number);
  const auto described = program.tools.find(number);
  const Tool* in_comment = described == program.tools.end() ? nullptr : &described->second;
  const Tool* chosen = choose_tool(in_table, in_comment, first_use_of(number, program.path), diagnostics);
  if (chosen == nullptr) return {};
  if (chosen == in_comment) return {chosen, ToolSource::comment};
  return {chosen, settings.from_file.count(number) > 0 ? ToolSource::file : ToolSource::built_in};
}

/// An unknown shape: an error where it is needed, else a warning.
Diagnostic& tell(UnknownTool unknown, Origin where, std::string message, Diagnostics& diagnostics) {
  if (unknown != UnknownTool::warning)
    return diagnostics.error(Code::no_tool_shape, std::move(where), message);
  return diagnostics.warning(Code::no_tool_shape, std::move(where), message);
}

void tell_no_tool(const Toolpath& path, UnknownTool unknown, Diagnostics& diagnostics) {
  const auto& steps = path.steps();
  const auto first = std::find_if(steps.begin(), steps.end(), [](const Step& s) { return s.is_cutting(); });
  tell(unknown, path.origin_of(static_cast<std::size_t>(first - steps.begin())),
       "the program cuts before any tool change, and does not describe its tool", diagnostics)
      .hint = "tell the tool, e.g. --tool \"square d=3.175 flute=12.7\"";
}

void choose_tools(Job& job, const JobSettings& settings, UnknownTool unknown, Diagnostics& diagnostics) {
  const Uses uses = uses_of(job.program.path);
  give_start_tool(job, settings, uses);
  if (uses.cuts_before && job.tool_sources.empty() && unknown != UnknownTool::error_if_numbered)
    tell_no_tool(job.program.path, unknown, diagnostics);
  for (const int number : uses.numbers) {
    const Choice choice = choose(number, job.program, settings, diagnostics);
    job.tool_sources[number] = choice.source;
    if (choice.tool == nullptr) {
      tell(unknown, first_use_of(number, job.program.path),
           fmt::format("nobody knows the shape of tool {}", number), diagnostics)
          .hint = fmt::format("tell it, e.g. --tool {}=\"square d=3.175 flute=12.7\"", number);
      continue;
    }
    Tool tool = *choice.tool;
    tool.number = number;
    job.tools.set(number, std::move(tool));
  }
  if (settings.any_number && uses.numbers.size() > 1 + settings.numbered.size())
    diagnostics.note(Code::tool_option_wide, {},
                     fmt::format("--tool without a number stands for {} tool numbers of the program",
                                 uses.numbers.size()));
}

void choose_stock(Job& job, const JobSettings& settings, Diagnostics& diagnostics) {
  job.stock = settings.stock;
  job.stock_source = StockSource::option;
  if (job.stock) return;
  job.stock = job.program.stock;
  job.stock_source = StockSource::program;
  if (job.stock) return;
  job.stock_source = StockSource::unknown;
  const Box3& cuts = job.report.all.cut_bounds;
  if (cuts.empty()) return;
  double radius = 0.0;
  for (const auto& [number, tool] : job.tools.tools()) radius = std::max(radius, tool.diameter.mm() / 2.0);
  job.stock = stock_around(cuts, mm(radius) + kStockMargin, kStockFloor);
  job.stock_source = StockSource::assumed;
  const Box3& b = job.stock->block;
  const Point3 size = b.size();
  diagnostics
      .note(Code::stock_assumed, TextSpot{job.program.source, 0, 0},
            fmt::format("the program does not tell its stock; assumed {} x {} x {} mm around the cuts, from "
                        "X{} Y{} Z{} to X{} Y{} Z{}",
                        number_text(size.x, 3), number_text(size.y, 3), number_text(size.z, 3),
                        number_text(b.low.x, 3), number_text(b.low.y, 3), number_text(b.low.z, 3),
                        number_text(b.high.x, 3), number_text(b.high.y, 3), number_text(b.high.z, 3)))
      .hint = "tell it with --stock";
}

}  // namespace

void add_job_options(CLI::App& app, JobOptions& options) {
  add_program(app, options.file);
  add_repeated(app, "-t,--tool", options.tools, "SPEC",
               "A tool's shape, for tool N or for all: [N=]SPEC (see below)");
  add_repeated(app, "--tools", options.tool_files, "PATH", "A file of tools (TOML)");
  app.add_option("--stock", options.stock, "The stock: SIZE [at PLACE] or LOW to HIGH (see below)")
      ->type_name("SPEC");
}

void add_machine_option(CLI::App& app, JobOptions& options) {
  app.add_option("--machine", options.machine, "The machine: a profile (TOML) or what GRBL answers to $$")
      ->type_name("PATH");
}

JobSettings read_job_options(const JobOptions& options, Diagnostics& usage, Diagnostics& diagnostics) {
  JobSettings settings;
  settings.table = built_in_tools();
  for (const std::string& text : options.tools) {
    const auto [number, spec] = split_number(text);
    std::optional<Tool> tool = read_tool_option(spec, usage);
    if (!tool) continue;
    if (number) {
      tool->number = *number;
      settings.numbered.insert_or_assign(*number, std::move(*tool));
    } else {
      settings.any_number = std::move(tool);
    }
  }
  if (!options.stock.empty())
    settings.stock = read_stock_option(options.stock, CallSpot{"", 0, "--stock"}, usage);
  read_tool_files(options.tool_files, settings, diagnostics);
  if (!options.machine.empty())
    if (const auto file = InputFile::open(options.machine, diagnostics))
      settings.input.machine = read_machine_file(file->bytes(), options.machine, diagnostics);
  return settings;
}

std::string_view to_string(ToolSource source) {
  switch (source) {
    case ToolSource::option: return "option";
    case ToolSource::comment: return "comment";
    case ToolSource::file: return "tool file";
    case ToolSource::built_in: return "built in";
    case ToolSource::unknown: break;
  }
  return "unknown";
}

std::string_view to_string(StockSource source) {
  switch (source) {
    case StockSource::option: return "option";
    case StockSource::program: return "program";
    case StockSource::assumed: return "assumed";
    case StockSource::unknown: break;
  }
  return "unknown";
}

Job make_job(LoadedProgram program, const JobSettings& settings, const ReportOptions& report,
             UnknownTool unknown, Diagnostics& diagnostics) {
  Job job;
  job.program = std::move(program);
  choose_tools(job, settings, unknown, diagnostics);
  job.report = report_on(job.program.path, report);
  choose_stock(job, settings, diagnostics);
  return job;
}

std::string short_name(const Tool& tool) {
  return fmt::format("{} {} mm", name_of(tool.shape), number_text(tool.diameter.mm(), 3));
}

}  // namespace kerf::app

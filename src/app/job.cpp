// Gathers a job's tools and stock.
#include "app/job.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "kerf/assumed_stock.h"
#include "kerf/check.h"
#include "kerf/machine_files.h"
#include "kerf/names.h"
#include "kerf/number.h"
#include "kerf/stock_files.h"
#include "kerf/tool_files.h"

namespace kerf::app {

const char* const kToolHelp =
    R"(
Tools (--tool), the last word over tool files, the program's comments and the built-in table:
  --tool "square d=3.175 flute=12.7"   for every tool number that has no --tool N=... of its own,
                                       and for programs without a tool change
  --tool 2="V d=12.7 angle=90"         for tool 2
  --tool 2=301                         tool 2 is the built-in tool 301 (see: kerf tools list)
                                       all shapes and keys (neck_length, teeth ...): kerf tools shapes
)";

const char* const kStockHelp =
    R"(Stock (--stock), lengths in mm or with "in"; else the program's comments, else a block around the cuts:
  --stock "100x60x12"                  program zero at the lower left of the top
  --stock "100x60x12 at centre bottom" or lower-left, top-right ..., top or bottom
  --stock "0,0,-12 to 100,60,0"        lowest and highest corner
)";

namespace {

const Length kStockMargin = mm(2);  // of an assumed block, beyond the largest tool's radius
const Length kStockFloor = mm(1);   // of an assumed block, below the deepest cut

constexpr int kHighestToolNumber = 999'999'999;

/// "[N=]SPEC" taken apart.
struct ToolOption {
  std::optional<int> number;
  std::string_view spec;
};

/// Splits "102=square d=3" or "102 = square d=3" into 102 and the rest; no number where words stand before
/// the first '='. Nothing, with an error, where the number or the tool is missing or cannot be.
std::optional<ToolOption> split_tool_option(std::string_view text, const Origin& where, Diagnostics& usage) {
  const auto wrong = [&](std::string message) {
    usage.error(Code::tool_value_type, where, std::move(message)).hint =
        "expected [N=]SPEC, e.g. \"square d=3.175 flute=12.7\", 2=\"V d=12.7 angle=90\" or 2=301";
    return std::nullopt;
  };
  const std::size_t equals = text.find('=');
  const std::string_view before = trim(text.substr(0, equals));
  if (equals == std::string_view::npos)
    return before.empty() ? wrong("the tool is missing") : std::optional(ToolOption{{}, before});
  if (before.empty()) return wrong("there is no tool number before \"=\"");
  if (before.find_first_not_of("0123456789+-.") != std::string_view::npos) return ToolOption{{}, text};
  const auto number = parse_number(before);
  if (!number || *number < 0.0 || *number > kHighestToolNumber || *number != std::floor(*number))
    return wrong(fmt::format("{} is no tool number: expected a whole number from 0 to {}",
                             before.substr(0, 40), kHighestToolNumber));
  const std::string_view spec = trim(text.substr(equals + 1));
  if (spec.empty()) return wrong(fmt::format("what tool {} is does not stand behind \"=\"", before));
  return ToolOption{static_cast<int>(*number), spec};
}

void read_tool_option_of(const std::string& text, ToolSettings& settings, Diagnostics& usage) {
  const Origin where = CallSpot{"", 0, fmt::format("--tool \"{}\"", text.substr(0, 80))};
  const auto option = split_tool_option(text, where, usage);
  if (!option) return;
  std::optional<Tool> tool = read_tool_option(option->spec, where, usage);
  if (!tool) return;
  if (option->number) {
    tool->number = *option->number;
    settings.numbered.insert_or_assign(*option->number, std::move(*tool));
  } else {
    settings.any_number = std::move(tool);
  }
}

void read_tool_files(const std::vector<std::string>& names, ToolSettings& settings,
                     Diagnostics& diagnostics) {
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
  if (settings.tools.any_number) return {{*settings.tools.any_number, ToolSource::option}};
  if (!uses.numbers.empty()) return std::nullopt;
  if (settings.tools.numbered.size() == 1)
    return {{settings.tools.numbered.begin()->second, ToolSource::option}};
  if (settings.tools.numbered.empty() && program.tools.size() == 1)
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

Choice choose(int number, const LoadedProgram& program, const ToolSettings& settings,
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

/// A --tool N=... for a tool that the program does not use is most often a slip in the number.
void tell_unused_options(const Job& job, const JobSettings& settings, const Uses& uses,
                         Diagnostics& diagnostics) {
  const bool for_start =
      uses.numbers.empty() && settings.tools.numbered.size() == 1 && !settings.tools.any_number;
  for (const auto& [number, tool] : settings.tools.numbered) {
    if (job.tool_sources.count(number) > 0 || for_start) continue;
    std::vector<std::string> used;
    for (const int n : uses.numbers) used.push_back(std::to_string(n));
    diagnostics
        .warning(Code::option_unused, CallSpot{"", 0, fmt::format("--tool {}=...", number)},
                 fmt::format("the program never uses tool {}", number))
        .hint = used.empty() ? "it has no tool change at all; --tool SPEC, without a number, is for all tools"
                             : "it uses tool " + list_text(used);
  }
}

/// An unknown shape: an error where it is needed, else a warning.
Diagnostic& tell(UnknownTool unknown, Origin where, std::string message, Diagnostics& diagnostics) {
  if (unknown == UnknownTool::error) return diagnostics.error(Code::no_tool_shape, std::move(where), message);
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
  if (uses.cuts_before && job.tool_sources.empty() && unknown != UnknownTool::told_elsewhere)
    tell_no_tool(job.program.path, unknown, diagnostics);
  for (const int number : uses.numbers) {
    const Choice choice = choose(number, job.program, settings.tools, diagnostics);
    job.tool_sources[number] = choice.source;
    if (choice.tool == nullptr && unknown == UnknownTool::told_elsewhere) continue;
    if (choice.tool == nullptr) {
      tell(unknown, first_use_of(number, job.program.path),
           fmt::format("nobody knows the shape of tool {}", number), diagnostics)
          .hint = hint_for_unknown(number);
      continue;
    }
    Tool tool = *choice.tool;
    tool.number = number;
    job.tools.set(number, std::move(tool));
  }
  tell_unused_options(job, settings, uses, diagnostics);
  if (settings.tools.any_number && uses.numbers.size() > 1 + settings.tools.numbered.size())
    diagnostics.note(Code::tool_option_wide, {},
                     fmt::format("--tool without a number stands for {} tool numbers of the program",
                                 uses.numbers.size()));
}

std::string_view reason_of(AssumedTop top) {
  switch (top) {
    case AssumedTop::passes: return "a pass above the highest one";
    case AssumedTop::plunge: return "where the plunges begin";
    case AssumedTop::cuts: return "at the highest cut";
    case AssumedTop::zero: break;
  }
  return "at Z0";
}

/// Says which block is taken, and why its top is where it is. That is all but sure with Z0 on top; else the
/// user should look at it.
void tell_assumed(const AssumedStock& assumed, const Job& job, Diagnostics& diagnostics) {
  const Box3& b = assumed.stock.block;
  const Point3 size = b.size();
  const auto text = [](Point3 p, std::string_view form) {
    return fmt::format(fmt::runtime(form), number_text(p.x, 3), number_text(p.y, 3), number_text(p.z, 3));
  };
  const std::string block =
      fmt::format("assumed {} around the cuts, from {} to {}", text(size, "{} x {} x {} mm"),
                  text(b.low, "X{} Y{} Z{}"), text(b.high, "X{} Y{} Z{}"));
  const Origin where = TextSpot{job.program.source, 0, 0};
  const Box3& cuts = job.report.all.cut_bounds;
  Diagnostic* said = nullptr;
  if (find_z_downwards(job.program.path))
    said = &diagnostics.note(Code::stock_assumed, where,
                             fmt::format("the program does not tell its stock; {}", block));
  else if (assumed.top != AssumedTop::zero)
    said = &diagnostics.warning(
        Code::stock_assumed, where,
        fmt::format("the program does not tell its stock, and Z0 seems not to be its top; {}, its top {}",
                    block, reason_of(assumed.top)));
  else if (cuts.low.z >= b.high.z)
    said = &diagnostics.warning(
        Code::stock_assumed, where,
        fmt::format("the program does not tell its stock, and cuts nothing below Z0; {}, of which it removes "
                    "nothing",
                    block));
  else
    said = &diagnostics.note(
        Code::stock_assumed, where,
        fmt::format("the program does not tell its stock; {}, its top {}", block, reason_of(assumed.top)));
  said->hint =
      fmt::format("tell it, e.g. --stock \"{} to {}\"", text(b.low, "{},{},{}"), text(b.high, "{},{},{}"));
}

void find_stock(Job& job, const JobSettings& settings, Diagnostics& diagnostics) {
  job.stock = settings.bodies.stock;
  job.stock_source = StockSource::file;
  if (job.stock) return;
  job.stock = settings.stock;
  job.stock_source = StockSource::option;
  if (job.stock) return;
  job.stock = job.program.stock;
  job.stock_source = StockSource::program;
  if (job.stock) return;
  job.stock_source = StockSource::unknown;
  double radius = 0.0;
  for (const auto& [number, tool] : job.tools.tools()) radius = std::max(radius, tool.diameter.mm() / 2.0);
  const auto assumed = assume_stock(job.program.path, mm(radius) + kStockMargin, kStockFloor);
  if (!assumed) return;
  job.stock = assumed->stock;
  job.stock_source = StockSource::assumed;
  tell_assumed(*assumed, job, diagnostics);
}

void choose_stock(Job& job, const JobSettings& settings, Diagnostics& diagnostics) {
  job.bar = settings.bodies.bar;
  if (job.bar) return;
  find_stock(job, settings, diagnostics);
  if (job.stock && settings.bodies.move) job.stock = moved(*job.stock, *settings.bodies.move);
  job.fixtures = settings.bodies.fixtures;
}

}  // namespace

void add_tool_options(CommandParser& parser, ToolOptions& options) {
  add_repeated(parser, "-t,--tool", options.specs, "SPEC",
               "A tool's shape, for tool N or for all: [N=]SPEC (see below)");
  add_repeated(parser, "--tools", options.files, "PATH", "A file of tools (TOML)");
}

void add_job_options(CommandParser& parser, JobOptions& options) {
  add_program(parser, options.file);
  add_tool_options(parser, options.tools);
  parser.add_text("--stock", options.stock, "The stock: SIZE [at PLACE] or LOW to HIGH (see below)")
      .value_name("SPEC");
  add_reading_options(parser, options.reading);
}

std::vector<std::string> input_files(const JobOptions& options) {
  std::vector<std::string> files{options.file, options.bodies.mesh, options.bodies.left};
  files.insert(files.end(), options.bodies.fixtures.begin(), options.bodies.fixtures.end());
  return files;
}

void add_machine_option(CommandParser& parser, JobOptions& options) {
  parser.add_text("--machine", options.machine, "The machine: a profile (TOML) or what GRBL answers to $$")
      .value_name("PATH");
}

ToolSettings read_tool_options(const ToolOptions& options, Diagnostics& usage, Diagnostics& diagnostics) {
  ToolSettings settings;
  settings.table = built_in_tools();
  for (const std::string& text : options.specs) read_tool_option_of(text, settings, usage);
  read_tool_files(options.files, settings, diagnostics);
  return settings;
}

/// Which tool cutter compensation reckons with: as choose(), before the program is read.
decltype(InputOptions::tool_diameter) diameters_of(const ToolSettings& settings) {
  return [numbered = settings.numbered, any = settings.any_number, table = settings.table](
             int number, const Tool* described) -> std::optional<double> {
    Diagnostics unheard;  // choose() tells
    const auto told = numbered.find(number);
    const Tool* tool = told != numbered.end() ? &told->second
                       : any                  ? &*any
                                              : choose_tool(table.find(number), described, {}, unheard);
    if (tool == nullptr) return std::nullopt;
    return tool->diameter.mm();
  };
}

std::map<int, Tool> used_tools(const LoadedProgram& program, const ToolSettings& settings) {
  std::set<int> numbers;
  for (const auto& [number, tool] : program.tools) numbers.insert(number);
  for (const Step& s : program.path.steps())
    if (s.kind() == StepKind::tool_change) numbers.insert(s.tool_change().tool);
  Diagnostics unheard;  // a comment that differs from the table is told where shapes count
  std::map<int, Tool> tools;
  for (const int number : numbers)
    if (const Choice choice = choose(number, program, settings, unheard); choice.tool != nullptr)
      tools.emplace(number, *choice.tool);
  return tools;
}

JobSettings read_job_options(const JobOptions& options, Diagnostics& usage, Diagnostics& diagnostics) {
  JobSettings settings;
  settings.tools = read_tool_options(options.tools, usage, diagnostics);
  if (options.stock) settings.stock = read_stock_option(*options.stock, CallSpot{"", 0, "--stock"}, usage);
  settings.bodies = read_body_options(options.bodies, usage, diagnostics);
  if (!options.machine.empty())
    if (const auto file = InputFile::open(options.machine, diagnostics))
      settings.input.machine = read_machine_file(file->bytes(), options.machine, diagnostics);
  apply(options.reading, settings.input);
  settings.input.tool_diameter = diameters_of(settings.tools);
  return settings;
}

void tell_untouched(const Job& job, Volume removed, Diagnostics& diagnostics) {
  const Box3& cuts = job.report.all.cut_bounds;
  if (removed > Volume() || cuts.empty() || !job.stock || job.stock_source == StockSource::assumed) return;
  const auto text = [](const Box3& box) {
    return fmt::format("X{} Y{} Z{} to X{} Y{} Z{}", number_text(box.low.x, 3), number_text(box.low.y, 3),
                       number_text(box.low.z, 3), number_text(box.high.x, 3), number_text(box.high.y, 3),
                       number_text(box.high.z, 3));
  };
  const Box3& block = job.stock->block;
  const bool are_apart = cuts.low.x > block.high.x || cuts.high.x < block.low.x ||
                         cuts.low.y > block.high.y || cuts.high.y < block.low.y || cuts.low.z >= block.high.z;
  diagnostics
      .warning(Code::stock_untouched, TextSpot{job.program.source, 0, 0},
               fmt::format("the program cuts nothing of the stock: it cuts from {}, the stock lies from {}",
                           text(cuts), text(block)))
      .hint = are_apart ? "look at the program's zero, its units, and the stock's place"
                        : "its cuts may be narrower than the columns are apart: try a finer --resolution";
}

std::string hint_for_unknown(int tool) {
  return fmt::format("tell it, e.g. --tool {}=\"square d=3.175 flute=12.7\"", tool);
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
    case StockSource::file: return "file";
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

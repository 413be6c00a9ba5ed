// The tools of a job, and their sources.
#include "base/codes/tools.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "base/codes/files.h"
#include "base/names.h"
#include "base/number.h"
#include "formats/tool_libraries.h"
#include "job/beam.h"
#include "job/choices.h"
#include "job/front_ends.h"
#include "path/assumed_tool.h"

#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

constexpr int kHighestToolNumber = 999'999'999;
// A laser's beam, as a tool that removes nothing above Z0.
const Length kBeam = mm(0.1), kBeamFlute = mm(10);

/// "[N=]SPEC", split.
struct ToolOption {
  std::optional<int> number;
  std::string_view spec;
};

/// Splits "102=square d=3" or "102 = square d=3" into 102 and the rest; no number if there is a word before
/// the first '='. Nothing, with an error, if the number or the tool is missing or invalid.
std::optional<ToolOption> split_tool_option(std::string_view text, const Origin& where,
                                            Diagnostics& diagnostics) {
  const auto wrong = [&](std::string message) {
    diagnostics.error(codes::tool_value_type, where, std::move(message)).hint =
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
    return wrong(fmt::format("{} is not a tool number: expected an integer from 0 to {}",
                             before.substr(0, 40), kHighestToolNumber));
  const std::string_view spec = trim(text.substr(equals + 1));
  if (spec.empty()) return wrong(fmt::format("the shape of tool {} is missing after \"=\"", before));
  return ToolOption{static_cast<int>(*number), spec};
}

}  // namespace

void add_tool(const std::string& text, const Origin& where, ToolChoices& choices, Diagnostics& diagnostics) {
  const auto option = split_tool_option(text, where, diagnostics);
  if (!option) return;
  std::optional<Tool> tool = read_tool_option(option->spec, where, diagnostics);
  if (!tool) return;
  if (option->number) {
    tool->number = *option->number;
    choices.numbered.insert_or_assign(*option->number, std::move(*tool));
  } else {
    choices.any_number = std::move(tool);
  }
}

void add_tool_file(const std::string& name, ToolChoices& choices, Diagnostics& diagnostics) {
  const auto file = InputFile::open(name, diagnostics);
  if (!file) return;
  ToolTable table;
  const auto kind = library_kind_of(file->bytes());
  if (kind && *kind != ToolLibraryKind::kerf)
    read_tool_library(file->bytes(), name, {.read_bit = tool_bits_of(name)}, table, diagnostics);
  else
    read_tool_file(file->bytes(), name, table, diagnostics);
  for (const auto& [number, tool] : table.tools()) {
    choices.table.set(number, tool);
    choices.from_file[number] = name;
  }
}

/// The diameters as choose() will find them, before the program is read.
decltype(ProgramOptions::tool_diameter) diameters_of(const ToolChoices& choices) {
  return [numbered = choices.numbered, any = choices.any_number, table = choices.table](
             int number, const Tool* described) -> std::optional<double> {
    Diagnostics ignored;  // choose() reports
    const auto given = numbered.find(number);
    const Tool* tool = given != numbered.end() ? &given->second
                       : any                   ? &*any
                                               : choose_tool(table.find(number), described, {}, ignored);
    if (tool == nullptr) return std::nullopt;
    return tool->diameter.mm();
  };
}

std::string hint_for_unknown(std::optional<int> number, std::string_view diameter) {
  if (!number) return fmt::format("specify it without a number, e.g. --tool \"square d={}\"", diameter);
  return fmt::format("specify it, e.g. --tool {}=\"square d={}\"", *number, diameter);
}

namespace {

/// The tool numbers of a path in order of first use, and whether it cuts before the first tool change.
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

/// Of the tools of the program itself.
ToolSource own_source(const Program& program) {
  return program.tools_are == ToolsOfProgram::whole ? ToolSource::program : ToolSource::comment;
}

/// The tool before the first tool change: the only one of the options, else the only one described by the
/// program.
std::optional<std::pair<Tool, ToolSource>> tool_for_start(const Program& program, const ToolChoices& choices,
                                                          const Uses& uses) {
  if (choices.any_number) return {{*choices.any_number, ToolSource::option}};
  const auto start = program.tools.find(0);  // of a comment before the first tool change
  const bool uses_zero = std::find(uses.numbers.begin(), uses.numbers.end(), 0) != uses.numbers.end();
  if (!uses.numbers.empty() && start != program.tools.end() && !uses_zero && uses.cuts_before)
    return {{start->second, own_source(program)}};
  if (!uses.numbers.empty()) return std::nullopt;
  if (choices.numbered.size() == 1) return {{choices.numbered.begin()->second, ToolSource::option}};
  if (choices.numbered.empty() && program.tools.size() == 1)
    return {{program.tools.begin()->second, own_source(program)}};
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

/// Inserts a tool change before the first motion.
void insert_start_tool(Job& job, const Tool& tool, ToolSource source, const Uses& uses) {
  int number = std::max(tool.number, 1);
  while (std::find(uses.numbers.begin(), uses.numbers.end(), number) != uses.numbers.end()) ++number;
  job.program.path = with_tool_before(job.program.path, number);
  job.tools.set(number, tool);
  job.tool_sources[number] = source;
  job.start_tool = number;
}

/// The tool of the motions before the first tool change, if it is known.
void give_start_tool(Job& job, const JobSettings& settings, const Uses& uses) {
  if (!uses.motions_before) return;
  if (const auto chosen = tool_for_start(job.program, settings.tools, uses))
    insert_start_tool(job, chosen->first, chosen->second, uses);
}

struct Choice {
  const Tool* tool = nullptr;
  ToolSource source = ToolSource::unknown;
};

/// The origin of the first tool change to a tool.
Origin first_use_of(int number, const Toolpath& path) {
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].kind() == StepKind::tool_change && path[i].tool_change().tool == number)
      return path.origin_of(i);
  return {};
}

Choice choose(int number, const Program& program, const ToolChoices& choices, Diagnostics& diagnostics) {
  if (const auto it = choices.numbered.find(number); it != choices.numbered.end())
    return {&it->second, ToolSource::option};
  if (choices.any_number) return {&*choices.any_number, ToolSource::option};
  const bool from_file = choices.from_file.count(number) > 0;
  const Tool* beside = from_file ? nullptr : program.tools_beside.find(number);
  const Tool* in_table = beside != nullptr ? beside : choices.table.find(number);
  const auto described = program.tools.find(number);
  const Tool* in_comment = described == program.tools.end() ? nullptr : &described->second;
  if (in_comment != nullptr && program.tools_are == ToolsOfProgram::whole)
    return {in_comment, ToolSource::program};
  const Tool* chosen = choose_tool(in_table, in_comment, first_use_of(number, program.path), diagnostics);
  if (chosen == nullptr) return {};
  if (chosen == in_comment) return {chosen, ToolSource::comment};
  return {chosen, from_file || beside != nullptr ? ToolSource::file : ToolSource::built_in};
}

/// Warns of --tool N=... with an N that the program does not use: most likely a wrong number.
void warn_unused_tools(const Job& job, const JobSettings& settings, const Uses& uses,
                       Diagnostics& diagnostics) {
  const bool for_start =
      uses.numbers.empty() && settings.tools.numbered.size() == 1 && !settings.tools.any_number;
  for (const auto& [number, tool] : settings.tools.numbered) {
    if (job.tool_sources.count(number) > 0 || for_start) continue;
    std::vector<std::string> used;
    for (const int n : uses.numbers) used.push_back(std::to_string(n));
    diagnostics
        .warning(codes::option_unused, CallLocation{"", 0, fmt::format("--tool {}=...", number)},
                 fmt::format("the program never uses tool {}", number))
        .hint = used.empty() ? "it has no tool change; --tool SPEC, without a number, is for all tools"
                             : "it uses tool " + list_text(used);
  }
}

/// The first cut with a tool (nothing: before the first tool change).
std::optional<std::size_t> first_cut_of(std::optional<int> tool, const Toolpath& path) {
  for (MotionReader motion(path); motion.next();)
    if (motion.step().is_cutting() && motion.context().tool == tool) return motion.context().index;
  return std::nullopt;
}

std::string_view reason_of(AssumedDiameter basis) {
  switch (basis) {
    case AssumedDiameter::stepover: return "by its stepover";
    case AssumedDiameter::spacing: return "by the distances of its cuts";
    case AssumedDiameter::usual: break;
  }
  return "the usual size";
}

/// Reports a tool of unknown shape; without a number: before the first tool change.
void report_unknown_tool(std::optional<int> number, const Toolpath& path, UnknownTool unknown,
                         Diagnostics& diagnostics) {
  const auto cut = first_cut_of(number, path);
  const Origin where = number ? first_use_of(*number, path) : cut ? path.origin_of(*cut) : Origin{};
  const std::string message =
      number ? fmt::format("the shape of tool {} is unknown", *number)
             : std::string("a cut before the first tool change, with a tool of unknown shape");
  Diagnostic& reported = unknown == UnknownTool::error
                             ? diagnostics.error(codes::no_tool_shape, where, message)
                             : diagnostics.warning(codes::no_tool_shape, where, message);
  reported.hint = hint_for_unknown(number, "3.175 flute=12.7");
}

/// A diameter of the program's cutter compensation precedes the one that the cuts suggest.
AssumedTool assumed_tool(std::optional<int> number, const Program& program) {
  if (program.path.has(StepKind::laser_power)) return {shape::Square{kBeam, kBeamFlute}, kBeam};
  AssumedTool assumed = assume_tool(program.path, number);
  if (!program.assumed_diameter) return assumed;
  assumed.diameter = mm(*program.assumed_diameter);
  assumed.basis = AssumedDiameter::usual;
  auto& square = std::get<shape::Square>(assumed.shape);
  square = {assumed.diameter, std::max(square.flute, usual_flute(assumed.diameter))};
  return assumed;
}

/// Makes the assumed tool of a number, or of the motions before the first tool change, with a warning if it
/// cuts.
void assume(std::optional<int> number, Job& job, const Uses& uses, Diagnostics& diagnostics) {
  const AssumedTool assumed = assumed_tool(number, job.program);
  Diagnostics ignored;  // the dimensions are valid
  std::optional<Tool> tool = make_tool(number.value_or(0), assumed.shape, ToolBody{}, {}, ignored);
  if (!tool) return;
  tool->flute_assumed = true;
  const auto cut = first_cut_of(number, job.program.path);
  if (cut && !job.program.path.has(StepKind::laser_power)) {
    const std::string diameter = number_text(assumed.diameter.mm(), 3);
    const std::string unknown = number ? fmt::format("the shape of tool {} is unknown", *number)
                                       : std::string("a cut before the first tool change");
    diagnostics
        .warning(codes::no_tool_shape, job.program.path.origin_of(*cut),
                 fmt::format("{}; assuming a square end mill of {} mm ({})", unknown, diameter,
                             reason_of(assumed.basis)))
        .hint = hint_for_unknown(number, diameter);
  }
  if (!number) return insert_start_tool(job, *tool, ToolSource::assumed, uses);
  job.tool_sources[*number] = ToolSource::assumed;
  job.tools.set(*number, std::move(*tool));
}

}  // namespace

std::map<int, Tool> used_tools(const Program& program, const ToolChoices& choices) {
  std::set<int> numbers;
  for (const auto& [number, tool] : program.tools) numbers.insert(number);
  for (const Step& s : program.path.steps())
    if (s.kind() == StepKind::tool_change) numbers.insert(s.tool_change().tool);
  Diagnostics ignored;  // choose_tools reports comments that differ from the table
  std::map<int, Tool> tools;
  for (const int number : numbers)
    if (const Choice choice = choose(number, program, choices, ignored); choice.tool != nullptr)
      tools.emplace(number, *choice.tool);
  return tools;
}

std::optional<std::pair<int, Tool>> start_tool(const Program& program, const ToolChoices& choices) {
  const Uses uses = uses_of(program.path);
  const auto start = uses.motions_before ? tool_for_start(program, choices, uses) : std::nullopt;
  if (!start) return std::nullopt;
  return {{uses.numbers.empty() ? std::max(start->first.number, 1) : 0, start->first}};
}

void keep_tools(Program& program, const ToolChoices& choices) {
  auto start = start_tool(program, choices);
  std::map<int, Tool> tools = used_tools(program, choices);
  if (start && start->first != 0) tools.clear();  // the only tool is that of the start
  if (start) tools.insert_or_assign(start->first, std::move(start->second));
  program.tools = std::move(tools);
  program.tools_are = ToolsOfProgram::whole;
}

std::string add_tools_of(const std::map<int, Tool>& tools, std::map<int, Tool>& known) {
  for (const auto& [number, tool] : tools) {
    const auto before = known.find(number);
    if (before == known.end() || before->second.silhouette.cutting == tool.silhouette.cutting) continue;
    return fmt::format(
        "tool {} has different shapes in these programs: {} and {}; give one of them another "
        "number: Tool('square d=6', number=2)",
        number, short_name(before->second), short_name(tool));
  }
  known.insert(tools.begin(), tools.end());
  return {};
}

bool fits_tools_of_job(const Program& program, const ToolChoices& choices, Diagnostics& diagnostics) {
  if (program.front_end != cut_front_end().name) return true;
  for (const auto& [number, own] : program.tools) {
    const auto given = choices.numbered.find(number);
    const Tool* other = given != choices.numbered.end() ? &given->second
                        : choices.any_number            ? &*choices.any_number
                                                        : nullptr;
    if (other == nullptr || short_name(*other) == short_name(own)) continue;
    diagnostics
        .error(codes::option_unused, CallLocation{"", 0, "--tool"},
               fmt::format("the paths of {} are made for tool {} of its [tools], {}; it cannot be {}",
                           program.source, number, short_name(own), short_name(*other)))
        .hint = "change the tool there";
    return false;
  }
  return true;
}

void choose_tools(Job& job, const JobSettings& settings, UnknownTool unknown, Diagnostics& diagnostics) {
  if (!fits_tools_of_job(job.program, settings.tools, diagnostics)) return;
  if (job.program.path.has(StepKind::laser_power)) unknown = UnknownTool::assume;
  const Uses uses = uses_of(job.program.path);
  give_start_tool(job, settings, uses);
  if (uses.cuts_before && job.tool_sources.empty() && unknown != UnknownTool::assume)
    report_unknown_tool(std::nullopt, job.program.path, unknown, diagnostics);
  else if (uses.cuts_before && job.tool_sources.empty())
    assume(std::nullopt, job, uses, diagnostics);
  for (const int number : uses.numbers) {
    const Choice choice = choose(number, job.program, settings.tools, diagnostics);
    job.tool_sources[number] = choice.source;
    if (choice.tool == nullptr && unknown == UnknownTool::assume) {
      assume(number, job, uses, diagnostics);
      continue;
    }
    if (choice.tool == nullptr) {
      report_unknown_tool(number, job.program.path, unknown, diagnostics);
      continue;
    }
    Tool tool = *choice.tool;
    tool.number = number;
    job.tools.set(number, std::move(tool));
  }
  warn_unused_tools(job, settings, uses, diagnostics);
  if (settings.tools.any_number && uses.numbers.size() > 1 + settings.tools.numbered.size())
    diagnostics.note(codes::tool_option_wide, {},
                     fmt::format("--tool without a number applies to {} tool numbers of the program",
                                 uses.numbers.size()));
}

std::string_view to_string(ToolSource source) {
  switch (source) {
    case ToolSource::option: return "option";
    case ToolSource::comment: return "comment";
    case ToolSource::program: return "program";
    case ToolSource::file: return "tool file";
    case ToolSource::built_in: return "built in";
    case ToolSource::assumed: return "assumed";
    case ToolSource::unknown: break;
  }
  return "unknown";
}

namespace {

/// What a diameter does not say of a shape; worded so that readers of comments understand it.
std::string further_size(const ToolShape& shape) {
  const auto cone = [](Angle angle) { return fmt::format(", {} degrees", number_text(angle.deg(), 2)); };
  const auto radius = [](Length r) { return fmt::format(", radius {} mm", number_text(r.mm(), 3)); };
  if (const auto* s = std::get_if<shape::Vee>(&shape)) return cone(s->included_angle);
  if (const auto* s = std::get_if<shape::Chamfer>(&shape)) return cone(s->included_angle);
  if (const auto* s = std::get_if<shape::Drill>(&shape)) return cone(s->point_angle);
  if (const auto* s = std::get_if<shape::BullNose>(&shape)) return radius(s->corner_radius);
  if (const auto* s = std::get_if<shape::Bowl>(&shape)) return radius(s->corner_radius);
  return {};
}

}  // namespace

bool is_beam(const Job& job, int number) {
  const auto source = job.tool_sources.find(number);
  return job.program.path.has(StepKind::laser_power) && source != job.tool_sources.end() &&
         source->second == ToolSource::assumed;
}

std::string short_name(const Tool& tool) {
  return fmt::format("{} {} mm{}", name_of(tool.shape), number_text(tool.diameter.mm(), 3),
                     further_size(tool.shape));
}

}  // namespace kerf

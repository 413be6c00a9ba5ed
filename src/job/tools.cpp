// The tools of a job, and their sources.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "job/choices.h"

#include "kerf/names.h"
#include "kerf/number.h"
#include "kerf/tool_files.h"

namespace kerf {
namespace {

constexpr int kHighestToolNumber = 999'999'999;

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
    diagnostics.error(Code::tool_value_type, where, std::move(message)).hint =
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

/// The tool before the first tool change: the only one of the options, else the only one described by the
/// program.
std::optional<std::pair<Tool, ToolSource>> tool_for_start(const Program& program, const JobSettings& settings,
                                                          const Uses& uses) {
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

/// Inserts a tool change before the first motion if the tool is known.
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
  const Tool* in_table = choices.table.find(number);
  const auto described = program.tools.find(number);
  const Tool* in_comment = described == program.tools.end() ? nullptr : &described->second;
  const Tool* chosen = choose_tool(in_table, in_comment, first_use_of(number, program.path), diagnostics);
  if (chosen == nullptr) return {};
  if (chosen == in_comment) return {chosen, ToolSource::comment};
  return {chosen, choices.from_file.count(number) > 0 ? ToolSource::file : ToolSource::built_in};
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
        .warning(Code::option_unused, CallLocation{"", 0, fmt::format("--tool {}=...", number)},
                 fmt::format("the program never uses tool {}", number))
        .hint = used.empty() ? "it has no tool change; --tool SPEC, without a number, is for all tools"
                             : "it uses tool " + list_text(used);
  }
}

/// Reports an unknown shape: as an error if it is required, else as a warning.
Diagnostic& report_unknown_tool(UnknownTool unknown, Origin where, std::string message,
                                Diagnostics& diagnostics) {
  if (unknown == UnknownTool::error) return diagnostics.error(Code::no_tool_shape, std::move(where), message);
  return diagnostics.warning(Code::no_tool_shape, std::move(where), message);
}

void report_no_tool(const Toolpath& path, UnknownTool unknown, Diagnostics& diagnostics) {
  const auto& steps = path.steps();
  const auto first = std::find_if(steps.begin(), steps.end(), [](const Step& s) { return s.is_cutting(); });
  report_unknown_tool(unknown, path.origin_of(static_cast<std::size_t>(first - steps.begin())),
                      "a cut before the first tool change, with a tool of unknown shape", diagnostics)
      .hint = "specify the tool, e.g. --tool \"square d=3.175 flute=12.7\"";
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

void choose_tools(Job& job, const JobSettings& settings, UnknownTool unknown, Diagnostics& diagnostics) {
  const Uses uses = uses_of(job.program.path);
  give_start_tool(job, settings, uses);
  if (uses.cuts_before && job.tool_sources.empty() && unknown != UnknownTool::unreported)
    report_no_tool(job.program.path, unknown, diagnostics);
  for (const int number : uses.numbers) {
    const Choice choice = choose(number, job.program, settings.tools, diagnostics);
    job.tool_sources[number] = choice.source;
    if (choice.tool == nullptr && unknown == UnknownTool::unreported) continue;
    if (choice.tool == nullptr) {
      report_unknown_tool(unknown, first_use_of(number, job.program.path),
                          fmt::format("the shape of tool {} is unknown", number), diagnostics)
          .hint = hint_for_unknown(number);
      continue;
    }
    Tool tool = *choice.tool;
    tool.number = number;
    job.tools.set(number, std::move(tool));
  }
  warn_unused_tools(job, settings, uses, diagnostics);
  if (settings.tools.any_number && uses.numbers.size() > 1 + settings.tools.numbered.size())
    diagnostics.note(Code::tool_option_wide, {},
                     fmt::format("--tool without a number applies to {} tool numbers of the program",
                                 uses.numbers.size()));
}

std::string hint_for_unknown(int tool) {
  return fmt::format("specify it, e.g. --tool {}=\"square d=3.175 flute=12.7\"", tool);
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

std::string short_name(const Tool& tool) {
  return fmt::format("{} {} mm", name_of(tool.shape), number_text(tool.diameter.mm(), 3));
}

}  // namespace kerf

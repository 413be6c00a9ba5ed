// Hazards as text and as JSON.
#include "app/findings.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "kerf/number.h"

namespace kerf::app {
namespace {

constexpr std::size_t kMostLines = 30;  // of hazards as text; JSON has them all

std::string message_of(const Hazard& hazard) {
  const std::string depth = number_text(hazard.depth.mm(), 3);
  switch (hazard.kind) {
    case HazardKind::rapid_in_stock:
      return fmt::format("a rapid move goes {} mm deep through the stock", depth);
    case HazardKind::neck_contact: return fmt::format("the tool's neck rubs {} mm deep in the stock", depth);
    case HazardKind::shank_contact:
      return fmt::format("the tool's shank goes {} mm deep into the stock", depth);
    case HazardKind::holder_contact:
      return fmt::format("the tool's holder goes {} mm deep into the stock", depth);
    case HazardKind::over_flute: return fmt::format("a cut {} mm deeper than the flute is long", depth);
    case HazardKind::below_floor: return fmt::format("a cut {} mm below the floor of the stock", depth);
    case HazardKind::spindle_off: break;
  }
  return "the spindle stands still while the tool is in the stock";
}

std::string_view hint_of(HazardKind kind) {
  switch (kind) {
    case HazardKind::rapid_in_stock:
      return "lift the tool before the rapid; if the stock is another one, tell it with --stock";
    case HazardKind::neck_contact:
    case HazardKind::shank_contact:
    case HazardKind::holder_contact: return "use a longer tool, or clear the material beside it first";
    case HazardKind::over_flute: return "use a tool with a longer flute, or cut less deep at a time";
    case HazardKind::below_floor:
      return "cut less deep; if the stock is thicker or lies elsewhere, tell it with --stock";
    case HazardKind::spindle_off: break;
  }
  return "start the spindle (S10000 M3) before the cut";
}

/// Whether a finding goes on with a line's: its step is the next one, or it says that the spindle stands
/// still, which is one slip however many cuts follow.
bool goes_on(const Finding& line, const Finding& f) {
  return line.step + line.steps >= f.step ||
         (f.kind == to_string(HazardKind::spindle_off) && f.message == line.message);
}

/// Neighbouring steps with the same kind and subject become one line; the deepest contact tells.
std::vector<Finding> grouped(const std::vector<Finding>& findings) {
  std::vector<Finding> lines;
  std::map<std::pair<std::string, std::string>, std::size_t> open;
  for (const Finding& f : findings) {
    const auto it = open.find({f.kind, f.about});
    if (it != open.end() && goes_on(lines[it->second], f)) {
      Finding& line = lines[it->second];
      line.steps += f.steps;
      line.removed_mm3 += f.removed_mm3;
      if (f.depth_mm > line.depth_mm) {
        line.depth_mm = f.depth_mm;
        line.message = f.message;
      }
      continue;
    }
    open[{f.kind, f.about}] = lines.size();
    lines.push_back(f);
  }
  return lines;
}

std::string line_of(const Finding& f) {
  std::string line = to_string(f.origin);
  if (!line.empty()) line += ": ";
  line += f.message;
  if (f.steps > 1) line += fmt::format(", in {} moves from here", f.steps);
  line +=
      fmt::format(" (at X{} Y{} Z{}", number_text(f.at.x, 3), number_text(f.at.y, 3), number_text(f.at.z, 3));
  if (f.removed_mm3 > 0.0) line += fmt::format(", {} mm3 met", number_text(f.removed_mm3, 3));
  line += fmt::format(") [{}]\n", f.kind);
  if (!f.hint.empty()) line += "    hint: " + f.hint + "\n";
  for (const Origin& caller : f.callers) line += fmt::format("  called from {}\n", to_string(caller));
  return line;
}

std::string hint_for_flute(const Tool& tool) {
  return fmt::format("tell the flute's length, as in --tool {}=\"{} d={} flute=20\"", tool.number,
                     name_of(tool.shape), number_text(tool.diameter.mm(), 3));
}

/// The tools of the findings' steps, in their order; findings are in the order of steps.
std::vector<const Tool*> tools_of(const std::vector<Finding>& findings, const Toolpath& path,
                                  const ToolTable& tools) {
  std::vector<const Tool*> out;
  const Tool* tool = tools.tools().size() == 1 ? &tools.tools().begin()->second : nullptr;
  std::size_t step = 0;
  for (const Finding& f : findings) {
    for (; step <= f.step && step < path.size(); ++step)
      if (path[step].kind() == StepKind::tool_change) tool = tools.find(path[step].tool_change().tool);
    out.push_back(tool);
  }
  return out;
}

void warn_of_flute(const Finding& f, const Tool& tool, Diagnostics& diagnostics) {
  const std::string moves = f.steps > 1 ? fmt::format(", in {} moves", f.steps) : "";
  diagnostics
      .warning(Code::flute_assumed, f.origin,
               fmt::format("a cut {} mm deeper than the flute of tool {}, which nobody told: {} mm are "
                           "assumed ({}){}",
                           number_text(f.depth_mm, 3), tool.number, number_text(tool.flute.mm(), 3),
                           reason_of_flute(tool), moves))
      .hint = hint_for_flute(tool);
}

}  // namespace

std::string_view reason_of_flute(const Tool& tool) {
  const bool by_diameter = std::abs(tool.flute.mm() - 3.0 * tool.diameter.mm()) < 1e-9 * tool.flute.mm();
  return by_diameter ? "3 diameters" : "usual for its size";
}

std::vector<Finding> findings_of(const std::vector<PathHazard>& hazards, const Toolpath& path) {
  std::vector<Finding> out;
  for (const PathHazard& h : hazards)
    out.push_back({std::string(kind_of(h)), h.step, h.steps, h.at, 0.0, 0.0, path.origin_of(h.step),
                   h.message, path.origins().callers(path[h.step].origin()), h.hint});
  return out;
}

std::vector<Finding> findings_of(const std::vector<Hazard>& hazards, const Toolpath& path) {
  std::vector<Finding> out;
  for (const Hazard& h : hazards)
    out.push_back({std::string(to_string(h.kind)), h.step, 1, h.at, h.depth.mm(), h.removed.mm3(),
                   path.origin_of(h.step), message_of(h), path.origins().callers(path[h.step].origin()),
                   std::string(hint_of(h.kind))});
  return out;
}

std::vector<Finding> merged(std::vector<Finding> of_path, std::vector<Finding> of_material) {
  for (Finding& f : of_material)
    if (f.kind != to_string(HazardKind::spindle_off)) of_path.push_back(std::move(f));
  std::stable_sort(of_path.begin(), of_path.end(),
                   [](const Finding& a, const Finding& b) { return a.step < b.step; });
  return of_path;
}

void tell_assumed_flutes(std::vector<Finding>& findings, const Toolpath& path, const ToolTable& tools,
                         Diagnostics& diagnostics) {
  const std::vector<const Tool*> tool_of = tools_of(findings, path, tools);
  std::map<int, std::pair<const Tool*, Finding>> deepest;
  std::vector<Finding> rest;
  for (std::size_t i = 0; i < findings.size(); ++i) {
    Finding& f = findings[i];
    const bool assumed = tool_of[i] != nullptr && tool_of[i]->flute_assumed;
    if (!assumed || f.kind != to_string(HazardKind::over_flute)) {
      if (assumed &&
          (f.kind == to_string(HazardKind::shank_contact) || f.kind == to_string(HazardKind::neck_contact)))
        f.hint = hint_for_flute(*tool_of[i]);
      rest.push_back(std::move(f));
      continue;
    }
    const auto [it, is_new] = deepest.try_emplace(tool_of[i]->number, tool_of[i], f);
    if (is_new) continue;
    Finding& first = it->second.second;
    first.steps += f.steps;
    first.depth_mm = std::max(first.depth_mm, f.depth_mm);
  }
  findings = std::move(rest);
  for (const auto& [number, of_tool] : deepest) warn_of_flute(of_tool.second, *of_tool.first, diagnostics);
}

Json json_of(const Finding& f) {
  Json out{{"kind", f.kind},
           {"at", json_of(f.at)},
           {"depth_mm", json_of(f.depth_mm)},
           {"removed_mm3", json_of(f.removed_mm3)},
           {"step", f.step},
           {"steps", f.steps},
           {"message", f.message},
           {"hint", f.hint},
           {"origin", json_of(f.origin)}};
  for (const Origin& caller : f.callers) out["callers"].push_back(json_of(caller));
  return out;
}

Json json_of(const std::vector<Finding>& findings) {
  Json list = Json::array();
  for (const Finding& f : findings) list.push_back(json_of(f));
  return list;
}

std::string count_text(const std::vector<Finding>& findings) {
  const std::vector<Finding> lines = grouped(findings);
  if (lines.empty()) return "none";
  std::size_t moves = 0;
  for (const Finding& line : lines) moves += line.steps;
  if (moves == lines.size()) return std::to_string(moves);
  return fmt::format("{} in {} moves", lines.size(), moves);
}

void show(Console& console, const std::vector<Finding>& findings) {
  const std::vector<Finding> lines = grouped(findings);
  for (std::size_t i = 0; i < std::min(lines.size(), kMostLines); ++i) console.print(line_of(lines[i]));
  if (lines.size() > kMostLines)
    console.print(
        fmt::format("... and {} more hazards (--json lists them all)\n", lines.size() - kMostLines));
}

}  // namespace kerf::app

// The hazards of toolpath, material, fixtures and prints in one form.
#include "kerf/job/findings.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "base/codes/tools.h"
#include "base/number.h"
#include "job/job_findings.h"

namespace kerf {
namespace {

std::string message_of(const Hazard& hazard) {
  const std::string depth = number_text(hazard.depth.mm(), 3);
  switch (hazard.kind) {
    case HazardKind::rapid_in_stock: return fmt::format("a rapid passes {} mm deep through the stock", depth);
    case HazardKind::neck_contact: return fmt::format("the tool's neck is {} mm deep in the stock", depth);
    case HazardKind::shank_contact: return fmt::format("the tool's shank is {} mm deep in the stock", depth);
    case HazardKind::holder_contact:
      return fmt::format("the tool's holder is {} mm deep in the stock", depth);
    case HazardKind::over_flute: return fmt::format("a cut {} mm deeper than the flute length", depth);
    case HazardKind::below_floor: return fmt::format("a cut {} mm below the floor of the stock", depth);
    case HazardKind::spindle_off: break;
  }
  return "the spindle is stopped while the tool is in the stock";
}

std::string_view hint_of(HazardKind kind) {
  switch (kind) {
    case HazardKind::rapid_in_stock:
      return "retract the tool before the rapid; if the stock is different, specify it with --stock";
    case HazardKind::neck_contact:
    case HazardKind::shank_contact:
    case HazardKind::holder_contact: return "use a longer tool, or clear the material beside it first";
    case HazardKind::over_flute: return "use a tool with a longer flute, or a smaller stepdown";
    case HazardKind::below_floor:
      return "reduce the depth; if a spoilboard is below the stock, specify its thickness with --spoilboard; "
             "if "
             "the stock is thicker or at another position, specify it with --stock";
    case HazardKind::spindle_off: break;
  }
  return "start the spindle (S10000 M3) before the cut";
}

std::string message_of(const PrintHazard& hazard) {
  const std::string length = number_text(hazard.length.mm(), 2);
  switch (hazard.kind) {
    case PrintHazardKind::nozzle_contact:
      return fmt::format("the nozzle passes {} mm deep through printed material or the bed",
                         number_text(hazard.depth.mm(), 3));
    case PrintHazardKind::in_air: return fmt::format("{} mm of bead printed in the air", length);
    case PrintHazardKind::unsupported: return fmt::format("{} mm of bead without support below", length);
    case PrintHazardKind::wide_bead:
      return fmt::format("a bead {} mm wide over {} mm, {} mm3 more than one of the print's usual width",
                         number_text(hazard.width.mm(), 2), length, number_text(hazard.volume.mm3(), 2));
    case PrintHazardKind::blob: break;
  }
  return fmt::format("{} mm3 of filament extruded without a motion", number_text(hazard.volume.mm3(), 3));
}

/// The part of the tool that touches the fixture; empty for a rapid.
std::string part_name(const FixtureContact& contact) {
  if (contact.part == ToolPart::cutting) return "cutting edge";
  return contact.part ? std::string(to_string(*contact.part)) : std::string();
}

std::string message_of(const FixtureContact& contact, const Fixture& fixture) {
  const std::string part = part_name(contact);
  const std::string where = fmt::format("{} mm deep in the fixture \"{}\"",
                                        number_text(contact.depth.mm(), 3), fixture.name.substr(0, 60));
  if (part.empty()) return "a rapid is " + where;
  return fmt::format("the tool's {} is {}", part, where);
}

/// Whether a finding belongs to the same line of the report: its step is the next one, or it is a stopped
/// spindle, which has one cause for all cuts that follow.
bool is_continued(const Finding& line, const Finding& f) {
  return line.step + line.steps >= f.step ||
         (f.kind == to_string(HazardKind::spindle_off) && f.message == line.message);
}

std::string hint_for_flute(const Tool& tool) {
  return fmt::format("specify the flute length, e.g. --tool {}=\"{} d={} flute=20\"", tool.number,
                     name_of(tool.shape), number_text(tool.diameter.mm(), 3));
}

/// The tool in force at each finding; the findings are in the order of steps.
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
  const std::string motions = f.steps > 1 ? fmt::format(", in {} motions", f.steps) : "";
  diagnostics
      .warning(codes::flute_assumed, f.origin,
               fmt::format("a cut {} mm deeper than the flute of tool {}; no flute length is given, assuming "
                           "{} mm ({}){}",
                           number_text(f.depth_mm, 3), tool.number, number_text(tool.flute.mm(), 3),
                           reason_of_flute(tool), motions))
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

std::vector<Finding> findings_of(const std::vector<PrintHazard>& hazards, const Toolpath& path) {
  std::vector<Finding> out;
  for (const PrintHazard& h : hazards) {
    Finding finding;
    finding.kind = to_string(h.kind);
    finding.step = h.step;
    finding.steps = h.steps;
    finding.at = h.at;
    finding.depth_mm = h.depth.mm();
    finding.origin = path.origin_of(h.step);
    finding.message = message_of(h);
    out.push_back(std::move(finding));
  }
  return out;
}

std::vector<Finding> findings_of(const std::vector<FixtureContact>& contacts,
                                 const std::vector<Fixture>& fixtures, const Toolpath& path) {
  std::vector<Finding> out;
  for (const FixtureContact& c : contacts)
    out.push_back({.kind = "fixture_contact",
                   .step = c.step,
                   .steps = 1,
                   .at = c.at,
                   .depth_mm = c.depth.mm(),
                   .removed_mm3 = c.met.mm3(),
                   .origin = path.origin_of(c.step),
                   .message = message_of(c, fixtures[c.fixture]),
                   .callers = path.origins().callers(path[c.step].origin()),
                   .hint = {},
                   .about = fmt::format("{} {}", c.fixture, part_name(c))});
  return out;
}

std::vector<Finding> merged(std::vector<Finding> of_path, std::vector<Finding> of_material) {
  for (Finding& f : of_material)
    if (f.kind != to_string(HazardKind::spindle_off)) of_path.push_back(std::move(f));
  std::stable_sort(of_path.begin(), of_path.end(),
                   [](const Finding& a, const Finding& b) { return a.step < b.step; });
  return of_path;
}

std::vector<Finding> grouped(const std::vector<Finding>& findings) {
  std::vector<Finding> lines;
  std::map<std::pair<std::string, std::string>, std::size_t> open;
  for (const Finding& f : findings) {
    const auto it = open.find({f.kind, f.about});
    if (it != open.end() && is_continued(lines[it->second], f)) {
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

void warn_assumed_flutes(std::vector<Finding>& findings, const Toolpath& path, const ToolTable& tools,
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

std::vector<Finding> findings_at_fixtures(const Toolpath& path, const Job& job, const SimulationOptions& how,
                                          Diagnostics& diagnostics, Progress* progress) {
  if (job.fixtures.empty()) return {};
  if (progress != nullptr) progress->phase("checking fixtures");
  const auto contacts = find_fixture_contacts(path, job.tools, job.fixtures, how, diagnostics, progress);
  return contacts ? findings_of(*contacts, job.fixtures, path) : std::vector<Finding>{};
}

}  // namespace kerf

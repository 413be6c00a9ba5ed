// The check of a job: its toolpath, and by a coarse simulation the stock and the fixtures.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "base/codes/files.h"
#include "base/codes/gcode.h"
#include "base/codes/sim.h"
#include "base/number.h"
#include "job/choices.h"
#include "job/job_findings.h"
#include "job/print_findings.h"
#include "sim/exact/grazes.h"

#include "kerf/sim/print.h"
#include "kerf/sim/rotary.h"

namespace kerf {
namespace {

constexpr double kColumns = 500'000;        // of the coarse simulation
constexpr double kFinestDefault = 0.05;     // mm
constexpr double kCoarsestDefault = 1.0;    // mm
constexpr double kMaxColumns = 50'000'000;  // at the default resolution

Length resolution_for(const Stock& stock, Length given) {
  if (given > Length()) return given;
  const Point3 size = stock.block.size();
  const double area = size.x * size.y;
  const double usual = std::clamp(std::sqrt(area / kColumns), kFinestDefault, kCoarsestDefault);
  return mm(std::max(usual, std::sqrt(area / kMaxColumns)));
}

bool has_code(const Diagnostic& d, Code code) { return d.code == code && d.severity != Severity::error; }

/// A hazard for each assumed tool (Job::tool_sources): the diameter of its cuts is uncertain.
std::vector<Finding> assumed_tools(const Job& job) {
  std::map<int, Finding> found;
  const bool laser = job.program.path.has(StepKind::laser_power);
  for_each_motion(job.program.path, [&](const Step& s, const MotionContext& context) {
    if (!s.is_cutting() || !context.tool || laser) return;
    const auto source = job.tool_sources.find(*context.tool);
    if (source == job.tool_sources.end() || source->second != ToolSource::assumed) return;
    const auto [it, is_new] = found.try_emplace(*context.tool);
    if (!is_new) return void(++it->second.steps);
    const bool at_start = job.start_tool == context.tool;
    const std::string diameter = number_text(job.tools.find(*context.tool)->diameter.mm(), 3);
    const std::string cut = at_start
                                ? std::string("a cut before the first tool change")
                                : fmt::format("a cut with tool {}, whose shape is unknown", *context.tool);
    it->second = {.kind = at_start ? "no_tool" : "unknown_tool",
                  .step = context.index,
                  .at = s.to(),
                  .origin = job.program.path.origin_of(context.index),
                  .message = fmt::format("{}; assuming a square end mill of {} mm", cut, diameter),
                  .callers = job.program.path.origins().callers(s.origin()),
                  .hint = hint_for_unknown(at_start ? std::nullopt : context.tool, diameter)};
  });
  std::vector<Finding> list;
  for (auto& [tool, finding] : found) list.push_back(std::move(finding));
  return list;
}

/// What was not examined, and so is a finding of its own: "no hazard found" holds for whole programs only.
struct Unexamined {
  Code code;
  std::string_view kind;
  std::string_view reason;  // added to the message
};
constexpr Unexamined kUnexamined[] = {
    {codes::unknown_g_code, "left_out", "; it may be a motion"},
    {codes::compensation_no_tool, "unknown_diameter", ""},
    {codes::unknown_m_code, "left_out", "; it may move the machine"},
    {codes::offset_unknown, "offset_unknown", ""},
    {codes::value_unknown, "value_unknown", ""},
    {codes::tool_length_other, "tool_length", ""},
    {codes::turning_program, "not_checked", ""},
    {codes::tool_shape_assumed, "unknown_shape", ""},
    {codes::not_simulated, "not_checked", ""},
    {codes::rotary_not_simulated, "not_checked", ""},
    {codes::extrusion_not_simulated, "not_checked", ""},
    {codes::z_correction_not_simulated, "not_checked", ""},
    {codes::cut_at_unknown_place, "not_checked", ""},
    {codes::stock_untouched, "stock_untouched", ""},
    {codes::units_doubtful, "units_doubtful", ""},
    {codes::print_width_differs, "width_differs", ""},
    {codes::print_at_unknown_place, "not_checked", ""},
};

/// Whether the material not being checked stays a warning: a finding has the reason already, or the program
/// removes nothing, as a laser's.
bool is_reason_found(const std::vector<Finding>& findings, const Toolpath& path) {
  return path.has(StepKind::laser_power) ||
         std::any_of(findings.begin(), findings.end(), [](const Finding& f) {
           return f.kind == "unknown_tool" || f.kind == "no_tool" || f.kind == "z_downwards";
         });
}

const Unexamined* find_unexamined(const Diagnostic& d, bool reason_found) {
  if (d.severity != Severity::warning || (d.code == codes::not_simulated && reason_found)) return nullptr;
  const auto* found = std::find_if(std::begin(kUnexamined), std::end(kUnexamined),
                                   [&](const Unexamined& u) { return u.code == d.code; });
  return found == std::end(kUnexamined) ? nullptr : found;
}

/// Findings for what `diagnostics` reports as not examined, in the order of lines.
std::vector<Finding> unexamined(const Diagnostics& diagnostics, bool reason_found) {
  std::vector<Finding> list;
  for (const Diagnostic& d : diagnostics.list())
    if (const Unexamined* what = find_unexamined(d, reason_found))
      list.push_back({.kind = std::string(what->kind),
                      .at = {},
                      .origin = d.where,
                      .message = d.message + std::string(what->reason),
                      .callers = {},
                      .hint = d.hint,
                      .about = d.message});
  const auto line_of = [](const Finding& f) {
    const auto* text = std::get_if<TextLocation>(&f.origin);
    return text == nullptr ? 0u : text->line;
  };
  std::stable_sort(list.begin(), list.end(),
                   [&](const Finding& a, const Finding& b) { return line_of(a) < line_of(b); });
  return list;
}

bool is_at_or_after(const Origin& origin, const Origin& other) {
  const auto *a = std::get_if<TextLocation>(&origin), *b = std::get_if<TextLocation>(&other);
  return a != nullptr && b != nullptr && a->line >= b->line && a->file == b->file;
}

/// Sets step and position of findings that have a line only: the next motion, else the last one. The findings
/// are in the order of lines.
void assign_steps(std::vector<Finding>& findings, const Toolpath& path) {
  std::size_t done = 0;
  for (std::size_t i = 0; i < path.size() && done < findings.size(); ++i) {
    if (!path[i].is_motion()) continue;
    const Origin origin = path.origin_of(i);
    for (std::size_t k = done; k < findings.size(); ++k) {
      findings[k].step = i;
      findings[k].at = path[i].to();
    }
    while (done < findings.size() && is_at_or_after(origin, findings[done].origin)) ++done;
  }
}

/// The hazards in the material, as far as it can be simulated; a warning if not completely.
std::vector<Finding> findings_in_material(const Job& job, const JobCheckOptions& options,
                                          Diagnostics& diagnostics, Progress* progress) {
  if (job.kind == JobKind::print) return findings_in_print(job, options, diagnostics, progress);
  if (!job.stock && !job.bar) {
    diagnostics.warning(codes::not_simulated, TextLocation{job.program.source, 0, 0},
                        "the material is not checked, because no stock is given or assumed");
    return {};
  }
  const Toolpath& path = job.program.path;
  if (path.size() == 0) return {};
  SimulationOptions how = simulation_of(job);
  how.threads = options.threads;
  how.volumes_by_tool = true;
  if (job.bar) {
    how.resolution = options.resolution;
    const auto simulation = simulate_rotary(path, job.tools, *job.bar, how, diagnostics, progress);
    if (!simulation) return {};
    if (!simulation->stopped) warn_untouched(job, simulation->removed, diagnostics);
    return findings_of(simulation->hazards, path);
  }
  how.resolution = resolution_for(*job.stock, options.resolution);
  if (progress != nullptr) progress->phase("checking");
  const auto simulation = simulate({borrowed(path), job.tools, *job.stock, how}, diagnostics, progress);
  if (!simulation) return {};
  warn_units(job, diagnostics);
  if (!simulation->stopped) warn_untouched(job, simulation->removed, diagnostics);
  std::vector<Finding> found = findings_of(simulation->hazards, path);
  found = merged(std::move(found), findings_of(find_grazes(*simulation, {}, progress), path));
  return merged(findings_at_fixtures(path, job, how, diagnostics, progress), std::move(found));
}

std::vector<Finding> findings_in_path(const Job& job, const JobCheckOptions& options) {
  CheckOptions checks;
  checks.end = job.program.end;
  checks.manual_spindle = job.program.manual_spindle;
  checks.machine = options.machine;
  checks.material = options.material;
  checks.tools = &job.tools;
  if (job.stock && !job.z_downwards) checks.stock = job.stock->block;
  if (job.bar) checks.stock = box_of(*job.bar);
  return merged(findings_of(check_path(job.program.path, checks), job.program.path), assumed_tools(job));
}

/// Removes the diagnostics that are also findings, so that each is reported once.
void remove_hazards(Diagnostics& diagnostics, bool reason_found) {
  diagnostics.remove_if([&](const Diagnostic& d) {
    return has_code(d, codes::no_feed) || has_code(d, codes::no_program_end) ||
           has_code(d, codes::no_tool_shape) || find_unexamined(d, reason_found) != nullptr;
  });
}

}  // namespace

std::vector<Finding> left_out_codes(Diagnostics& diagnostics, const Toolpath& path) {
  constexpr std::string_view kKind = "left_out";
  std::vector<Finding> list = unexamined(diagnostics, true);
  list.erase(std::remove_if(list.begin(), list.end(), [&](const Finding& f) { return f.kind != kKind; }),
             list.end());
  assign_steps(list, path);
  diagnostics.remove_if([&](const Diagnostic& d) {
    const Unexamined* what = find_unexamined(d, true);
    return what != nullptr && what->kind == kKind;
  });
  return list;
}

std::vector<Finding> check_with_material(const Job& job, const JobCheckOptions& options,
                                         std::vector<Finding> in_material, Diagnostics& diagnostics) {
  std::vector<Finding> findings = merged(findings_in_path(job, options), std::move(in_material));
  const bool reason_found = is_reason_found(findings, job.program.path);
  std::vector<Finding> not_examined = unexamined(diagnostics, reason_found);
  assign_steps(not_examined, job.program.path);
  remove_hazards(diagnostics, reason_found);
  return merged(std::move(findings), std::move(not_examined));
}

std::vector<Finding> check_job(const Job& job, const JobCheckOptions& options, Diagnostics& diagnostics,
                               Progress* progress) {
  std::vector<Finding> in_material;
  if (job.z_downwards && !diagnostics.has_errors()) {
    diagnostics.warning(codes::not_simulated, TextLocation{job.program.source, 0, 0},
                        "the material is not checked, because Z seems to count downwards");
  } else if (!diagnostics.has_errors()) {
    in_material = findings_in_material(job, options, diagnostics, progress);
    warn_assumed_flutes(in_material, job.program.path, job.tools, diagnostics);
  }
  return check_with_material(job, options, std::move(in_material), diagnostics);
}

}  // namespace kerf

// The check of a job: its toolpath, and by a coarse simulation the stock and the fixtures.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "job/choices.h"
#include "job/fixture_findings.h"

#include "kerf/number.h"
#include "kerf/rotary.h"

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

/// Hazards that reading the program has reported: unknown G codes, which may be motions, and cutter
/// compensation with an assumed diameter.
std::vector<Finding> findings_of_reading(const Diagnostics& diagnostics) {
  std::vector<Finding> list;
  for (const Diagnostic& d : diagnostics.list()) {
    const bool skipped = has_code(d, Code::unknown_g_code);
    if (!skipped && !has_code(d, Code::compensation_no_tool)) continue;
    list.push_back({.kind = skipped ? "left_out" : "unknown_diameter",
                    .at = {},
                    .origin = d.where,
                    .message = skipped ? d.message + "; it may be a motion" : d.message,
                    .callers = {},
                    .hint = d.hint});
  }
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
  if (!job.stock && !job.bar) {
    diagnostics.warning(Code::not_simulated, TextLocation{job.program.source, 0, 0},
                        "the material is not checked, because nothing is cut and no stock is given");
    return {};
  }
  const Toolpath& path = job.program.path;
  if (path.size() == 0) return {};
  SimulationOptions how;
  how.threads = options.threads;
  if (job.bar) {
    how.resolution = options.resolution;
    const auto simulation = simulate_rotary(path, job.tools, *job.bar, how, diagnostics, progress);
    return simulation ? findings_of(simulation->hazards, path) : std::vector<Finding>{};
  }
  how.resolution = resolution_for(*job.stock, options.resolution);
  if (progress != nullptr) progress->phase("checking");
  const auto simulation = simulate({borrowed(path), job.tools, *job.stock, how}, diagnostics, progress);
  if (!simulation) return {};
  if (!simulation->stopped) warn_untouched(job, simulation->removed, diagnostics);
  return merged(findings_at_fixtures(path, job, how, diagnostics, progress),
                findings_of(simulation->hazards, path));
}

std::vector<Finding> findings_in_path(const Job& job, const JobCheckOptions& options,
                                      const Diagnostics& diagnostics) {
  CheckOptions checks;
  checks.end = job.program.end;
  checks.manual_spindle = job.program.manual_spindle;
  checks.machine = options.machine;
  checks.material = options.material;
  checks.tools = &job.tools;
  if (job.stock) checks.stock = job.stock->block;
  std::vector<Finding> findings =
      merged(findings_of(check_path(job.program.path, checks), job.program.path), assumed_tools(job));
  std::vector<Finding> of_reading = findings_of_reading(diagnostics);
  assign_steps(of_reading, job.program.path);
  return merged(std::move(findings), std::move(of_reading));
}

/// Removes the diagnostics that are also findings, so that each is reported once.
void remove_hazards(Diagnostics& diagnostics) {
  diagnostics.remove_if([](const Diagnostic& d) {
    return has_code(d, Code::no_feed) || has_code(d, Code::no_program_end) ||
           has_code(d, Code::unknown_g_code) || has_code(d, Code::no_tool_shape) ||
           has_code(d, Code::compensation_no_tool);
  });
}

}  // namespace

std::vector<Finding> check_job(const Job& job, const JobCheckOptions& options, Diagnostics& diagnostics,
                               Progress* progress) {
  std::vector<Finding> findings = findings_in_path(job, options, diagnostics);
  if (job.z_downwards && !diagnostics.has_errors()) {
    diagnostics.warning(Code::not_simulated, TextLocation{job.program.source, 0, 0},
                        "the material is not checked, because Z seems to count downwards");
  } else if (!diagnostics.has_errors()) {
    std::vector<Finding> in_material = findings_in_material(job, options, diagnostics, progress);
    warn_assumed_flutes(in_material, job.program.path, job.tools, diagnostics);
    findings = merged(std::move(findings), std::move(in_material));
  }
  remove_hazards(diagnostics);
  return findings;
}

}  // namespace kerf

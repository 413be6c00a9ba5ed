// The check of a job: its toolpath, and by a coarse simulation the stock and the fixtures.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "job/fixture_findings.h"

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

/// Calls visit(step, context) for every cut with a tool of unknown shape.
template <class Visit>
void for_each_unknown_cut(const Job& job, Visit&& visit) {
  const bool one_tool = job.tools.tools().size() == 1;  // in force before the first tool change
  for_each_motion(job.program.path, [&](const Step& s, const MotionContext& context) {
    if (s.is_cutting() && (context.tool ? job.tools.find(*context.tool) == nullptr : !one_tool))
      visit(s, context);
  });
}

/// A hazard for each tool of unknown shape, since its cuts cannot be checked. Cuts before the first tool
/// change are a hazard of the toolpath.
std::vector<Finding> unknown_tools(const Job& job) {
  std::map<int, Finding> found;
  for_each_unknown_cut(job, [&](const Step& s, const MotionContext& context) {
    if (!context.tool) return;
    const auto [it, is_new] = found.try_emplace(*context.tool);
    if (!is_new) return void(++it->second.steps);
    it->second = {.kind = "unknown_tool",
                  .step = context.index,
                  .at = s.to(),
                  .origin = job.program.path.origin_of(context.index),
                  .message = fmt::format("a cut with tool {}, whose shape is unknown", *context.tool),
                  .callers = job.program.path.origins().callers(s.origin()),
                  .hint = hint_for_unknown(*context.tool)};
  });
  std::vector<Finding> list;
  for (auto& [tool, finding] : found) list.push_back(std::move(finding));
  return list;
}

/// A hazard for each unknown G code: it may be a motion that the toolpath lacks.
std::vector<Finding> skipped_codes(const Diagnostics& diagnostics) {
  std::vector<Finding> list;
  for (const Diagnostic& d : diagnostics.list())
    if (d.code == Code::unknown_g_code && d.severity != Severity::error)
      list.push_back({.kind = "left_out",
                      .at = {},
                      .origin = d.where,
                      .message = d.message + "; it may be a motion",
                      .callers = {},
                      .hint = d.hint});
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

/// The toolpath before the first cut with an unknown tool, with a warning: after it the workpiece is unknown.
/// Nothing if every cut has a known tool.
std::optional<Toolpath> known_part(const Job& job, Diagnostics& diagnostics) {
  const Toolpath& path = job.program.path;
  std::size_t end = path.size();
  for_each_unknown_cut(job, [&](const Step&, const MotionContext& c) { end = std::min(end, c.index); });
  if (end == path.size()) return std::nullopt;
  const auto& steps = path.steps();
  const bool any = std::any_of(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(end),
                               [](const Step& s) { return s.is_cutting(); });
  diagnostics.warning(Code::not_simulated, path.origin_of(end),
                      any ? "the material is not checked from here on, because the tool is unknown"
                          : "the material is not checked, because the tool is unknown");
  Toolpath part;
  part.origins() = path.origins();
  for (std::size_t i = 0; any && i < end; ++i) part.add_copy(path, i);
  return part;
}

/// The hazards in the material, as far as it can be simulated; a warning if not completely.
std::vector<Finding> findings_in_material(const Job& job, const JobCheckOptions& options,
                                          Diagnostics& diagnostics, Progress* progress) {
  if (!job.stock && !job.bar) {
    diagnostics.warning(Code::not_simulated, TextLocation{job.program.source, 0, 0},
                        "the material is not checked, because nothing is cut and no stock is given");
    return {};
  }
  const std::optional<Toolpath> part = known_part(job, diagnostics);
  const Toolpath& path = part ? *part : job.program.path;
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
      merged(findings_of(check_path(job.program.path, checks), job.program.path), unknown_tools(job));
  std::vector<Finding> skipped = skipped_codes(diagnostics);
  assign_steps(skipped, job.program.path);
  return merged(std::move(findings), std::move(skipped));
}

/// Removes the diagnostics that are also findings, so that each is reported once.
void remove_hazards(Diagnostics& diagnostics) {
  diagnostics.remove_if([](const Diagnostic& d) {
    const bool is_hazard =
        d.code == Code::no_feed || d.code == Code::no_program_end || d.code == Code::unknown_g_code;
    return d.severity != Severity::error && is_hazard;
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

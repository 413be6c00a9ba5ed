// Making a job from a program and its settings, and running it.
#include "kerf/job/job.h"

#include <utility>

#include "base/codes/files.h"
#include "job/choices.h"
#include "job/job_findings.h"

namespace kerf {
namespace {

std::optional<JobRun> run_milling(const Job& job, const SimulationOptions& how, Diagnostics& diagnostics,
                                  Progress* progress) {
  if (progress != nullptr) progress->phase("cutting");
  auto simulation = simulate({borrowed(job.program.path), job.tools, *job.stock, how}, diagnostics, progress);
  if (!simulation || simulation->stopped) return std::nullopt;
  warn_units(job, diagnostics);
  warn_untouched(job, simulation->removed, diagnostics);
  auto findings = findings_of_milling(job, simulation->hazards, how, diagnostics, progress);
  return JobRun{std::move(*simulation), std::move(findings)};
}

std::optional<JobRun> run_rotary(const Job& job, const SimulationOptions& how, Diagnostics& diagnostics,
                                 Progress* progress) {
  auto simulation = simulate_rotary(job.program.path, job.tools, *job.bar, how, diagnostics, progress);
  if (!simulation || simulation->stopped) return std::nullopt;
  warn_untouched(job, simulation->removed, diagnostics);
  std::vector<Finding> findings = findings_of(simulation->hazards, job.program.path);
  warn_assumed_flutes(findings, job.program.path, job.tools, diagnostics);
  return JobRun{std::move(*simulation), std::move(findings)};
}

std::optional<JobRun> run_print(const Job& job, const RunOptions& options, Diagnostics& diagnostics,
                                Progress* progress) {
  PrintOptions how;
  how.resolution = options.resolution;
  how.threads = options.threads;
  how.layer_height = options.layer_height;
  auto simulation = simulate_print(job.program.path, how, diagnostics, progress);
  if (!simulation || simulation->stopped) return std::nullopt;
  std::vector<Finding> findings = findings_of(simulation->hazards, job.program.path);
  return JobRun{std::move(*simulation), std::move(findings)};
}

/// Without the tool change that make_job() has inserted.
Toolpath without_first_step(const Toolpath& path) {
  Toolpath out;
  out.reserve(path.size());
  out.origins() = path.origins();
  for (std::size_t i = 1; i < path.size(); ++i) out.add_copy(path, i);
  return out;
}

}  // namespace

SimulationOptions simulation_of(const Job& job) {
  SimulationOptions how;
  how.spoilboard = job.spoilboard;
  how.rapid_rates = job.rapid_rates;
  return how;
}

std::vector<Finding> findings_of_milling(const Job& job, const std::vector<Hazard>& hazards,
                                         const SimulationOptions& how, Diagnostics& diagnostics,
                                         Progress* progress) {
  const Toolpath& path = job.program.path;
  if (job.z_downwards) return findings_of({*job.z_downwards}, path);
  std::vector<Finding> findings =
      merged(findings_of(hazards, path), findings_at_fixtures(path, job, how, diagnostics, progress));
  warn_assumed_flutes(findings, path, job.tools, diagnostics);
  return findings;
}

Job make_job(Program program, const JobSettings& settings, UnknownTool unknown, Diagnostics& diagnostics) {
  Job job;
  job.program = std::move(program);
  job.rapid_rates = settings.rapid_rates;
  choose_tools(job, settings, unknown, diagnostics);
  job.report = report_on(job.program.path, {});
  job.z_downwards = find_z_downwards(job.program.path);
  choose_stock(job, settings, diagnostics);
  return job;
}

Program program_of(const Job& job) {
  Program program = job.program;
  if (job.start_tool) program.path = without_first_step(job.program.path);
  program.tools.clear();
  const auto add_tool = [&](int number, int as) {
    const auto source = job.tool_sources.find(number);
    const bool is_assumed = source != job.tool_sources.end() && source->second == ToolSource::assumed;
    if (const Tool* tool = job.tools.find(number); tool != nullptr && !is_assumed)
      program.tools.emplace(as, *tool);
  };
  for (const Step& s : program.path.steps())
    if (s.kind() == StepKind::tool_change) add_tool(s.tool_change().tool, s.tool_change().tool);
  // Of the motions before the first tool change; see start_tool().
  if (job.start_tool) add_tool(*job.start_tool, program.tools.empty() ? *job.start_tool : 0);
  program.tools_are = ToolsOfProgram::whole;
  program.stock = job.stock_source == StockSource::assumed ? std::nullopt : job.stock;
  program.bar = job.bar;
  program.fixtures = job.fixtures;
  program.spoilboard = job.spoilboard;
  return program;
}

Job make_print_job(Program program) {
  Job job;
  job.kind = JobKind::print;
  job.program = std::move(program);
  job.report = report_on(job.program.path, {});
  return job;
}

Job make_job_or_print(Program program, const JobSettings& settings, UnknownTool unknown,
                      Diagnostics& diagnostics) {
  if (is_print(program.path)) return make_print_job(std::move(program));
  return make_job(std::move(program), settings, unknown, diagnostics);
}

std::optional<JobRun> run_job(const Job& job, const RunOptions& options, Diagnostics& diagnostics,
                              Progress* progress) {
  SimulationOptions how = simulation_of(job);
  how.resolution = options.resolution;
  how.threads = options.threads;
  how.volumes_by_tool = options.volumes_by_tool;
  std::optional<JobRun> run;
  switch (job.kind) {
    case JobKind::print: run = run_print(job, options, diagnostics, progress); break;
    case JobKind::rotary: run = run_rotary(job, how, diagnostics, progress); break;
    case JobKind::milling:
      if (job.stock) {
        run = run_milling(job, how, diagnostics, progress);
      } else {
        diagnostics.error(codes::nothing_to_cut, TextLocation{job.program.source, 0, 0},
                          "no stock is given or assumed: nothing to simulate");
      }
  }
  if (diagnostics.has_errors() || (progress != nullptr && progress->stop_requested())) return std::nullopt;
  return run;
}

}  // namespace kerf

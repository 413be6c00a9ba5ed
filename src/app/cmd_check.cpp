// kerf check: what would break a tool, a part or the machine's patience, found without writing any file.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>

#include "app/command.h"
#include "app/findings.h"
#include "app/job.h"
#include "app/terminal_progress.h"

#include "kerf/material_files.h"
#include "kerf/number.h"

namespace kerf::app {
namespace {

constexpr double kColumns = 500'000;                // of the coarse simulation that finds hazards
constexpr double kFinestDefault = 0.05;             // mm
constexpr double kCoarsestDefault = 1.0;            // mm
constexpr double kFinest = 0.0005, kCoarsest = 50;  // mm, --resolution

struct Options {
  OutputOptions output;
  JobOptions job;
  double resolution = 0.0;
  std::string material;
};

Length resolution_for(const Stock& stock, double told) {
  if (told > 0.0) return mm(told);
  const Point3 size = stock.block.size();
  return mm(std::clamp(std::sqrt(size.x * size.y / kColumns), kFinestDefault, kCoarsestDefault));
}

/// The hazards met in the material; nothing where it could not be simulated (`diagnostics` says why).
std::optional<std::vector<Finding>> findings_in_material(const Job& job, double resolution,
                                                         Diagnostics& diagnostics, Progress& progress) {
  const bool toolless = job.tool_sources.empty();
  if (!job.stock || toolless) {
    diagnostics.warning(Code::not_simulated, TextSpot{job.program.source, 0, 0},
                        toolless ? "no tool is known, so the material was not looked at"
                                 : "nothing is cut and no stock is told, so the material was not looked at");
    return std::nullopt;
  }
  SimulationOptions how;
  how.resolution = resolution_for(*job.stock, resolution);
  progress.phase("checking");
  const auto simulation = simulate(job.program.path, job.tools, *job.stock, how, diagnostics, &progress);
  if (!simulation) return std::nullopt;
  return findings_of(simulation->hazards, job.program.path);
}

void show_result(Console& console, const LoadedProgram& program, const std::vector<Finding>& findings,
                 const Diagnostics& diagnostics) {
  console.show(diagnostics);
  if (console.json()) {
    const Json out{
        {"source", program.source}, {"hazards", json_of(findings)}, {"diagnostics", json_of(diagnostics)}};
    console.print_json(text_of(out, Layout::indented));
    return;
  }
  show(console, findings);
  if (findings.empty() && !diagnostics.has_errors())
    console.summary(fmt::format("{}: {} steps, no hazard found", program.source, program.path.size()));
}

Status run(Console& console, const Options& options) {
  Diagnostics usage, diagnostics;
  const JobSettings settings = read_job_options(options.job, usage, diagnostics);
  std::optional<Material> material;
  if (!options.material.empty()) material = material_named(options.material, usage);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  TerminalProgress progress(console);
  std::optional<LoadedProgram> program;
  if (!diagnostics.has_errors())
    program = load_program(options.job.file, diagnostics, &progress, settings.input);
  progress.clear();
  if (!program) {
    show_result(console, LoadedProgram{}, {}, diagnostics);
    return Status::input_errors;
  }
  std::vector<Finding> findings;
  const ProgramEnd end = program->end;
  const Job job = make_job(std::move(*program), settings, {}, UnknownTool::error_if_numbered, diagnostics);
  CheckOptions checks;
  checks.end = end;
  checks.machine = settings.input.machine ? &*settings.input.machine : nullptr;
  checks.material = material ? &*material : nullptr;
  checks.tools = &job.tools;
  if (job.stock) checks.stock = job.stock->block;
  findings = findings_of(check_path(job.program.path, checks), job.program.path);
  if (!diagnostics.has_errors()) {
    auto in_material = findings_in_material(job, options.resolution, diagnostics, progress);
    if (in_material) findings = merged(std::move(findings), std::move(*in_material));
  }
  progress.clear();
  if (interrupted()) return tell_stopped(console);
  // A missing feed or end is a hazard of its own, and told once.
  for (const Code told : {Code::no_feed, Code::no_program_end}) diagnostics.forget_mild(told);
  show_result(console, job.program, findings, diagnostics);
  if (diagnostics.has_errors()) return Status::input_errors;
  return findings.empty() ? Status::done : Status::hazards;
}

const char* const kExamples =
    R"(  kerf check part.nc && echo "good to cut"
  kerf check part.nc --json --stock "100x60x12 at lower-left top"
  kerf check part.nc --machine data/machines/grbl_router.toml --material plywood

Looks for rapids through the stock, shank and holder contact, cuts deeper than the flute or below the floor,
cuts without feed, tool or turning spindle, arcs that controllers refuse, plunges with tools that cannot,
tool changes below the stock's top, a missing program end; with --machine also moves out of its travel and
speeds that its spindle has not; with --material feeds that the teeth cannot take.
Exit status: 0 nothing found, 1 errors in the program, 2 wrong usage, 3 hazards.
)";

}  // namespace

Command add_check(CLI::App& root) {
  auto options = std::make_shared<Options>();
  CLI::App* app =
      new_command(root, "check", "Look for hazards in a program, without writing files; exit status 3",
                  kExamples + std::string(kJobHelp), options->output);
  add_job_options(*app, options->job);
  add_machine_option(*app, options->job);
  app->add_option("--material", options->material,
                  "The stock's material, for the chip load: plywood, aluminium ...")
      ->type_name("NAME");
  add_number(*app, "--resolution", options->resolution, kFinest, kCoarsest, "MM",
             "Distance of the material columns in mm (default: coarse, by the stock's size)");
  return {app, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app

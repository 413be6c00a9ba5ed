// kerf check: the hazards of a program, without writing files.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <memory>

#include "app/commands/commands.h"
#include "app/options/common.h"
#include "app/options/job_options.h"
#include "app/options/printer_option.h"
#include "app/report/findings.h"
#include "app/report/terminal_progress.h"
#include "base/number.h"
#include "job/record/figures.h"

#include "kerf/formats/machine_files.h"
#include "kerf/sim/rotary.h"

namespace kerf::app {
namespace {

constexpr double kFinest = 0.0005, kCoarsest = 50;  // mm, --resolution

struct Options {
  OutputOptions output;
  JobOptions job;
  double resolution = 0.0, threads = 0.0;
  std::string material, printer;
  double layer_height = 0.0;
  std::vector<Option> cutting_options;   // without effect on a print
  std::vector<Option> printing_options;  // without effect on a milling job
};

void show_result(Console& console, const Program& program, const std::vector<Finding>& findings,
                 const Diagnostics& diagnostics) {
  console.show(diagnostics);
  if (console.json()) {
    const Record out{{"source", program.source},
                     {"hazards", record_of(findings)},
                     {"diagnostics", record_of(diagnostics)}};
    console.print_json(text_of(out, Layout::indented));
    return;
  }
  show(console, findings);
  if (findings.empty() && !diagnostics.has_errors())
    console.summary(fmt::format("{}: {} steps, no hazard found", program.source, program.path.size()));
}

Status run(Console& console, const Options& options) {
  Diagnostics usage, diagnostics;
  JobInputs inputs = read_job_options(options.job, usage, diagnostics);
  inputs.program.unknown_diameter = UnknownDiameter::assume;
  std::optional<Material> material;
  if (!options.material.empty()) material = material_named(options.material, usage);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  std::optional<PrinterChoice> printer;
  if (!options.printer.empty()) printer = load_printer(options.printer, diagnostics);
  TerminalProgress progress(console);
  std::optional<Program> program;
  if (!diagnostics.has_errors())
    program = load_program(options.job.file, inputs.program, diagnostics, &progress);
  progress.clear();
  if (!program) {
    show_result(console, Program{}, {}, diagnostics);
    return Status::input_errors;
  }
  const Job job = make_job_or_print(std::move(*program), inputs.job, UnknownTool::assume, diagnostics);
  if (job.kind == JobKind::print)
    warn_unused(options.cutting_options, "the program prints and cuts nothing", "", diagnostics);
  else
    warn_unused(options.printing_options, "the program does not print, or cuts as well", "", diagnostics);
  JobCheckOptions how;
  if (options.layer_height > 0.0) how.layer_height = mm(options.layer_height);
  how.resolution = mm(options.resolution);
  how.threads = static_cast<unsigned>(options.threads);
  how.machine = inputs.program.machine ? &*inputs.program.machine : nullptr;
  how.material = material ? &*material : nullptr;
  how.printer = printer ? &*printer : nullptr;
  const std::vector<Finding> findings = check_job(job, how, diagnostics, &progress);
  progress.clear();
  if (interrupted()) return report_stopped(console);
  console.set_lengths(LengthText(units_of_text(options.job, job.program)));
  show_result(console, job.program, findings, diagnostics);
  if (diagnostics.has_errors()) return Status::input_errors;
  return findings.empty() ? Status::done : Status::hazards;
}

const char* const kExamples =
    R"(  kerf check part.nc && echo "no hazard found"
  kerf check part.nc --json --stock "100x60x12 at lower-left top"
  kerf check print.gcode --printer ender_3:PLA
  kerf check part.nc --machine data/machines/grbl_router.toml --material plywood

Reports rapids through the stock, contact of neck, shank or holder, cuts deeper than the flute or below the
floor, cuts without feed, without a tool or with the spindle stopped, arcs that controllers refuse, plunges of
tools that do not cut at their centre, tool changes below the stock's top, unknown G codes and a missing
program end; of a print the nozzle in printed material, beads in the air, cold extrusion and, with --printer,
motions outside of the bed and more flow than the hot end melts; with --machine also motions outside its
travel and spindle speeds outside its range; with --material also feeds that exceed the chip load.
Exit status: 0 no hazard, 1 errors in the program, 2 wrong usage, 3 hazards.
)";

}  // namespace

Command add_check(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(root, "check", "Report the hazards of a program; exit status 3 if there are any",
                  kExamples + std::string(kToolHelp) + kStockHelp + kBodyHelp + kRotaryHelp, options->output);
  add_job_options(parser, options->job);
  add_unit_options(parser, options->job);
  add_setup_options(parser, options->job.bodies);
  add_machine_option(parser, options->job);
  options->cutting_options = {
      parser
          .add_text("--material", options->material,
                    "Material of the stock, for the chip load: plywood, aluminium ...")
          .value_name("NAME")};
  for (const char* name : kCuttingOptions) options->cutting_options.push_back(parser.option(name));
  options->printing_options = {add_layer_height(parser, options->layer_height),
                               add_printer_option(parser, options->printer)};
  add_length(parser, "--resolution", options->resolution, kFinest, kCoarsest,
             "Distance of the dexel columns, e.g. 0.2 or 0.01in (default: coarse, by the stock's size)");
  add_threads(parser, options->threads);
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app

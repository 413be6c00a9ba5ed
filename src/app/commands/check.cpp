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
#include "app/report/annotations.h"
#include "app/report/findings.h"
#include "app/report/terminal_progress.h"
#include "base/number.h"
#include "job/load_material.h"
#include "job/named.h"
#include "job/record/figures.h"

#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"
#include "kerf/sim/rotary.h"

namespace kerf::app {
namespace {

struct Options {
  OutputOptions output;
  JobOptions job;
  std::vector<std::string> files;
  std::string format = "text";
  double resolution = 0.0, threads = 0.0;
  std::string material, printer;
  double layer_height = 0.0;
  std::vector<Option> cutting_options;   // without effect on a print
  std::vector<Option> printing_options;  // without effect on a milling job
};

/// The results of all files.
class Results {
 public:
  Results(Console& console, const Options& options) : console_(console), format_(options.format) {
    console.set_object_lines(options.files.size() > 1);
  }

  void show(const std::string& file, const Program& program, const std::vector<Finding>& findings,
            const Diagnostics& diagnostics) {
    if (format_ != "text") return annotate(annotations_of(findings, diagnostics, file));
    console_.show(diagnostics);
    if (console_.json()) {
      const Record out{{"source", program.source},
                       {"hazards", record_of(findings)},
                       {"diagnostics", record_of(diagnostics)}};
      print_object(console_, out);
      return;
    }
    kerf::app::show(console_, findings);
    if (findings.empty() && !diagnostics.has_errors())
      console_.summary(fmt::format("{}: {} steps, no hazard found", program.source, program.path.size()));
  }
  /// Prints what has one form for all files.
  void finish() {
    if (format_ == "sarif") console_.print_json(text_of(sarif_log(all_), Layout::indented));
  }

 private:
  void annotate(std::vector<Annotation> annotations) {
    for (Annotation& annotation : annotations) {
      if (format_ == "gcc") console_.print(gcc_line(annotation));
      if (format_ == "github") console_.print(github_line(annotation));
      if (format_ == "sarif") all_.push_back(std::move(annotation));
    }
  }

  Console& console_;
  const std::string& format_;
  std::vector<Annotation> all_;  // for SARIF
};

/// What holds for all files.
struct Setup {
  const Options& options;
  JobInputs inputs;
  std::optional<Material> material;
  std::optional<PrinterChoice> printer;
};

JobCheckOptions check_options(const Setup& setup) {
  JobCheckOptions how;
  if (setup.options.layer_height > 0.0) how.layer_height = mm(setup.options.layer_height);
  how.resolution = mm(setup.options.resolution);
  how.threads = static_cast<unsigned>(setup.options.threads);
  how.machine = setup.inputs.program.machine ? &*setup.inputs.program.machine : nullptr;
  how.material = setup.material ? &*setup.material : nullptr;
  how.printer = setup.printer ? &*setup.printer : nullptr;
  return how;
}

/// Checks one file; `diagnostics` has those of the options.
Status check_file(Console& console, const Setup& setup, const std::string& file, Diagnostics diagnostics,
                  Results& results) {
  const Options& options = setup.options;
  TerminalProgress progress(console);
  std::optional<Program> program;
  if (!diagnostics.has_errors()) program = load_program(file, setup.inputs.program, diagnostics, &progress);
  progress.clear();
  if (!program) {
    Program unread;
    unread.source = file;
    results.show(file, unread, {}, diagnostics);
    return Status::input_errors;
  }
  const Job job = make_job_or_print(std::move(*program), setup.inputs.job, UnknownTool::assume, diagnostics);
  if (job.kind == JobKind::print)
    warn_unused(options.cutting_options, "the program prints and cuts nothing", "", diagnostics);
  else
    warn_unused(options.printing_options, "the program does not print, or cuts as well", "", diagnostics);
  const std::vector<Finding> findings = check_job(job, check_options(setup), diagnostics, &progress);
  progress.clear();
  if (interrupted()) return report_stopped(console);
  console.set_lengths(LengthText(units_of_text(options.job, job.program)));
  results.show(file, job.program, findings, diagnostics);
  if (diagnostics.has_errors()) return Status::input_errors;
  return findings.empty() ? Status::done : Status::hazards;
}

Status run(Console& console, const Options& options) {
  Diagnostics usage, diagnostics;
  TerminalProgress progress(console);
  Setup setup{options, read_job_options(options.job, usage, diagnostics, &progress), {}, {}};
  progress.clear();
  if (interrupted()) return report_stopped(console);
  setup.inputs.program.unknown_diameter = UnknownDiameter::assume;
  if (!options.material.empty()) {
    const std::string file = located(Named::material, options.material, used_configuration());
    setup.material = load_material(file, end_of_material_file(file) ? diagnostics : usage);
  }
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  if (!options.printer.empty()) setup.printer = printer_called(options.printer, diagnostics);
  Results results(console, options);
  Status status = Status::done;
  for (const std::string& file : options.files) {
    status = worse(status, check_file(console, setup, file, diagnostics, results));
    if (status == Status::interrupted) return status;
  }
  results.finish();
  return status;
}

const char* const kExamples =
    R"(  kerf check part.nc && echo "no hazard found"
  kerf check part.nc --json --stock "100x60x12 at lower-left top"
  kerf check *.nc                                    with --json one line for each file
  kerf check part.nc --format gcc                    lines that editors understand
  kerf check *.nc --format sarif > kerf.sarif        for code scanning
  kerf check print.gcode --printer ender_3:PLA
  kerf check part.nc --machine grbl_router --material plywood

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
  add_job_options(parser, options->job, options->files);
  add_unit_options(parser, options->job);
  add_setup_options(parser, options->job.bodies);
  add_machine_option(parser, options->job);
  options->cutting_options = {
      parser
          .add_text(
              "--material", options->material,
              "Material of the stock, for the chip load: plywood, aluminium ..., or a file of one (.toml)")
          .value_name("NAME")};
  for (const char* name : kCuttingOptions) options->cutting_options.push_back(parser.option(name));
  options->printing_options = {add_layer_height(parser, options->layer_height),
                               add_printer_option(parser, options->printer)};
  parser
      .add_text("--format", options->format,
                "Form of hazards and messages: for people, for editors and problem matchers, for a workflow "
                "of GitHub, "
                "for code scanning; hazards are errors there")
      .value_name("FORM")
      .one_of({"text", "gcc", "github", "sarif"})
      .excludes(parser.option("--json"));
  add_length(parser, "--resolution", options->resolution, limits::kFinestResolution,
             limits::kCoarsestResolution,
             "Distance of the dexel columns, e.g. 0.2 or 0.01in (default: coarse, by the stock's size)");
  add_threads(parser, options->threads);
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app

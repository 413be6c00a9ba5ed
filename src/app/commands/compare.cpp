// kerf compare: the differences between a cut part and its target mesh.
#include "kerf/sim/compare.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/options/common.h"
#include "app/options/job_options.h"
#include "app/options/output_options.h"
#include "app/report/terminal_progress.h"
#include "base/codes/files.h"
#include "base/number.h"
#include "job/record/figures.h"

#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"

namespace kerf::app {
namespace {

constexpr double kColumns = 1e6;                               // at the default resolution
constexpr double kMinTolerance = 1e-4, kMaxTolerance = 100.0;  // mm
constexpr double kFullColour = 5.0;                            // times the tolerance
constexpr std::size_t kMaxLines = 12;                          // of regions as text; JSON has them all

struct Options {
  OutputOptions output;
  JobOptions job;
  std::string target;
  std::optional<std::string> target_shift;
  std::vector<std::string> outputs;
  std::string to;
  double resolution = 0.0, threads = 0.0;
  double tolerance = 0.05;
  PictureOptions picture = {.view = ""};  // no view: the map from above instead of the part
};

struct Result {
  const Options& options;
  const Job& job;
  const Simulation& simulation;
  const Comparison& comparison;
  const std::vector<PartFile>& outputs;
};

Length full_colour(const Options& options) { return mm(kFullColour * options.tolerance); }

Record record_of_result(const Result& result, const Diagnostics& diagnostics) {
  const Comparison& c = result.comparison;
  Record out;
  out["source"] = result.job.program.source;
  out["target"] = result.options.target;
  out["resolution_mm"] = record_of(result.simulation.workpiece.pitch().mm());
  out["tolerance_mm"] = record_of(result.options.tolerance);
  out["full_colour_mm"] = record_of(full_colour(result.options).mm());
  out.update(record_of(c));
  out["outputs"] = record_of(result.outputs);
  out["diagnostics"] = record_of(diagnostics);
  return out;
}

void show_summary(Console& console, const Result& result) {
  const Comparison& c = result.comparison;
  console.summary(fmt::format("{} against {}, columns {} mm apart", result.job.program.source,
                              result.options.target,
                              number_text(result.simulation.workpiece.pitch().mm(), 4)));
  console.summary(fmt::format("target   {} mm3, part {} mm3", number_text(c.target.mm3(), 1),
                              number_text(c.part.mm3(), 1)));
  console.summary(fmt::format("gouged   {} mm3, {} mm3 of it deeper than {} mm",
                              number_text(c.gouge.mm3(), 3), number_text(c.gouge_beyond.mm3(), 3),
                              number_text(result.options.tolerance, 4)));
  console.summary(fmt::format("rest     {} mm3, {} mm3 of it higher than {} mm", number_text(c.rest.mm3(), 3),
                              number_text(c.rest_beyond.mm3(), 3), number_text(result.options.tolerance, 4)));
  show_written(console, result.outputs);
  if (!result.outputs.empty())
    console.summary(
        fmt::format("colours  red gouged, blue rest, saturated from {} mm; green within tolerance",
                    number_text(full_colour(result.options).mm(), 4)));
  for (std::size_t k = 0; k < std::min(c.regions.size(), kMaxLines); ++k) {
    const DifferenceRegion& r = c.regions[k];
    console.print(fmt::format("{} of {} mm at X{} Y{} Z{}, {} mm3\n", to_string(r.kind),
                              number_text(r.depth.mm(), 3), number_text(r.at.x, 3), number_text(r.at.y, 3),
                              number_text(r.at.z, 3), number_text(r.volume.mm3(), 3)));
  }
  if (c.region_count > kMaxLines)
    console.print(fmt::format("... and {} more regions\n", c.region_count - kMaxLines));
  if (c.region_count == 0) console.summary("the part matches its target within the tolerance");
}

/// All pictures have one view: it is drawn once.
bool write_pictures(const Result& result, const std::optional<View>& view, OutputSet& set,
                    Diagnostics& diagnostics, Progress& progress) {
  if (result.outputs.empty()) return true;
  const auto png = comparison_picture(result.simulation, result.comparison, full_colour(result.options), view,
                                      diagnostics, &progress);
  if (!png) return false;
  for (const PartFile& file : result.outputs)
    if (progress.stop_requested() || !set.write(file.path, *png, diagnostics)) return false;
  return true;
}

Length resolution_for(const Stock& stock, double given) {
  if (given > 0.0) return mm(given);
  const Point3 size = stock.block.size();
  return mm(std::max(std::sqrt(size.x * size.y / kColumns), 0.02));
}

std::optional<Stock> load_target(const Options& options, Diagnostics& usage, Diagnostics& diagnostics,
                                 Progress& progress) {
  auto target = load_stock(options.target, diagnostics, &progress);
  if (!options.target_shift) return target;
  const auto shift = read_shift_option(*options.target_shift, CallLocation{"", 0, "--target-shift"}, usage);
  if (!target || !shift) return std::nullopt;
  StockMove move;
  move.shift = *shift;
  return moved(*target, move);
}

Status compare_job(Console& console, const Options& options, const JobInputs& inputs, const Stock& target,
                   const std::vector<PartFile>& outputs, const std::optional<View>& view,
                   Diagnostics& diagnostics) {
  TerminalProgress progress(console);
  auto program = load_program(options.job.file, inputs.program, diagnostics, &progress);
  if (interrupted()) return report_stopped(console);
  if (!program || diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  const Job job = make_job(std::move(*program), inputs.job, UnknownTool::assume, diagnostics);
  if (!job.stock && !diagnostics.has_errors())
    diagnostics.error(codes::nothing_to_cut, TextLocation{job.program.source, 0, 0},
                      "no stock is given or assumed: nothing to compare");
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  SimulationOptions how;
  how.resolution = resolution_for(*job.stock, options.resolution);
  how.threads = static_cast<unsigned>(options.threads);
  const auto simulation =
      simulate({borrowed(job.program.path), job.tools, *job.stock, how}, diagnostics, &progress);
  std::optional<Comparison> comparison;
  if (simulation && !simulation->stopped)
    comparison =
        compare(*simulation, *target.body, {.tolerance = mm(options.tolerance)}, diagnostics, &progress);
  OutputSet files;
  bool written = false;
  if (comparison && !diagnostics.has_errors())
    written =
        write_pictures({options, job, *simulation, *comparison, outputs}, view, files, diagnostics, progress);
  if (const auto end = finish_outputs(console, progress, written, files, diagnostics)) return *end;
  const Result result{options, job, *simulation, *comparison, outputs};
  console.show(diagnostics);
  if (console.json()) {
    console.print_json(text_of(record_of_result(result, diagnostics), Layout::indented));
  } else {
    show_summary(console, result);
  }
  return Status::done;
}

/// Only pictures are written; meshes are written by kerf simulate.
void refuse_meshes(const std::vector<PartFile>& outputs, Diagnostics& usage) {
  for (const PartFile& file : outputs)
    if (!file.is_picture())
      usage
          .error(codes::output_kind_unknown, CallLocation{"", 0, "-o"},
                 fmt::format("\"{}\" is not a picture", file.path))
          .hint = "kerf compare writes .png; kerf simulate writes the part";
}

Status run(Console& console, const Options& options) {
  Diagnostics usage, diagnostics;
  TerminalProgress progress(console);
  JobInputs inputs = read_job_options(options.job, usage, diagnostics, &progress);
  inputs.program.unknown_diameter = UnknownDiameter::assume;
  std::vector<std::string> files = input_files(options.job);
  files.push_back(options.target);
  auto outputs = read_outputs(options.outputs, options.to, files, usage, diagnostics);
  refuse_meshes(outputs.files, usage);
  const auto target = load_target(options, usage, diagnostics, progress);
  progress.clear();
  if (interrupted()) return report_stopped(console);
  std::string problem;
  std::optional<View> view;
  if (!options.picture.view.empty()) view = read_view(options.picture, problem);
  if (!problem.empty()) console.error(problem);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  if (!problem.empty()) return Status::wrong_usage;
  if (!target || diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  const Status status = compare_job(console, options, inputs, *target, outputs.files, view, diagnostics);
  return send(console, std::move(outputs), status);
}

const char* const kExamples =
    R"(  kerf compare part.nc target.stl                    regions with missing or left-over material
  kerf compare part.nc target.stl -o map.png         the map from above: red gouged, blue left over
  kerf compare part.nc target.stl -o part.png --view iso --section y=20
  kerf compare part.nc target.3mf --tolerance 0.1 --json --target-shift 0,0,-12

The target is a closed mesh in the program's work coordinates. Depths are distances to its surface.
)";

}  // namespace

Command add_compare(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(root, "compare", "Compare the cut part with a target mesh: gouges and excess material",
                  kExamples + std::string(kToolHelp) + kStockHelp + kBodyHelp, options->output);
  add_job_options(parser, options->job);
  parser.add_text("TARGET", options->target, "The nominal part, a closed mesh: .stl .3mf .glb .obj")
      .required();
  add_body_options(parser, options->job.bodies);
  parser.add_text("--target-shift", options->target_shift, "Move the target by X,Y,Z mm").value_name("X,Y,Z");
  const Option output =
      add_outputs(parser, options->outputs, options->output, "Write a picture (.png): the map from above");
  add_output_format(parser, options->to, {"png"}).needs(output);
  add_length(parser, "--tolerance", options->tolerance, kMinTolerance, kMaxTolerance,
             "Differences up to this depth are ignored, e.g. 0.1 or 0.002in (default: 0.05)");
  add_length(parser, "--resolution", options->resolution, limits::kFinestResolution,
             limits::kCoarsestResolution,
             "Distance of the dexel columns, e.g. 0.1 or 0.002in (default: by the stock's size)");
  Option view = parser.add_text("--view", options->picture.view,
                                "Draw the part in the map's colours, seen from: top, iso ...");
  view.value_name("VIEW");
  parser
      .add_text("--size", options->picture.size,
                "WIDTHxHEIGHT of that picture in pixels (default: 1600x1000)")
      .value_name("WxH")
      .needs(view);
  add_section(parser, options->picture).needs(view);
  add_threads(parser, options->threads);
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app

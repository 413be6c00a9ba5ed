// kerf simulate: simulates a program on its stock, prints the volumes and the hazards, writes meshes and
// pictures.
#include <algorithm>
#include <fmt/format.h>
#include <memory>

#include "app/commands/burn.h"
#include "app/commands/commands.h"
#include "app/options/common.h"
#include "app/options/job_options.h"
#include "app/options/output_options.h"
#include "app/report/simulation.h"
#include "app/report/terminal_progress.h"
#include "base/codes/files.h"
#include "base/names.h"
#include "base/number.h"
#include "base/split.h"

#include "kerf/base/limits.h"

namespace kerf::app {
namespace {

struct Options {
  OutputOptions output;
  JobOptions job;
  std::vector<std::string> outputs;
  std::string to;
  double resolution = 0.0;
  double threads = 0.0;
  PictureOptions picture;
  double layer_height = 0.0;
  double mesh_tolerance = 0.0;
  bool grooves = false;
  std::string colour = "tool";
  std::string show = "auto";
  std::string content = "auto";  // of `show`, without marks
  BurnCommand burn;
  std::vector<Option> picture_options;   // without effect where no picture is written
  std::vector<Option> mesh_options;      // without effect where no mesh is written
  std::vector<Option> cutting_options;   // without effect on a print
  std::vector<Option> printing_options;  // without effect on a milling job
};

const std::vector<std::string> kContents{"auto", "part", "path", "burn"};

/// Reads --show: what the picture shows, and marks over it; errors for several contents, and marks of a burn.
void read_show(Options& options, PictureMarks& marks, Diagnostics& usage) {
  std::size_t contents = 0;
  for (const std::string& word : words_of_list(options.show)) {
    const auto mark = std::find_if(kPictureMarks.begin(), kPictureMarks.end(),
                                   [&](const auto& m) { return m.name == word; });
    if (mark != kPictureMarks.end())
      marks.*mark->member = true;
    else
      options.content = word, ++contents;
  }
  if (contents > 1)
    usage.error(codes::usage, {}, "--show: only one of " + joined(kContents, ", ") + " is shown at once");
  if (options.content == "burn" && marks.any())
    usage.error(codes::usage, {},
                "--show: axes, size and legend are marks of a part or a toolpath, not of a burn");
}

/// The job of a program, with a warning for each given option that has no effect on it.
Job make_job_of(const Options& options, const JobSettings& settings, Program program,
                Diagnostics& diagnostics) {
  if (is_print(program.path)) {
    warn_unused(options.cutting_options, "the program prints and cuts nothing", "", diagnostics);
    return make_print_job(std::move(program));
  }
  warn_unused(options.printing_options, "the program does not print, or cuts as well", "", diagnostics);
  return make_job(std::move(program), settings, UnknownTool::assume, diagnostics);
}

void report(Console& console, const SimulationReport& result) {
  console.show(result.diagnostics);
  switch (result.job.kind) {
    case JobKind::milling: return report_milling(console, result);
    case JobKind::rotary: return report_rotary(console, result);
    case JobKind::print: return report_print(console, result);
  }
}

PictureContent content_of(const Options& options) {
  if (options.content == "part") return PictureContent::part;
  return options.content == "path" ? PictureContent::path : PictureContent::automatic;
}

/// A job without a stock, because nothing is cut or none could be assumed: only pictures of its toolpath can
/// be made.
bool is_drawing(const Job& job, const std::vector<PartFile>& files, PictureContent content) {
  const auto is_picture = [](const PartFile& f) { return f.is_picture(); };
  return job.kind == JobKind::milling && !job.stock && content != PictureContent::part && !files.empty() &&
         std::all_of(files.begin(), files.end(), is_picture);
}

Status draw_path(Console& console, const Job& job, const std::vector<PartFile>& files, const View& view,
                 Diagnostics& diagnostics) {
  diagnostics.warning(codes::path_shown, TextLocation{job.program.source, 0, 0},
                      job.report.all.cut_bounds.empty()
                          ? "the program cuts nothing: the picture shows its toolpath"
                          : "without a stock the picture shows the toolpath");
  OutputSet set(job.program.files);
  if (!write_path(files, job, view, set, diagnostics) || !set.commit(diagnostics))
    return fail(console, diagnostics, Status::input_errors);
  report_drawing(console, job, files, diagnostics);
  return Status::done;
}

Status simulate_job(Console& console, const Options& options, const JobInputs& inputs,
                    const std::vector<PartFile>& files, View view, Diagnostics& diagnostics) {
  TerminalProgress progress(console);
  auto program = load_program(options.job.file, inputs.program, diagnostics, &progress);
  progress.clear();
  if (interrupted()) return report_stopped(console);
  if (!program || diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  if (options.content == "burn") {
    for (const auto* unused : {&options.cutting_options, &options.printing_options})
      warn_unused(*unused, "the picture shows the burn of a laser", "", diagnostics);
    return run_burn(console, options.burn, *program, files, view, progress, diagnostics);
  }
  warn_unused(options.burn.options, "no burn is shown", "--show burn", diagnostics);
  const Job job = make_job_of(options, inputs.job, std::move(*program), diagnostics);
  console.set_lengths(LengthText(units_of_text(options.job, job.program)));
  view.marks.inches = units_of_text(options.job, job.program) == ProgramUnits::inch;
  if (diagnostics.has_errors() || !can_write(files, job.kind, diagnostics))
    return fail(console, diagnostics, Status::input_errors);

  if (is_drawing(job, files, content_of(options))) return draw_path(console, job, files, view, diagnostics);

  RunOptions how;
  how.volumes_by_tool = true;
  how.resolution = mm(options.resolution);
  how.threads = static_cast<unsigned>(options.threads);
  if (options.layer_height > 0.0) how.layer_height = mm(options.layer_height);
  auto run = run_job(job, how, diagnostics, &progress);
  OutputSet set(job.program.files);
  PartFileOptions writing{.view = view,
                          .content = content_of(options),
                          .grooves = options.grooves ? Grooves::kept : Grooves::closed,
                          .beads = *bead_colours_named(options.colour),
                          .machine = inputs.program.machine ? &*inputs.program.machine : nullptr};
  if (options.mesh_tolerance > 0.0) writing.tolerance = mm(options.mesh_tolerance);
  const bool written = run && write_part(files, job, *run, writing, set, diagnostics, &progress);
  if (const auto end = finish_outputs(console, progress, written, set, diagnostics)) return *end;
  for (Finding& finding : left_out_codes(diagnostics, job.program.path))
    run->findings.push_back(std::move(finding));
  report(console, {job, *run, files, diagnostics, bead_legend(job.program.path, writing.beads),
                   mesh_tolerance(files, *run, writing)});
  return Status::done;
}

Status run(Console& console, Options options) {
  Diagnostics usage, diagnostics;
  TerminalProgress progress(console);
  JobInputs inputs = read_job_options(options.job, usage, diagnostics, &progress);
  progress.clear();
  if (interrupted()) return report_stopped(console);
  inputs.program.unknown_diameter = UnknownDiameter::assume;
  auto outputs = read_outputs(options.outputs, options.to, input_files(options.job), usage, diagnostics);
  std::string problem;
  auto view = read_view(options.picture, problem);
  if (!view) usage.error(codes::usage, {}, problem);
  PictureMarks marks;
  read_show(options, marks, usage);
  if (view) view->marks = marks;
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  const auto writes = [&](auto kind) {
    return std::any_of(outputs.files.begin(), outputs.files.end(), kind);
  };
  warn_without_mesh(options.mesh_options, outputs.files, diagnostics);
  if (!writes([](const PartFile& f) { return f.is_picture(); }))
    warn_unused(options.picture_options, "no picture is written", "write one with -o FILE.png", diagnostics);
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  const Status status = simulate_job(console, options, inputs, outputs.files, *view, diagnostics);
  return send(console, std::move(outputs), status);
}

const char* const kExamples =
    R"(  kerf simulate part.nc                              the volumes and the hazards
  kerf simulate part.nc -o part.stl -o part.png      the part as a mesh and as a picture
  kerf simulate part.nc --stock 100x60x12 -o sheet.html   a setup sheet for the workshop
  kerf simulate part.nc -o top.png --view top --size 1200x800
  kerf simulate part.nc -o slot.png --view front --section y=20     a cross-section
  kerf simulate part.nc -o path.png --show path      the toolpath over the stock
  kerf simulate part.nc -o part.png --show axes,size,legend   with the zero, the lengths, the colours of tools
  kerf simulate part.nc --tool "ball d=3.175 flute=12.7" --stock "100x60x12 at lower-left top"
  kerf simulate side1.nc -o left.kstock              the left-over stock, for the next job:
  kerf simulate side2.nc --stock-left left.kstock --flip x
  kerf simulate print.gcode -o print.png             a print: beads, overlap, bridges, collisions
  kerf simulate engraving.nc -o burn.png --show burn --spot 0.15 --max-power 10   a laser's energy per area
  cat part.nc | kerf simulate - --json --resolution 0.05
  kerf simulate part.nc -o - --to png | display      a picture to another program
)";

}  // namespace

Command add_simulate(CommandParser& root) {
  std::vector<std::string> shown = kContents;
  for (const PictureMarkName& mark : kPictureMarks) shown.emplace_back(mark.name);
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(root, "simulate", "Simulate a program on its stock; write the part as a mesh or a picture",
                  kExamples + std::string(kToolHelp) + kStockHelp + kBodyHelp + kRotaryHelp, options->output);
  add_job_options(parser, options->job);
  add_unit_options(parser, options->job);
  add_machine_option(parser, options->job);
  add_setup_options(parser, options->job.bodies);
  const Option output = add_outputs(parser, options->outputs, options->output,
                                    "Write the part as a mesh (.stl .3mf .glb .obj), as a picture (.png), as "
                                    "the stock of the next job (.kstock), or a setup sheet (.html .svg)");
  add_output_format(parser, options->to, {"png", "stl", "3mf", "glb", "obj", "kstock", "kerf", "html", "svg"})
      .needs(output);
  add_length(parser, "--resolution", options->resolution, limits::kFinestResolution,
             limits::kCoarsestResolution,
             "Distance of the dexel columns, e.g. 0.1 or 0.002in (default: by the stock's size)");
  options->mesh_options = {add_mesh_tolerance(parser, options->mesh_tolerance)};
  options->picture_options = {
      parser
          .add_text("--view", options->picture.view,
                    "Picture seen from: top, bottom, front, back, left, right, iso, or "
                    "AZIMUTH,ELEVATION (default: -35,50)")
          .value_name("VIEW"),
      parser
          .add_text("--size", options->picture.size,
                    "WIDTHxHEIGHT of the picture in pixels (default: 1600x1000)")
          .value_name("WxH"),
      parser
          .add_text(
              "--show", options->show,
              "The picture shows the part, the toolpath or the burn of a laser: part, path, burn or auto "
              "(default: the part, or the toolpath if no material is removed); with commas also marks over "
              "it: axes (X, Y and Z from the work zero), size (its lengths) and legend (its colours)")
          .value_name("WHAT")
          .list_of(shown),
      add_section(parser, options->picture)};
  options->printing_options = {
      add_layer_height(parser, options->layer_height),
      parser.add_flag("--grooves", options->grooves,
                      "Keep the grooves between beads of a print in meshes and pictures; larger files"),
      parser
          .add_text("--colour,--color", options->colour,
                    "Colour the beads of a print by kind, layer, speed, flow or temperature")
          .value_name("WHAT")
          .one_of({"tool", "kind", "layer", "speed", "flow", "temperature"})};
  add_burn_options(parser, options->burn);
  for (const char* name : kCuttingOptions) options->cutting_options.push_back(parser.option(name));
  add_threads(parser, options->threads);
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app

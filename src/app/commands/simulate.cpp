// kerf simulate: cuts a program out of its stock, tells what was removed and what went wrong, writes meshes
// and pictures.
#include <algorithm>
#include <fmt/format.h>
#include <memory>

#include "app/findings.h"
#include "app/options/command.h"
#include "app/outputs.h"
#include "app/print_job.h"
#include "app/report/terminal_progress.h"
#include "app/rotary_job.h"

#include "kerf/number.h"

namespace kerf::app {
namespace {

constexpr double kFinest = 0.0005, kCoarsest = 50.0;            // mm, --resolution
constexpr double kThinnestLayer = 0.02, kThickestLayer = 20.0;  // mm, --layer-height

struct Options {
  OutputOptions output;
  JobOptions job;
  std::vector<std::string> outputs;
  double resolution = 0.0;
  double threads = 0.0;
  PictureOptions picture;
  double layer_height = 0.0;
  bool grooves = false;
  std::vector<Option> picture_options;   // those that only pictures use
  std::vector<Option> cutting_options;   // those that say nothing of a print
  std::vector<Option> printing_options;  // those that only prints use
};

/// All that a finished simulation has to tell.
struct Result {
  const Job& job;
  const Simulation& simulation;
  std::vector<Finding> findings;
  const std::vector<OutputFile>& outputs;
};

/// mm3 removed and seconds, by the tool in force; key nothing: before any tool change.
std::map<std::optional<int>, double> removed_by_tool(const Job& job, const Simulation& simulation) {
  std::map<std::optional<int>, double> removed;
  std::optional<int> tool;
  for (std::size_t i = 0; i < job.program.path.size(); ++i) {
    if (job.program.path[i].kind() == StepKind::tool_change) tool = job.program.path[i].tool_change().tool;
    removed[tool] += static_cast<double>(simulation.removed_by_step[i]);
  }
  return removed;
}

double seconds_of(const MotionFigures& f) { return (f.cutting + f.rapid + f.dwell).seconds(); }

Json tools_json(const Result& result) {
  const auto removed = removed_by_tool(result.job, result.simulation);
  Json list = Json::array();
  for (const ToolFigures& t : result.job.report.tools) {
    const auto it = removed.find(t.tool);
    Json entry;
    entry["number"] = t.tool ? Json(*t.tool) : Json(nullptr);
    const Tool* tool = t.tool ? result.job.tools.find(*t.tool) : nullptr;
    entry["name"] = tool != nullptr ? Json(short_name(*tool)) : Json(nullptr);
    if (t.tool) entry["source"] = to_string(result.job.tool_sources.at(*t.tool));
    entry["removed_mm3"] = json_of(it == removed.end() ? 0.0 : it->second);
    entry["time_s"] = json_of(seconds_of(t.figures));
    list.push_back(std::move(entry));
  }
  return list;
}

Json json_of_result(const Result& result, const Diagnostics& diagnostics) {
  const Simulation& s = result.simulation;
  Json out;
  out["source"] = result.job.program.source;
  out["stock_mm3"] = json_of(s.stock.mm3());
  out["removed_mm3"] = json_of(s.removed.mm3());
  out["left_mm3"] = json_of(s.stock.mm3() - s.removed.mm3());
  out["resolution_mm"] = json_of(s.workpiece.pitch().mm());
  out["steps"] = result.job.program.path.size();
  out["seconds"] = json_of(s.seconds);
  out["stock"] =
      Json{{"block_mm", json_of(result.job.stock->block)}, {"source", to_string(result.job.stock_source)}};
  out["hazards"] = json_of(result.findings);
  out["tools"] = tools_json(result);
  out["outputs"] = json_of(result.outputs);
  out["diagnostics"] = json_of(diagnostics);
  return out;
}

void show_summary(Console& console, const Result& result) {
  const Simulation& s = result.simulation;
  const Point3 size = result.job.stock->block.size();
  console.summary(fmt::format("{}: {} steps", result.job.program.source, result.job.program.path.size()));
  console.summary(fmt::format("stock    {} x {} x {} mm ({}), {} mm3", number_text(size.x, 3),
                              number_text(size.y, 3), number_text(size.z, 3),
                              to_string(result.job.stock_source), number_text(s.stock.mm3(), 1)));
  const double share = s.stock.mm3() > 0.0 ? 100.0 * s.removed.mm3() / s.stock.mm3() : 0.0;
  console.summary(fmt::format("removed  {} mm3 ({}%), left {} mm3", number_text(s.removed.mm3(), 1),
                              number_text(share, 1), number_text(s.stock.mm3() - s.removed.mm3(), 1)));
  const auto removed = removed_by_tool(result.job, s);
  for (const ToolFigures& t : result.job.report.tools) {
    if (!t.tool || t.figures.cut_bounds.empty()) continue;
    const Tool* tool = result.job.tools.find(*t.tool);
    const auto it = removed.find(t.tool);
    console.summary(fmt::format(
        "tool {:<4}{}: {} mm3 in about {}", *t.tool, tool != nullptr ? short_name(*tool) : "unknown",
        number_text(it == removed.end() ? 0.0 : it->second, 1), clock_text(seconds_of(t.figures))));
  }
  console.summary(fmt::format("columns  {} mm apart, simulated in {} s",
                              number_text(s.workpiece.pitch().mm(), 4), number_text(s.seconds, 3)));
  show_written(console, result.outputs);
  console.summary(fmt::format("hazards  {}", count_text(result.findings)));
}

/// What went wrong in the material and at the fixtures. Of a program whose Z counts downwards only that is
/// told, as all else follows from it.
std::vector<Finding> findings_of_simulation(const Job& job, const Simulation& simulation,
                                            const SimulationOptions& how, Diagnostics& diagnostics,
                                            Progress& progress) {
  const Toolpath& path = job.program.path;
  if (const auto downwards = find_z_downwards(path)) return findings_of({*downwards}, path);
  std::vector<Finding> findings =
      merged(findings_of(simulation.hazards, path),
             findings_at_fixtures(path, job.tools, job.fixtures, how, diagnostics, progress));
  tell_assumed_flutes(findings, path, job.tools, diagnostics);
  return findings;
}

void tell_unused(const std::vector<Option>& options, const std::string& why, const std::string& hint,
                 Diagnostics& diagnostics) {
  for (const Option& option : options)
    if (option.is_given())
      diagnostics.warning(Code::option_unused, CallSpot{"", 0, option.name()}, why).hint = hint;
}

Status print_program(Console& console, const Options& options, const LoadedProgram& program,
                     const std::vector<OutputFile>& outputs, const View& view, Diagnostics& diagnostics) {
  tell_unused(options.cutting_options, "the program prints and cuts nothing", "", diagnostics);
  PrintOptions how;
  how.resolution = mm(options.resolution);
  how.threads = static_cast<unsigned>(options.threads);
  if (options.layer_height > 0.0) how.layer_height = mm(options.layer_height);
  const Grooves grooves = options.grooves ? Grooves::kept : Grooves::closed;
  return simulate_printing(console, program, how, grooves, outputs, view, diagnostics);
}

Status simulate_job(Console& console, const Options& options, const JobSettings& settings,
                    const std::vector<OutputFile>& outputs, const View& view, Diagnostics& diagnostics) {
  TerminalProgress progress(console);
  auto program = load_program(options.job.file, diagnostics, &progress, settings.input);
  progress.clear();
  if (interrupted()) return tell_stopped(console);
  if (!program || diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  if (is_print(program->path)) return print_program(console, options, *program, outputs, view, diagnostics);
  tell_unused(options.printing_options, "the program does not print, or cuts as well", "", diagnostics);
  const Job job = make_job(std::move(*program), settings, {}, UnknownTool::error, diagnostics);
  if (!job.stock && !job.bar && !diagnostics.has_errors())
    diagnostics.error(Code::nothing_to_cut, TextSpot{job.program.source, 0, 0},
                      "the program cuts nothing and tells no stock, so there is nothing to simulate");
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);

  SimulationOptions how;
  how.resolution = mm(options.resolution);
  how.threads = static_cast<unsigned>(options.threads);
  if (job.bar) return simulate_bar(console, job, how, outputs, view, diagnostics);
  progress.phase("cutting");
  const auto simulation = simulate(job.program.path, job.tools, *job.stock, how, diagnostics, &progress);
  std::vector<Finding> findings;
  if (simulation && !simulation->stopped) {
    tell_untouched(job, simulation->removed, diagnostics);
    findings = findings_of_simulation(job, *simulation, how, diagnostics, progress);
  }
  OutputSet files;
  const bool written = simulation && !simulation->stopped && !diagnostics.has_errors() &&
                       write_outputs(outputs, job, *simulation, view, files, diagnostics, progress);
  if (const auto end = finish_outputs(console, progress, written, files, diagnostics)) return *end;

  const Result result{job, *simulation, std::move(findings), outputs};
  console.show(diagnostics);
  if (console.json()) {
    console.print_json(text_of(json_of_result(result, diagnostics), Layout::indented));
    return Status::done;
  }
  show_summary(console, result);
  show(console, result.findings);
  return Status::done;
}

Status run(Console& console, const Options& options) {
  Diagnostics usage, diagnostics;
  const JobSettings settings = read_job_options(options.job, usage, diagnostics);
  const auto outputs = read_outputs(options.outputs, input_files(options.job), usage, diagnostics);
  std::string problem;
  const auto view = read_view(options.picture, problem);
  if (!view) console.complain(problem);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  if (!view) return Status::wrong_usage;
  if (std::none_of(outputs.begin(), outputs.end(), [](const OutputFile& f) { return f.is_picture(); }))
    tell_unused(options.picture_options, "no picture is written", "ask for one with -o FILE.png",
                diagnostics);
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  return simulate_job(console, options, settings, outputs, *view, diagnostics);
}

const char* const kExamples =
    R"(  kerf simulate part.nc                              what is removed, and what goes wrong
  kerf simulate part.nc -o part.stl -o part.png      the part as a mesh and as a picture
  kerf simulate part.nc -o top.png --view top --size 1200x800
  kerf simulate part.nc -o slot.png --view front --section y=20     cut open, to see an undercut
  kerf simulate part.nc --tool "ball d=3.175 flute=12.7" --stock "100x60x12 at lower-left top"
  kerf simulate side1.nc -o left.kstock              what is left, as the stock of the next job:
  kerf simulate side2.nc --stock-left left.kstock --flip x
  kerf simulate print.gcode -o print.png             a print: roads laid, overlap, bridges, collisions
  cat part.nc | kerf simulate - --json --resolution 0.05
)";

}  // namespace

Command add_simulate(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(root, "simulate", "Cut a program out of its stock: the part as a mesh or a picture",
                  kExamples + std::string(kToolHelp) + kStockHelp + kBodyHelp + kRotaryHelp, options->output);
  add_job_options(parser, options->job);
  add_body_options(parser, options->job.bodies);
  add_rotary_option(parser, options->job.bodies);
  add_repeated(parser, "-o,--output", options->outputs, "PATH",
               "Write the part: .stl .3mf .glb .obj, a picture: .png, the stock of the next job: .kstock");
  add_length(parser, "--resolution", options->resolution, kFinest, kCoarsest,
             "Distance of the material columns, mm or 0.002in (default: by the stock's size)");
  options->picture_options = {
      parser
          .add_text("--view", options->picture.view,
                    "Picture from: top, bottom, front, back, left, right, iso, or "
                    "AZIMUTH,ELEVATION (default: -35,50)")
          .value_name("VIEW"),
      parser
          .add_text("--size", options->picture.size, "Picture's WIDTHxHEIGHT in pixels (default: 1600x1000)")
          .value_name("WxH"),
      add_section(parser, options->picture)};
  options->printing_options = {
      add_length(parser, "--layer-height", options->layer_height, kThinnestLayer, kThickestLayer,
                 "Of a print: the layers' height, mm (default: the program's comments, else its steps in Z)"),
      parser.add_flag("--grooves", options->grooves,
                      "Of a print: keep the grooves between roads in meshes and pictures, which get large")};
  for (const char* name : {"--tool", "--tools", "--stock", "--stock-mesh", "--stock-left", "--flip",
                           "--shift", "--fixture", "--rotary"})
    options->cutting_options.push_back(parser.option(name));
  add_threads(parser, options->threads);
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app

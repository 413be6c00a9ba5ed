// kerf info: the size, machining time, tools, feeds and stock of a program.
#include "job/record/info.h"

#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/info_print.h"
#include "app/options/common.h"
#include "app/options/job_options.h"
#include "app/options/printer_option.h"
#include "app/report/terminal_progress.h"
#include "base/clock_text.h"
#include "base/number.h"
#include "job/beam.h"
#include "job/named.h"

#include "kerf/stock/stock.h"

namespace kerf::app {
namespace {

constexpr double kNoTime = 0.5;             // seconds; less is printed as "0:00"
constexpr std::size_t kMaxOperations = 30;  // printed as text; JSON has them all

struct Options {
  OutputOptions output;
  JobOptions job;
  std::vector<std::string> files;
  double density = 0.0;  // g/cm3, of a print's filament
  std::string printer, target;
};

std::string range_text(const Range& range, std::string_view unit) {
  if (range.empty()) return "not given";
  if (range.low == range.high) return fmt::format("{} {}", number_text(range.low, 2), unit);
  return fmt::format("{} to {} {}", number_text(range.low, 2), number_text(range.high, 2), unit);
}

Range in_units(const Range& feed, const LengthText& lengths) {
  const double scale = lengths.unit() == "in" ? kMmPerInch : 1.0;
  return feed.empty() ? feed : Range{feed.low / scale, feed.high / scale};
}

std::string feeds_text(const MotionFigures& all, const LengthText& lengths) {
  const std::string turning =
      all.turn_feed.empty() ? "" : range_text(all.turn_feed, "degrees/min of rotary axes alone");
  if (all.feed.empty() && !turning.empty()) return turning;
  const std::string feeds = range_text(in_units(all.feed, lengths), lengths.feed_unit());
  return turning.empty() ? feeds : feeds + ", " + turning;
}

std::string box_text(const Box3& box, const LengthText& lengths) {
  return fmt::format("X {} to {}, Y {} to {}, Z {} to {}  ({})", lengths.of(box.low.x, 3),
                     lengths.of(box.high.x, 3), lengths.of(box.low.y, 3), lengths.of(box.high.y, 3),
                     lengths.of(box.low.z, 3), lengths.of(box.high.z, 3), lengths.size(box.size()));
}

std::string flute_text(const Tool& tool, const LengthText& lengths) {
  const std::string text = "flute " + lengths.with_unit(tool.flute.mm(), 3);
  return tool.flute_assumed ? fmt::format("{} assumed ({})", text, reason_of_flute(tool)) : text;
}

void print_tools(Console& console, const Job& job, const JobTimes& times) {
  if (job.report.tools.empty()) return;
  const LengthText& lengths = console.lengths();
  console.print("\nTools\n");
  for (const ToolFigures& t : job.report.tools) {
    const double seconds = times.of_tool(t.tool).total().seconds();
    if (!t.tool && t.figures.cut_mm == 0.0 && seconds < kNoTime) continue;  // rapids only
    const Tool* tool = t.tool ? job.tools.find(*t.tool) : nullptr;
    const bool beam = t.tool && is_beam(job, *t.tool);
    std::string line = t.tool ? fmt::format("  T{:<6}", *t.tool) : std::string("  none   ");
    line += fmt::format("{:<28}", beam              ? "beam"
                                  : tool != nullptr ? lengths.tool(*tool)
                                  : t.tool          ? "unknown shape"
                                                    : "before the first tool change");
    line += fmt::format(" cuts {} in {}", lengths.with_unit(t.figures.cut_mm, 1), clock_text(seconds));
    if (t.deepest) line += fmt::format(", deepest Z {}", lengths.of(*t.deepest, 3));
    if (tool != nullptr && !beam) line += ", " + flute_text(*tool, lengths);
    if (deeper_than_flute(job, t)) line += "  <- deeper than its flute";
    if (tool != nullptr) line += fmt::format("  ({})", to_string(job.tool_sources.at(*t.tool)));
    console.print(line + "\n");
  }
}

void print_time(Console& console, const JobTimes& times) {
  const TimeFigures& all = times.estimate.all;
  std::string parts = fmt::format("{} cutting, {} rapid, {} dwell", clock_text(all.cutting().seconds()),
                                  clock_text(all.rapid.seconds()), clock_text(all.dwell.seconds()));
  if (all.stops > 0 && all.halts.seconds() > 0.0)
    parts += fmt::format(", {} at {} full stops", clock_text(all.halts.seconds()), all.stops);
  console.print(fmt::format("Time      about {}: {}\n", clock_text(all.total().seconds()), parts));
  console.print(times.planned()
                    ? fmt::format("          on {}, {} ({} motions, {} full stops)\n", times.machine,
                                  kPlannedMethod, times.estimate.moves, all.stops)
                    : fmt::format("          {}; --machine plans with accelerations\n", kPlainMethod));
}

void print_operations(Console& console, const JobTimes& times) {
  std::vector<const OperationTime*> shown;
  for (const OperationTime& o : times.estimate.operations)
    if (o.tool || !o.name.empty() || o.time.total().seconds() >= kNoTime) shown.push_back(&o);
  if (shown.size() < 2) return;
  console.print("\nOperations\n");
  for (std::size_t i = 0; i < std::min(shown.size(), kMaxOperations); ++i) {
    const OperationTime& o = *shown[i];
    std::string line = fmt::format("  {:<9}{:>9}", o.tool ? fmt::format("T{}", *o.tool) : "no tool",
                                   clock_text(o.time.total().seconds()));
    if (!o.name.empty()) line += "  " + o.name;
    console.print(line + "\n");
  }
  if (shown.size() > kMaxOperations)
    console.print(fmt::format("  ... and {} more (--json lists them)\n", shown.size() - kMaxOperations));
}

void print_info(Console& console, const Job& job, const JobTimes& times) {
  const MotionFigures& all = job.report.all;
  const LengthText& lengths = console.lengths();
  console.print(fmt::format("{}: {}, {}, {} steps\n\n", job.program.source, job.program.front_end,
                            job.program.units == ProgramUnits::inch ? "inches" : "mm",
                            job.program.path.size()));
  console.print(fmt::format("Motions   {} lines, {} arcs, {} rapids\n", all.lines, all.arcs, all.rapids));
  console.print(fmt::format("Length    {} cut, {} rapid\n", lengths.with_unit(all.cut_mm, 1),
                            lengths.with_unit(all.rapid_mm, 1)));
  if (!all.cut_bounds.empty())
    console.print(fmt::format("Cuts      {}\n", box_text(all.cut_bounds, lengths)));
  if (job.stock)
    console.print(
        fmt::format("Stock     {}, {}\n", box_text(job.stock->block, lengths), to_string(job.stock_source)));
  console.print(fmt::format("Feeds     {}\n", feeds_text(all, lengths)));
  console.print(fmt::format("Spindle   {}\n", range_text(all.speed, "rpm")));
  print_time(console, times);
  print_tools(console, job, times);
  print_operations(console, times);
  if (job.program.end == ProgramEnd::missing) console.print("\nThe program has no M2, M30 or closing %.\n");
}

/// What holds for all files.
struct Setup {
  JobInputs inputs;
  std::optional<PrinterChoice> printer;
  std::optional<Stock> target;
};

Status show_file(Console& console, const Options& options, const Setup& setup, const std::string& file,
                 Diagnostics diagnostics) {
  TerminalProgress progress(console);
  auto program = load_program(file, setup.inputs.program, diagnostics, &progress);
  progress.clear();
  if (interrupted()) return report_stopped(console);
  if (!program) {
    console.show(diagnostics);
    if (console.json())
      print_object(console, Record{{"source", file}, {"diagnostics", record_of(diagnostics)}});
    return Status::input_errors;
  }
  const Job job = make_job_or_print(std::move(*program), setup.inputs.job, UnknownTool::warning, diagnostics);
  const Machine* machine = setup.inputs.program.machine ? &*setup.inputs.program.machine : nullptr;
  const JobTimes times = times_of(job, machine);
  if (job.z_downwards)
    diagnostics
        .warning(job.z_downwards->code, job.program.path.origin_of(job.z_downwards->step),
                 job.z_downwards->message)
        .hint = job.z_downwards->hint;
  console.set_lengths(LengthText(units_of_text(options.job, job.program)));
  console.show(diagnostics);
  if (job.kind == JobKind::print) {
    const bool has_target = setup.target && setup.target->body;
    print_info_of_print(console, job, times,
                        {options.density, setup.printer ? &*setup.printer : nullptr,
                         has_target ? setup.target->body->volume() : Volume()},
                        diagnostics);
  } else if (console.json()) {
    print_object(console, info_record(job, times, diagnostics));
  } else if (job.program.path.size() > 0 || !diagnostics.has_errors()) {  // else the errors say it all
    print_info(console, job, times);
  }
  return diagnostics.has_errors() ? Status::input_errors : Status::done;
}

Status run(Console& console, const Options& options) {
  Diagnostics usage, diagnostics;
  TerminalProgress progress(console);
  Setup setup{read_job_options(options.job, usage, diagnostics, &progress), {}, {}};
  setup.inputs.program.unknown_diameter = UnknownDiameter::assume;
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  if (!options.printer.empty()) setup.printer = printer_called(options.printer, diagnostics);
  if (!options.target.empty()) setup.target = load_stock(options.target, diagnostics, &progress);
  progress.clear();
  if (interrupted()) return report_stopped(console);
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  console.set_object_lines(options.files.size() > 1);
  Status status = Status::done;
  for (const std::string& file : options.files) {
    if (&file != &options.files.front() && !console.json()) console.summary("");
    status = worse(status, show_file(console, options, setup, file, diagnostics));
    if (status == Status::interrupted) break;
  }
  return status;
}

const char* const kExamples =
    R"(  kerf info part.nc
  kerf info --json part.nc
  kerf info *.nc --json                              one line for each file
  kerf info part.nc --machine grbl_settings.txt      times of a GRBL with these $$ settings
  kerf info part.nc --machine grbl_router
  kerf info print.gcode --density 1.27               a print of PETG: filament, mass, layers, time
)";

}  // namespace

Command add_info(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser = new_command(
      root, "info",
      "Print the size, time, tools, feeds and stock of a program, or the filament and layers of a print",
      kExamples + std::string(kToolHelp) + kStockHelp, options->output);
  add_job_options(parser, options->job, options->files);
  add_unit_options(parser, options->job);
  add_machine_option(parser, options->job);
  add_number(parser, "--density", options->density, 0.1, 25.0, "G/CM3",
             "Density of a print's filament (default: from comments, else 1.24, that of PLA)");
  add_printer_option(parser, options->printer);
  parser
      .add_text("--target", options->target,
                "The mesh of a printed part (.stl .3mf .glb .obj): its volume beside the extruded one")
      .value_name("MESH");
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app

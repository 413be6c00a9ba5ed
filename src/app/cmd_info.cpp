// kerf info: what a program does, in numbers: size, time, tools, feeds, stock.
#include <algorithm>
#include <fmt/format.h>
#include <memory>

#include "app/command.h"
#include "app/job.h"
#include "app/json.h"
#include "app/machine.h"
#include "app/terminal_progress.h"

#include "kerf/number.h"

namespace kerf::app {
namespace {

constexpr const char* kTimeMethod = "programmed feeds and rapid rates, without acceleration";

struct Options {
  OutputOptions output;
  JobOptions job;
  std::string machine;
};

double motion_seconds(const MotionFigures& f) { return (f.cutting + f.rapid).seconds(); }
double total_seconds(const MotionFigures& f) { return (f.cutting + f.rapid + f.dwell).seconds(); }

/// Flute shorter than the deepest cut below the stock's top: something to look at.
bool deeper_than_flute(const Job& job, const ToolFigures& t, const Tool* tool) {
  if (tool == nullptr || !t.deepest || !job.stock) return false;
  return job.stock->block.high.z - *t.deepest > tool->flute.mm();
}

// ---- JSON

Json motion_json(const MotionFigures& f) {
  return {{"lines", f.lines},
          {"arcs", f.arcs},
          {"rapids", f.rapids},
          {"cut_mm", json_of(f.cut_mm)},
          {"rapid_mm", json_of(f.rapid_mm)},
          {"cut_bounds_mm", json_of(f.cut_bounds)}};
}

Json time_json(const PathReport& report) {
  Json out{
      {"total", json_of(total_seconds(report.all))},      {"motion", json_of(motion_seconds(report.all))},
      {"cutting", json_of(report.all.cutting.seconds())}, {"rapid", json_of(report.all.rapid.seconds())},
      {"dwell", json_of(report.all.dwell.seconds())},     {"method", kTimeMethod}};
  Json& tools = out["tools"] = Json::array();
  for (const ToolFigures& t : report.tools)
    tools.push_back(Json{{"number", t.tool ? Json(*t.tool) : Json(nullptr)},
                         {"total", json_of(total_seconds(t.figures))},
                         {"motion", json_of(motion_seconds(t.figures))},
                         {"dwell", json_of(t.figures.dwell.seconds())}});
  return out;
}

Json tool_json(const Job& job, const ToolFigures& t) {
  const Tool* tool = t.tool ? job.tools.find(*t.tool) : nullptr;
  Json out;
  out["number"] = t.tool ? Json(*t.tool) : Json(nullptr);
  out["name"] = tool != nullptr ? Json(short_name(*tool)) : Json(nullptr);
  out["known"] = tool != nullptr;
  out["source"] = t.tool ? to_string(job.tool_sources.at(*t.tool)) : to_string(ToolSource::unknown);
  out["deepest_mm"] = t.deepest ? json_of(*t.deepest) : Json(nullptr);
  out["flute_mm"] = tool != nullptr ? json_of(tool->flute.mm()) : Json(nullptr);
  out["deeper_than_flute"] = deeper_than_flute(job, t, tool);
  if (tool != nullptr) {
    out["shape"] = name_of(tool->shape);
    out["diameter_mm"] = json_of(tool->diameter.mm());
  }
  out["motion"] = motion_json(t.figures);
  out["feeds"] = json_of(t.figures.feed);
  out["speeds"] = json_of(t.figures.speed);
  return out;
}

Json info_json(const Job& job, const Diagnostics& diagnostics) {
  const PathReport& report = job.report;
  Json out;
  out["source"] = job.program.source;
  out["front_end"] = job.program.front_end;
  out["units"] = job.program.units == InputUnits::inch ? "inch" : "mm";
  out["steps"] = job.program.path.size();
  if (job.program.end != ProgramEnd::not_asked) out["ended"] = job.program.end == ProgramEnd::seen;
  out["motion"] = motion_json(report.all);
  out["time_s"] = time_json(report);
  Json& tools = out["tools"] = Json::array();
  for (const ToolFigures& t : report.tools) tools.push_back(tool_json(job, t));
  out["feeds"] = json_of(report.all.feed);
  out["speeds"] = json_of(report.all.speed);
  out["stock"] = nullptr;
  if (job.stock)
    out["stock"] = Json{{"block_mm", json_of(job.stock->block)},
                        {"size_mm", json_of(job.stock->block.size())},
                        {"source", to_string(job.stock_source)}};
  out["diagnostics"] = json_of(diagnostics);
  return out;
}

// ---- text

std::string range_text(const Range& range, std::string_view unit) {
  if (range.empty()) return "none told";
  if (range.low == range.high) return fmt::format("{} {}", number_text(range.low, 2), unit);
  return fmt::format("{} to {} {}", number_text(range.low, 2), number_text(range.high, 2), unit);
}

std::string box_text(const Box3& box) {
  const Point3 size = box.size();
  return fmt::format("X {} to {}, Y {} to {}, Z {} to {}  ({} x {} x {} mm)", number_text(box.low.x, 3),
                     number_text(box.high.x, 3), number_text(box.low.y, 3), number_text(box.high.y, 3),
                     number_text(box.low.z, 3), number_text(box.high.z, 3), number_text(size.x, 3),
                     number_text(size.y, 3), number_text(size.z, 3));
}

void print_tools(Console& console, const Job& job) {
  if (job.report.tools.empty()) return;
  console.print("\nTools\n");
  for (const ToolFigures& t : job.report.tools) {
    const Tool* tool = t.tool ? job.tools.find(*t.tool) : nullptr;
    std::string line = t.tool ? fmt::format("  T{:<6}", *t.tool) : std::string("  none   ");
    line += fmt::format("{:<28}", tool != nullptr ? short_name(*tool)
                                  : t.tool        ? "unknown shape"
                                                  : "before any change");
    line += fmt::format(" cuts {} mm in {}", number_text(t.figures.cut_mm, 1),
                        clock_text(total_seconds(t.figures)));
    if (t.deepest) line += fmt::format(", deepest Z {}", number_text(*t.deepest, 3));
    if (tool != nullptr) line += fmt::format(", flute {} mm", number_text(tool->flute.mm(), 3));
    if (deeper_than_flute(job, t, tool)) line += "  <- deeper than its flute";
    if (tool != nullptr) line += fmt::format("  ({})", to_string(job.tool_sources.at(*t.tool)));
    console.print(line + "\n");
  }
}

void print_info(Console& console, const Job& job) {
  const MotionFigures& all = job.report.all;
  console.print(fmt::format("{}: {}, {}, {} steps\n\n", job.program.source, job.program.front_end,
                            job.program.units == InputUnits::inch ? "inches" : "mm",
                            job.program.path.size()));
  console.print(fmt::format("Moves     {} lines, {} arcs, {} rapids\n", all.lines, all.arcs, all.rapids));
  console.print(fmt::format("Length    {} mm cut, {} mm rapid\n", number_text(all.cut_mm, 1),
                            number_text(all.rapid_mm, 1)));
  if (!all.cut_bounds.empty()) console.print(fmt::format("Cuts      {}\n", box_text(all.cut_bounds)));
  if (job.stock)
    console.print(fmt::format("Stock     {}, {}\n", box_text(job.stock->block), to_string(job.stock_source)));
  console.print(fmt::format("Feeds     {}\n", range_text(all.feed, "mm/min")));
  console.print(fmt::format("Spindle   {}\n", range_text(all.speed, "rpm")));
  console.print(fmt::format("Time      about {}: {} cutting, {} rapid, {} waiting ({})\n",
                            clock_text(total_seconds(all)), clock_text(all.cutting.seconds()),
                            clock_text(all.rapid.seconds()), clock_text(all.dwell.seconds()), kTimeMethod));
  print_tools(console, job);
  if (job.program.end == ProgramEnd::missing) console.print("\nThe program has no M2, M30 or closing %.\n");
}

Status run(Console& console, const Options& options) {
  Diagnostics usage, diagnostics;
  const JobSettings settings = read_job_options(options.job, usage, diagnostics);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  ReportOptions report;
  if (!options.machine.empty()) {
    const auto machine = read_machine(options.machine, diagnostics);
    if (machine) report.axis_rates = machine->rapid;
  }
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  TerminalProgress progress(console);
  auto program = load_program(options.job.file, diagnostics, &progress);
  progress.clear();
  if (interrupted()) return tell_stopped(console);
  if (!program) return fail(console, diagnostics, Status::input_errors);
  const Job job = make_job(std::move(*program), settings, report, UnknownTool::warning, diagnostics);
  console.show(diagnostics);
  if (console.json()) {
    console.print_json(text_of(info_json(job, diagnostics), Layout::indented));
  } else {
    print_info(console, job);
  }
  return diagnostics.has_errors() ? Status::input_errors : Status::done;
}

const char* const kExamples =
    R"(  kerf info part.nc
  kerf info --json part.nc
  kerf info part.nc --machine grbl_settings.txt      rapid rates from what GRBL answers to $$
)";

}  // namespace

Command add_info(CLI::App& root) {
  auto options = std::make_shared<Options>();
  CLI::App* app = new_command(root, "info", "Tell a program's size, time, tools, feeds and stock",
                              kExamples + std::string(kJobHelp), options->output);
  add_job_options(*app, options->job);
  app->add_option("--machine", options->machine, "GRBL's $$ settings; its rapid rates are used for the time")
      ->type_name("PATH");
  return {app, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app

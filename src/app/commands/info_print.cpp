// kerf info of a print: filament, layers, size and time.
#include "app/commands/info_print.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <utility>

#include "app/report/status.h"
#include "app/report/terminal_progress.h"
#include "base/clock_text.h"
#include "base/number.h"
#include "job/filament.h"
#include "job/planned_print.h"
#include "job/record/figures.h"
#include "job/record/info.h"

#include "kerf/sim/print.h"

namespace kerf::app {
namespace {

TimeOfPrint time_of(const PlannedPrint& plan, const JobTimes& times) {
  const TimeFigures& all = times.estimate.all;
  if (times.planned()) return {all.motion, all.dwell, kPlannedMethod, times.machine};
  return {plan.motion, plan.dwell, std::string(plan.method), plan.printer};
}

/// The volume of the beads of the part itself: skirts, supports and purges are not part of it.
double part_volume(const Toolpath& path) {
  double volume = 0.0;
  Point3 from;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!path[i].is_motion()) continue;
    const bool moves = distance(std::exchange(from, path[i].to()).xy(), path[i].to().xy()) > 0.0;
    if (path[i].kind() != StepKind::extrude || !moves) continue;
    const step::Extrude bead = path.extrude(i);
    const bool beside = bead.kind == BeadKind::skirt || bead.kind == BeadKind::support ||
                        bead.kind == BeadKind::support_interface || bead.kind == BeadKind::purge ||
                        bead.kind == BeadKind::custom;
    if (!beside) volume += std::max(bead.volume.mm3(), 0.0);
  }
  return volume;
}

/// The filament that each extruder pushes out, mm3; empty for a program that names none.
std::map<int, double> volumes_of_extruders(const Toolpath& path) {
  std::map<int, double> volumes, drawn_back;
  if (!path.has(StepKind::extruder)) return volumes;
  int extruder = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i].kind() == StepKind::extruder) extruder = path[i].extruder().number;
    if (path[i].kind() != StepKind::extrude) continue;
    const double volume = path.extrude(i).volume.mm3();
    double& back = drawn_back[extruder];
    const double returned = std::min(back, volume);
    back -= returned;
    volumes[extruder] += std::max(volume - returned, 0.0);
  }
  return volumes;
}

Record extruders_record(const Toolpath& path, const Filament& filament) {
  Record list = Record::array();
  for (const auto& [extruder, volume] : volumes_of_extruders(path))
    list.push_back(Record{{"extruder", extruder},
                          {"filament_mm3", record_of(volume)},
                          {"filament_mm", record_of(volume * filament.length / filament.volume)}});
  return list;
}

void print_extruders(Console& console, const Toolpath& path) {
  for (const auto& [extruder, volume] : volumes_of_extruders(path))
    console.print(fmt::format("          extruder {}: {}\n", extruder, console.lengths().volume(volume, 1)));
}

std::string heights_text(const Range& heights, const LengthText& lengths) {
  if (heights.empty()) return "";
  if (heights.high - heights.low < 1e-6) return fmt::format(", {} high", lengths.with_unit(heights.low, 3));
  return fmt::format(", {} to {} high", lengths.of(heights.low, 3), lengths.with_unit(heights.high, 3));
}

void print_text(Console& console, const Job& job, const TimeOfPrint& time, const PlannedPrint& flow,
                const PrintFigures& figures, const Filament& filament) {
  const LengthText& lengths = console.lengths();
  console.print(fmt::format("{}: {}, {} steps, a print\n\n", job.program.source, job.program.front_end,
                            job.program.path.size()));
  if (!figures.box.empty())
    console.print(fmt::format("Size      {}, from X{} Y{} Z{}\n", lengths.size(figures.box.size()),
                              lengths.of(figures.box.low.x, 3), lengths.of(figures.box.low.y, 3),
                              lengths.of(figures.box.low.z, 3)));
  console.print(
      fmt::format("Layers    {}{}\n", figures.layers.size(), heights_text(heights_of(figures), lengths)));
  console.print(fmt::format("Filament  {} of {}, {}\n", lengths.with_unit(filament.length, 1),
                            lengths.with_unit(filament.diameter, 3), lengths.volume(filament.volume, 1)));
  print_extruders(console, job.program.path);
  console.print(fmt::format(
      "Mass      {} g at {} g/cm3{}\n", number_text(filament.grams(), 2), number_text(filament.density, 3),
      filament.density_assumed ? ", assuming PLA; specify another with --density" : ""));
  console.print(
      fmt::format("Beads     {}, {} long\n", figures.beads, lengths.with_unit(figures.bead_length.mm(), 1)));
  const double highest = in_mm3_per_s(flow.highest), limit = in_mm3_per_s(flow.limit);
  console.print(fmt::format("Flow      up to {} mm3/s{}\n", number_text(highest, 2),
                            limit > 0.0 ? fmt::format("; the hot end melts {}{}", number_text(limit, 2),
                                                      highest > limit ? ": too fast" : "")
                                        : std::string()));
  console.print(fmt::format("Time      about {}, without heating: {} motion, {} dwell\n",
                            clock_text((time.motion + time.dwell).seconds()),
                            clock_text(time.motion.seconds()), clock_text(time.dwell.seconds())));
  console.print(time.machine.empty() ? fmt::format("          {}; --printer has other limits\n", time.method)
                                     : fmt::format("          on {}, {}\n", time.machine, time.method));
}

}  // namespace

void print_info_of_print(Console& console, const Job& job, const JobTimes& times,
                         const PrintInfoOptions& options, const Diagnostics& diagnostics) {
  const PrintFigures figures = figures_of_print(job.program.path, {});
  std::optional<double> density;
  if (options.density > 0.0)
    density = options.density;
  else if (!job.program.filament_density && options.printer != nullptr &&
           options.printer->filament.density > 0.0)
    density = options.printer->filament.density;
  const Filament filament = filament_of(job.program, figures.extruded, density);
  const PlannedPrint flow = planned_print(job.program.path, options.printer, mm(filament.diameter));
  const TimeOfPrint time = time_of(flow, times);
  const double part = part_volume(job.program.path), target = options.target.mm3();
  if (!console.json()) {
    print_text(console, job, time, flow, figures, filament);
    if (target > 0.0)
      console.print(fmt::format("Target    {}; the beads of the part have {}: {}%\n",
                                console.lengths().volume(target, 1), console.lengths().volume(part, 1),
                                number_text(100.0 * part / target, 1)));
    return;
  }
  Record out;
  out["source"] = job.program.source;
  out["front_end"] = job.program.front_end;
  out["kind"] = "print";
  out["units"] = job.program.units == ProgramUnits::inch ? "inch" : "mm";
  out["steps"] = job.program.path.size();
  out["print"] = record_of(figures, filament);
  if (job.program.path.has(StepKind::extruder))
    out["print"]["extruders"] = extruders_record(job.program.path, filament);
  if (target > 0.0)
    out["target"] = Record{{"target_mm3", record_of(target)},
                           {"part_mm3", record_of(part)},
                           {"fraction", record_of(part / target)}};
  out["flow_mm3_s"] = record_of_flow(flow);
  out["time_s"] = record_of(time);
  out["feeds"] = record_of(job.report.all.feed);
  out["diagnostics"] = record_of(diagnostics);
  print_object(console, out);
}

}  // namespace kerf::app

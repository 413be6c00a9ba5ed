// The findings of a print, and which of its hazards are none.
#include "job/print_findings.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <utility>

#include "base/number.h"

#include "kerf/formats/printer_files.h"
#include "kerf/sim/print.h"

namespace kerf {
namespace {

constexpr double kMinBlob = 0.5;       // mm3: a drop of 1 mm
constexpr double kMinAirWidths = 6.0;  // of the bead; the beads beside hold a shorter piece in the air
constexpr double kMinContact = 0.25;   // of the layer's height; less is rounding, or the melt gives way
constexpr double kMaxOverlap = 0.35;   // fraction of the filament of a layer laid where there is material
constexpr double kMinOverlap = 2.0;    // mm3 in a layer; in small ones ends and corners are most of it

/// Filament that runs out before the print, or beside it: the nozzle is primed there.
bool is_purge(const PrintHazard& hazard, const PrintFigures& figures) {
  const Box3& box = figures.box;
  const bool beside = hazard.at.x < box.low.x || hazard.at.x > box.high.x || hazard.at.y < box.low.y ||
                      hazard.at.y > box.high.y;
  return beside || !figures.first_bead || hazard.step < *figures.first_bead;
}

/// The height of half of the layers or more.
Length usual_height(std::vector<PrintLayer> layers) {
  if (layers.empty()) return {};
  const auto median = layers.begin() + static_cast<std::ptrdiff_t>(layers.size() / 2);
  std::nth_element(layers.begin(), median, layers.end(),
                   [](const PrintLayer& a, const PrintLayer& b) { return a.height < b.height; });
  return median->height;
}

/// Supports hang where slicers want them to; they are not the part.
bool is_support(const PrintHazard& hazard, const Toolpath& path) {
  if (path[hazard.step].kind() != StepKind::extrude) return false;
  const BeadKind kind = path.extrude(hazard.step).kind;
  return kind == BeadKind::support || kind == BeadKind::support_interface;
}

/// `layer`: the usual height of a layer.
bool is_failure(const PrintHazard& hazard, const PrintFigures& figures, const Toolpath& path, Length layer) {
  switch (hazard.kind) {
    case PrintHazardKind::nozzle_contact: return hazard.depth >= kMinContact * layer;
    case PrintHazardKind::in_air:
      return hazard.length >= kMinAirWidths * hazard.width && !is_support(hazard, path);
    case PrintHazardKind::unsupported: return false;  // bridges and overhangs, as slicers make them
    case PrintHazardKind::wide_bead:
    case PrintHazardKind::blob: break;
  }
  return hazard.volume.mm3() >= kMinBlob && !is_purge(hazard, figures);
}

bool is_overfull(const PrintLayer& layer) {
  const PrintVolumes& v = layer.volumes;
  return v.overlap.mm3() >= kMinOverlap && v.overlap > kMaxOverlap * v.extruded;
}

/// The first bead with this nozzle height.
std::size_t first_step_at(Length z, const Toolpath& path) {
  constexpr double kSameHeight = 0.02;  // mm; layers are further apart
  Point3 from;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!path[i].is_motion()) continue;
    const Point3 to = path[i].to();
    const bool moves = distance(std::exchange(from, to).xy(), to.xy()) > 0.0;
    if (path[i].kind() == StepKind::extrude && moves && std::abs(to.z - z.mm()) < kSameHeight &&
        path.extrude(i).volume > Volume())
      return i;
  }
  return 0;
}

/// One finding for each run of layers that are fuller than full.
std::vector<Finding> overfull_layers(const std::vector<PrintLayer>& layers, const Toolpath& path) {
  std::vector<Finding> list;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (!is_overfull(layers[i])) continue;
    const std::size_t first = i;
    PrintVolumes sum;
    for (; i < layers.size() && is_overfull(layers[i]); ++i) {
      sum.overlap = sum.overlap + layers[i].volumes.overlap;
      sum.extruded = sum.extruded + layers[i].volumes.extruded;
    }
    Finding finding;
    finding.kind = "overfill";
    finding.step = first_step_at(layers[first].z, path);
    finding.at = path[finding.step].to();
    finding.origin = path.origin_of(finding.step);
    finding.callers = path.origins().callers(path[finding.step].origin());
    finding.message = fmt::format(
        "{}% of the filament of {} layers from Z{} to Z{} is laid where there is material already",
        number_text(100.0 * (sum.overlap / sum.extruded), 0), i - first, number_text(layers[first].z.mm(), 3),
        number_text(layers[i - 1].z.mm(), 3));
    finding.hint = "check the flow, the filament diameter (--filament) and the distance of the beads";
    list.push_back(std::move(finding));
  }
  return list;
}

/// The message of a fault, and what to do about it.
std::pair<std::string, std::string> text_of(const PrintFault& fault, const PrinterLimits& limits) {
  const auto number = [](double v) { return number_text(v, 1); };
  switch (fault.kind) {
    case PrintFaultKind::cold_extrusion:
      if (fault.value >= limits.min_celsius)
        return {fmt::format("filament is extruded while the nozzle heats: nothing waits for its {} C",
                            number(fault.value)),
                "wait for the nozzle (M109) before the first bead"};
      return {fmt::format("filament is extruded at {} C; at least {} C are necessary", number(fault.value),
                          number(limits.min_celsius)),
              "wait for the nozzle (M109) before the first bead"};
    case PrintFaultKind::flow_high:
      return {fmt::format("{} mm3/s; the hot end melts {}", number(fault.value),
                          number(in_mm3_per_s(limits.max_flow))),
              "print slower, or with narrower or lower beads"};
    case PrintFaultKind::outside_bed:
      return {fmt::format("the nozzle is {} mm outside of the printer's space", number_text(fault.value, 2)),
              "move the print, or correct bed and height of the printer"};
    case PrintFaultKind::extruded_drawn_back:
      return {fault.value > 0.0
                  ? fmt::format("a bead starts while filament is drawn back; its first {} mm3 are missing",
                                number_text(fault.value, 2))
                  : "a bead is laid while the firmware has drawn the filament back (G10)",
              "push the filament forward (prime) before the bead"};
    case PrintFaultKind::retracted_twice: break;
  }
  return {fmt::format("filament is drawn back where it is drawn back already, {} mm3 in all",
                      number_text(fault.value, 2)),
          "push it forward (prime) before the next retraction"};
}

}  // namespace

std::vector<Finding> printer_findings(const Toolpath& path, const PrinterChoice* printer) {
  const PrinterLimits limits = printer != nullptr ? limits_of(*printer) : PrinterLimits{};
  std::vector<Finding> list;
  for (const PrintFault& fault : check_print(path, limits)) {
    auto [message, hint] = text_of(fault, limits);
    list.push_back({.kind = std::string(to_string(fault.kind)),
                    .step = fault.step,
                    .steps = fault.steps,
                    .at = fault.at,
                    .origin = path.origin_of(fault.step),
                    .message = std::move(message),
                    .callers = path.origins().callers(path[fault.step].origin()),
                    .hint = std::move(hint)});
  }
  return list;
}

std::vector<Finding> findings_in_print(const Job& job, const JobCheckOptions& options,
                                       Diagnostics& diagnostics, Progress* progress) {
  const Toolpath& path = job.program.path;
  PrintOptions how;
  how.resolution = options.resolution;
  how.threads = options.threads;
  how.layer_height = options.layer_height;
  const auto print = simulate_print(path, how, diagnostics, progress);
  if (!print || print->stopped) return {};
  const PrintFigures figures = figures_of_print(path, how);
  const Length layer = usual_height(print->layers);
  std::vector<PrintHazard> failures;
  std::copy_if(print->hazards.begin(), print->hazards.end(), std::back_inserter(failures),
               [&](const PrintHazard& hazard) { return is_failure(hazard, figures, path, layer); });
  return merged(merged(findings_of(failures, path), overfull_layers(print->layers, path)),
                printer_findings(path, options.printer));
}

}  // namespace kerf

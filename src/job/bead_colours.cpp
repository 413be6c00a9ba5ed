// Colours of the beads of a print.
#include "job/bead_colours.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "base/number.h"

#include "kerf/path/check.h"

namespace kerf {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr std::size_t kFirst = 2;  // after the colours of stock and hazards

// From dark blue over green to yellow, with even steps of lightness: order shows without colours, too.
constexpr std::array<Colour, 12> kScale{{{68, 1, 84},
                                         {72, 33, 115},
                                         {67, 62, 133},
                                         {56, 88, 140},
                                         {45, 112, 142},
                                         {37, 133, 142},
                                         {30, 155, 138},
                                         {42, 176, 127},
                                         {82, 197, 105},
                                         {134, 213, 73},
                                         {194, 223, 35},
                                         {253, 231, 37}}};
// By BeadKind.
constexpr std::array<Colour, kBeadKinds> kKinds{{{150, 150, 150},
                                                 {110, 130, 150},
                                                 {232, 120, 40},
                                                 {240, 200, 80},
                                                 {40, 60, 170},
                                                 {200, 170, 120},
                                                 {150, 80, 190},
                                                 {120, 200, 235},
                                                 {60, 110, 180},
                                                 {245, 245, 245},
                                                 {240, 150, 130},
                                                 {90, 180, 90},
                                                 {40, 120, 60},
                                                 {100, 80, 60},
                                                 {70, 190, 190}}};

/// Calls visit(step, value) for every bead.
template <class Visit>
void for_each_bead(const Toolpath& path, BeadColours by, Visit&& visit) {
  double celsius = std::numeric_limits<double>::quiet_NaN();
  PathPosition here;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& s = path[i];
    if (s.kind() == StepKind::temperature && s.temperature().heater == Heater::nozzle)
      celsius = s.temperature().celsius;
    if (s.kind() == StepKind::extrude && path.extrude(i).volume > Volume()) {
      switch (by) {
        case BeadColours::speed: visit(i, s.feed().mm_per_min()); break;
        case BeadColours::flow: visit(i, in_mm3_per_s(flow_of(path, i, here.at))); break;
        case BeadColours::temperature: visit(i, celsius); break;
        default: visit(i, s.to().z); break;
      }
    }
    here.pass(s);
  }
}

std::string_view unit_of(BeadColours by) {
  switch (by) {
    case BeadColours::speed: return "mm/min";
    case BeadColours::flow: return "mm3/s";
    case BeadColours::temperature: return "C";
    default: return "mm";
  }
}

void colour_kinds(const Toolpath& path, StepColours& out) {
  out.palette.insert(out.palette.end(), kKinds.begin(), kKinds.end());
  for (std::size_t kind = 0; kind < kBeadKinds; ++kind) {
    const std::string_view name = to_string(static_cast<BeadKind>(kind));
    out.names.emplace_back(name.empty() ? "other" : name);
  }
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].kind() == StepKind::extrude)
      out.of_step[i] = static_cast<std::uint8_t>(kFirst + static_cast<std::size_t>(path.extrude(i).kind));
}

void colour_ranges(const Toolpath& path, BeadColours by, StepColours& out) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for_each_bead(path, by, [&](std::size_t, double v) {
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  });
  out.palette.insert(out.palette.end(), kScale.begin(), kScale.end());
  const double span = high > low ? high - low : 0.0;
  const auto count = static_cast<double>(kScale.size());
  for (std::size_t k = 0; k < kScale.size(); ++k) {
    const auto at = [&](std::size_t n) {
      return number_text(low + span * static_cast<double>(n) / count, 2);
    };
    out.names.push_back(std::isfinite(low) ? fmt::format("{} to {} {}", at(k), at(k + 1), unit_of(by))
                                           : std::string("unknown"));
  }
  for_each_bead(path, by, [&](std::size_t i, double v) {
    const double position = span > 0.0 && std::isfinite(v) ? count * (v - low) / span : 0.0;
    out.of_step[i] =
        static_cast<std::uint8_t>(kFirst + static_cast<std::size_t>(std::min(position, count - 1.0)));
  });
}

}  // namespace

StepColours colour_beads(const Toolpath& path, BeadColours by) {
  StepColours out;
  out.names = {"stock", "hazard"};
  out.palette.assign(part_palette().begin(), part_palette().begin() + kFirst);
  out.of_step.assign(path.size(), kFirst);
  if (by == BeadColours::kind)
    colour_kinds(path, out);
  else
    colour_ranges(path, by, out);
  return out;
}

}  // namespace kerf

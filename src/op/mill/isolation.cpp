// Isolation of the copper of circuit boards: a contour around it, or a pocket as wide as several passes.
#include <cmath>
#include <fmt/format.h>

#include "op/base/cutter.h"
#include "op/base/option_check.h"
#include "op/base/reach.h"

#include "kerf/base/limits.h"
#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr double kMaxPasses = 1000;

bool valid(const IsolationOptions& options, const Tool& tool, Diagnostics& diagnostics) {
  if (!op_detail::valid(options.cut, tool, diagnostics)) return false;
  OptionCheck check(options.cut, diagnostics);
  check.expect(options.passes >= 1 && options.passes <= kMaxPasses, "number of passes", options.passes,
               "from 1 to 1000");
  check.expect(options.overlap >= 0.0 && options.overlap <= 0.95, "overlap", options.overlap,
               "from 0 to 0.95");
  const double width = options.width.mm(), diameter = 2.0 * cutting_radius(tool, options.cut.depth).mm();
  check.expect(
      width == 0.0 || (width >= diameter - options.cut.tolerance.chord.mm() && width <= limits::kMaxToolSize),
      "width of the isolation", width, fmt::format("{:.4g} mm, as the tool is, or more", diameter));
  return check.valid();
}

/// What is cut around copper: `width` wide, and what remains there that is narrower than the tool.
std::optional<Region> band(const Region& copper, double width, double radius, const CutOptions& cut,
                           Diagnostics& diagnostics) {
  const RegionOptions regions = region_options(cut);
  const auto far = offset(copper, mm(width + radius), regions, diagnostics);
  const auto near = far ? offset(far->region, mm(-radius), regions, diagnostics) : std::nullopt;
  auto made = near ? combine(near->region, copper, Boolean::subtract, regions, diagnostics) : std::nullopt;
  if (!made) return std::nullopt;
  return std::move(made->region);
}

/// Rings go inwards from both sides of the band. Where a whole number of steps (`steps` of each side) leads
/// to its centre line, the ring there would have no area and be left out, so that two rings are two steps
/// apart, with nothing of the overlap that is asked for. Slightly smaller steps keep it.
double ring_factor(double steps) {
  constexpr double kNearCentre = 0.02, kSmaller = 0.95;
  return steps > 0.5 && std::abs(steps - std::round(steps)) < kNearCentre ? kSmaller : 1.0;
}

}  // namespace

std::optional<Operation> isolation(const Region& copper, const Tool& tool, const IsolationOptions& options,
                                   Diagnostics& diagnostics) {
  if (!valid(options, tool, diagnostics)) return std::nullopt;
  CutOptions cut = options.cut;
  cut.allowance = Length{};
  if (!usable(copper, cut, diagnostics)) return std::nullopt;
  const double radius = cutting_radius(tool, cut.depth).mm();
  const double step = 2.0 * radius * (1.0 - options.overlap);
  const double by_passes = 2.0 * radius + (options.passes - 1) * step;
  const double width = options.width > Length{} ? options.width.mm() : by_passes;
  if (width <= 2.0 * radius + cut.tolerance.chord.mm()) {
    ContourOptions around{cut, ContourSide::outside};
    around.cut.entry.kind = cut.entry.kind == EntryKind::helix ? EntryKind::ramp : cut.entry.kind;
    return contour(copper, tool, around, diagnostics);
  }
  const auto area = band(copper, width, radius, cut, diagnostics);
  if (!area) return std::nullopt;
  PocketOptions inside{cut};
  inside.stepover = (1.0 - options.overlap) * ring_factor((width - 2.0 * radius) / (2.0 * step));
  return pocket(*area, tool, inside, diagnostics);
}

}  // namespace kerf

// Prints of regions lay their region: little overlap, and no space but that between round sides of beads.
#include "kerf/op/printer.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

#include "kerf/sim/print.h"

namespace kerf {
namespace {

constexpr double kMaxOverlap = 0.02;  // of the volume extruded
constexpr double kMaxMissing = 0.02;  // of the volume of the region, beyond the gaps between round sides

Outline polygon(const std::vector<Point2>& points) {
  Outline path{points.front(), {}};
  for (std::size_t i = 1; i <= points.size(); ++i) path.segments.push_back({points[i % points.size()], {}});
  return path;
}

struct Part {
  const char* name;
  Region region;
};

std::vector<Part> parts() {
  const Region square{{polygon({{0, 0}, {20, 0}, {20, 20}, {0, 20}})}};
  const Region angle{{polygon({{0, 0}, {25, 0}, {25, 12}, {12, 12}, {12, 25}, {0, 25}})}};
  const Region disc{{as_outline({{10, 10}, mm(12)})}};
  Region ring = disc;
  ring.loops.push_back(reversed(as_outline({{10, 10}, mm(5)})));
  const Region tilted = rotated(square, {3, 4}, degrees(27));
  return {{"square", square}, {"angle", angle}, {"disc", disc}, {"ring", ring}, {"tilted", tilted}};
}

/// The volume between parallel beads, as a fraction of what they fill: the section of a bead is a rectangle
/// with half circles; neighbours share the lens of two circles of diameter `h`.
double gaps(double width, double h, double apart) {
  const double pi = std::numbers::pi, d = apart - (width - h), r = 0.5 * h;
  const double lens = d < h ? 2 * r * r * std::acos(d / h) - 0.5 * d * std::sqrt(h * h - d * d) : 0.0;
  return 1.0 - ((width - h) * h + pi * r * r - lens) / (apart * h);
}

void expect_filled(const Part& part, const PrinterSettings& settings, int walls, const FillOptions& fill) {
  SCOPED_TRACE(std::string(part.name) + " width " + std::to_string(settings.width.mm()) + " height " +
               std::to_string(settings.height.mm()) + " walls " + std::to_string(walls));
  constexpr int kLayers = 5;
  Diagnostics diagnostics;
  Printer printer(settings, diagnostics);
  for (int i = 0; i < kLayers; ++i) {
    ASSERT_TRUE(printer.next_layer());
    const auto inside = printer.walls(part.region, walls);
    ASSERT_TRUE(inside);
    FillOptions here = fill;
    here.angle = radians(fill.angle.rad() + (i % 2 == 0 ? 0.0 : 0.5 * std::numbers::pi));
    const auto left = printer.fill(*inside, here);
    ASSERT_TRUE(left);
    EXPECT_LE(area(*left), 0.01 * area(part.region));
  }
  const Toolpath path = printer.take();
  const auto print = simulate_print(path, {.resolution = mm(0.05)}, diagnostics);
  for (const Diagnostic& d : diagnostics.list()) ADD_FAILURE() << to_string(d);
  ASSERT_TRUE(print);
  EXPECT_NEAR(print->total.extruded.mm3(), printer.printed().mm3(), 1e-6 * printer.printed().mm3());
  EXPECT_LE(print->total.overlap.mm3(), kMaxOverlap * print->total.extruded.mm3());
  const double whole = area(part.region) * kLayers * settings.height.mm();
  const double between = gaps(settings.width.mm(), settings.height.mm(),
                              settings.width.mm() - settings.side_overlap * settings.height.mm());
  EXPECT_GE(print->total.laid.mm3(), (1.0 - between - kMaxMissing) * whole);
  EXPECT_LE(print->total.laid.mm3() - print->total.ends.mm3(), whole * (1.0 - between + kMaxMissing));
  // Where a round boundary is almost parallel to the rows, rows end beside it, and one that crosses their
  // ends in the next layer is unsupported for a little longer than its width.
  for (const PrintHazard& hazard : print->hazards)
    if (hazard.kind != PrintHazardKind::unsupported || hazard.length > 2.0 * settings.width)
      ADD_FAILURE() << to_string(hazard.kind) << " at step " << hazard.step;
}

TEST(PrinterProperty, solid_parts_are_filled_by_rows) {
  for (const Part& part : parts())
    for (const auto& [width, height] : {std::pair{0.45, 0.2}, {1.2, 0.4}, {0.4, 0.25}})
      for (const int walls : {0, 1, 2}) {
        if (walls == 0 && width > 1.0) continue;
        expect_filled(part, {.width = mm(width), .height = mm(height)}, walls, {.angle = degrees(30)});
      }
}

TEST(PrinterProperty, solid_parts_are_filled_by_rings) {
  for (const Part& part : parts())
    if (std::string(part.name) != "angle")  // parts of different width leave space, which is reported
      expect_filled(part, {}, 1, {.pattern = FillPattern::concentric});
}

TEST(PrinterProperty, a_vase_is_a_wall_without_gaps) {
  Diagnostics diagnostics;
  Printer printer({}, diagnostics);
  const Outline round = as_outline({{20, 20}, mm(15)});
  ASSERT_TRUE(printer.next_layer());
  ASSERT_TRUE(printer.bead(round, {.kind = BeadKind::outer_wall}));
  ASSERT_TRUE(printer.vase(round, 4.2));
  const auto print = simulate_print(printer.path(), {.resolution = mm(0.05)}, diagnostics);
  ASSERT_TRUE(print);
  EXPECT_LE(print->total.overlap.mm3(), kMaxOverlap * print->total.extruded.mm3());
  EXPECT_NEAR(print->total.laid.mm3(), print->total.extruded.mm3(), 0.02 * print->total.extruded.mm3());
  EXPECT_TRUE(print->hazards.empty());
}

}  // namespace
}  // namespace kerf

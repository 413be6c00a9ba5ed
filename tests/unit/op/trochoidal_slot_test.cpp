// Trochoidal slots: the engagement measured in a picture of the material, what is cut and what stays.
#include <gtest/gtest.h>

#include "base/codes/op.h"
#include "engagement_meter.h"
#include "swept.h"

#include "kerf/geom/offset.h"
#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace test;

constexpr double kPictureError = 3.0;  // degrees, of the measured angle

TrochoidalSlotOptions slot_of(double width, double engagement) {
  TrochoidalSlotOptions options;
  options.cut.depth = mm(2), options.cut.feed = mm_per_min(900), options.cut.plunge = mm_per_min(300);
  options.width = mm(width), options.engagement = degrees(engagement);
  return options;
}

Outline line(const std::vector<Point2>& points) {
  Outline outline{points.front(), {}};
  for (std::size_t i = 1; i < points.size(); ++i) outline.segments.push_back({points[i], {}});
  return outline;
}

/// The distance of a point from a slot, below 0 inside.
double beside(const std::vector<Point2>& points, Point2 p, double half) {
  double nearest = INFINITY;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Point2 way = points[i] - points[i - 1];
    const double t = std::clamp(dot(p - points[i - 1], way) / dot(way, way), 0.0, 1.0);
    nearest = std::min(nearest, distance(p, points[i - 1] + t * way));
  }
  return nearest - half;
}

TEST(TrochoidalSlot, IsAsWideAsRequestedAndKeepsTheLimit) {
  // Straight, with corners, and one that intersects itself; distances to the lines are the expectation.
  const std::vector<std::vector<Point2>> paths{
      {{0, 0}, {30, 0}}, {{0, 0}, {25, 0}, {30, 18}}, {{0, 0}, {24, 0}, {24, 16}, {12, 16}, {12, -12}}};
  for (const auto& points : paths)
    for (const double width : {4.8, 7.0}) {
      const TrochoidalSlotOptions options = slot_of(width, 60);
      Diagnostics diagnostics;
      const auto made = trochoidal_slot({line(points)}, mill(4), options, diagnostics);
      ASSERT_TRUE(made);
      EXPECT_TRUE(diagnostics.list().empty());
      const std::vector<Motion> path = motions(made->path);
      Diagnostics unused;
      const auto region = buffer(line(points), mm(0.5 * width), PathEnds::round, {}, unused);
      ASSERT_TRUE(region);
      const Box2 box = bounds(*region).grown(1.0);
      for (double x = box.low.x; x < box.high.x; x += 0.37)
        for (double y = box.low.y; y < box.high.y; y += 0.41) {
          const double outside = beside(points, {x, y}, 0.5 * width);
          if (outside > 0.01) {
            EXPECT_FALSE(touched(path, {x, y}, 2.0, -1e-6)) << x << ", " << y;
          }
          // Inner corners have the radius of the tool.
          if (outside < -0.02 - 0.42 * 2.0 || (points.size() == 2 && outside < -0.02)) {
            EXPECT_TRUE(removed_to(path, {x, y}, 2.0, -2.0 + 1e-6)) << x << ", " << y;
          }
        }
      EXPECT_EQ(rapid_problem(made->path, 2, 0), "");
      EngagementMeter meter(*region, 2);
      EXPECT_LE(meter.largest(made->path, -2), 60 + kPictureError) << meter.where.x << ", " << meter.where.y;
    }
}

TEST(TrochoidalSlot, ThatCannotBeCutIsRefused) {
  const auto code = [](const std::vector<Outline>& outlines, double width, double engagement) {
    Diagnostics found;
    EXPECT_FALSE(trochoidal_slot(outlines, mill(4), slot_of(width, engagement), found));
    return found.list().empty() ? Code{} : found.list().front().code;
  };
  const Outline straight = line({{0, 0}, {30, 0}});
  for (const double width : {0.0, -5.0, std::nan(""), double{INFINITY}})
    EXPECT_EQ(code({straight}, width, 60), codes::op_option) << width;
  for (const double angle : {0.0, -60.0, 91.0, std::nan("")})
    EXPECT_EQ(code({straight}, 6, angle), codes::op_option) << angle;
  EXPECT_EQ(code({}, 6, 60), codes::op_empty);
  EXPECT_EQ(code({line({{1, 1}, {1, 1}})}, 6, 60), codes::op_option);
  // As wide as the tool, and narrower.
  EXPECT_EQ(code({straight}, 4, 60), codes::op_tool_wide);
  EXPECT_EQ(code({straight}, 3, 60), codes::op_tool_wide);
  EXPECT_EQ(code({straight}, 4.4, 60), codes::op_tool_wide);
}

}  // namespace
}  // namespace kerf

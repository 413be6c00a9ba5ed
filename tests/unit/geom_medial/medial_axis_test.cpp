// Medial axes of shapes for which they are known.
#include "geom/medial/medial_axis.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "../geom_region/region_samples.h"
#include "base/codes/outline.h"
#include "geom/medial/voronoi.h"

namespace kerf {
namespace {

constexpr double kChord = 1e-3;  // the default tolerance

class MedialAxes : public RegionTest {
 protected:
  MedialAxis axis_of(const Region& region, MedialOptions options = {}) {
    const auto found = medial_axis(region, options, diagnostics);
    EXPECT_TRUE(found.has_value());
    if (!found) return {};
    // Each circle touches the boundary.
    const RegionSearch search(region);
    for (const MedialEdge& edge : found->edges) {
      EXPECT_GE(edge.points.size(), 2u);
      for (const MedialPoint& p : edge.points)
        EXPECT_NEAR(search.clearance(p.at)->mm(), p.radius.mm(), 4.0 * kChord);
    }
    return *found;
  }
  static std::size_t ends(const MedialAxis& axis) {
    std::vector<int> count(axis.nodes.size());
    for (const MedialEdge& edge : axis.edges) {
      ++count[edge.from];
      ++count[edge.to];
    }
    return static_cast<std::size_t>(std::count(count.begin(), count.end(), 1));
  }
  static double length_of(const MedialAxis& axis) {
    double sum = 0.0;
    for (const MedialEdge& edge : axis.edges)
      for (std::size_t i = 1; i < edge.points.size(); ++i)
        sum += distance(edge.points[i - 1].at, edge.points[i].at);
    return sum;
  }
};

TEST_F(MedialAxes, OfARectangleReachItsCorners) {
  const MedialAxis axis = axis_of(made({rectangle(0, 0, 20, 10)}));
  EXPECT_EQ(axis.nodes.size(), 6u);
  EXPECT_EQ(axis.edges.size(), 5u);
  EXPECT_EQ(ends(axis), 4u);
  EXPECT_NEAR(length_of(axis), 10.0 + 4.0 * 5.0 * std::sqrt(2.0), 1e-5);
  double largest = 0.0;
  for (const MedialPoint& node : axis.nodes) largest = std::max(largest, node.radius.mm());
  EXPECT_NEAR(largest, 5.0, 1e-6);
}

TEST_F(MedialAxes, OfATriangleMeetInItsIncentre) {
  const Region triangle = made({{{0, 0}, {{{4, 0}, {}}, {{0, 3}, {}}, {{0, 0}, {}}}}});
  const MedialAxis axis = axis_of(triangle);
  EXPECT_EQ(axis.edges.size(), 3u);
  const auto inner = largest_inscribed_circle(triangle, {}, diagnostics);
  EXPECT_NEAR(inner->radius.mm(), 1.0, 1e-6);
  EXPECT_NEAR(inner->centre.x, 1.0, 1e-6);
  EXPECT_NEAR(inner->centre.y, 1.0, 1e-6);
}

TEST_F(MedialAxes, OfADiscAreItsCentre) {
  const MedialAxis axis = axis_of(made({circle(3, 4, 10)}));
  EXPECT_TRUE(axis.edges.empty());
  ASSERT_EQ(axis.nodes.size(), 1u);
  EXPECT_NEAR(axis.nodes[0].at.x, 3.0, 2.0 * kChord);
  EXPECT_NEAR(axis.nodes[0].radius.mm(), 10.0, 2.0 * kChord);
}

TEST_F(MedialAxes, OfASlotAreALineBetweenTheCentres) {
  const Outline slot{{0, -2},
                     {{{10, -2}, {}}, {{10, 2}, Point2{12, 0}}, {{0, 2}, {}}, {{0, -2}, Point2{-2, 0}}}};
  const MedialAxis axis = axis_of(made({slot}));
  EXPECT_NEAR(length_of(axis), 10.0, 0.2);
  for (const MedialEdge& edge : axis.edges)
    for (const MedialPoint& p : edge.points) {
      EXPECT_NEAR(p.at.y, 0.0, 2.0 * kChord);
      EXPECT_NEAR(p.radius.mm(), 2.0, 2.0 * kChord);
    }
}

/// A point and a line are separated by a parabola: an inner corner and the side opposite.
TEST_F(MedialAxes, OfAnLContainAParabola) {
  const Region corner = made(
      {{{0, 0}, {{{10, 0}, {}}, {{10, 4}, {}}, {{4, 4}, {}}, {{4, 10}, {}}, {{0, 10}, {}}, {{0, 0}, {}}}}});
  const MedialAxis axis = axis_of(corner);
  bool found = false;
  for (const MedialEdge& edge : axis.edges)
    for (const MedialPoint& p : edge.points) {
      if (!(p.at.x > 2.01 && p.at.x < 3.99 && p.at.y > 2.0 && p.at.y < 2.4)) continue;
      found = true;  // equally far from y = 0 and from (4, 4)
      EXPECT_NEAR(p.at.y, distance(p.at, {4, 4}), 1e-6);
    }
  EXPECT_TRUE(found);
  const auto inner = largest_inscribed_circle(corner, {}, diagnostics);
  // Touches both outer sides and the inner corner: r = (4 - r) sqrt(2).
  EXPECT_NEAR(inner->radius.mm(), 4.0 * std::sqrt(2.0) / (1.0 + std::sqrt(2.0)), 1e-6);
}

TEST_F(MedialAxes, OfARingGoAround) {
  const MedialAxis axis = axis_of(made({circle(0, 0, 10), circle(0, 0, 5)}, FillRule::even_odd));
  EXPECT_NEAR(length_of(axis), 2.0 * kPi * 7.5, 0.05);
  EXPECT_EQ(ends(axis), 0u);
  for (const MedialEdge& edge : axis.edges) EXPECT_NE(edge.left.loop, edge.right.loop);
}

TEST_F(MedialAxes, OfSeparatePartsAreSeparate) {
  const MedialAxis axis = axis_of(made({rectangle(0, 0, 4, 4), circle(10, 0, 1), rectangle(4, 4, 2, 2)}));
  EXPECT_EQ(axis.edges.size(), 8u);  // squares that touch in a corner
  EXPECT_EQ(ends(axis), 6u);         // the common corner is one node, where two edges end
  EXPECT_EQ(axis.nodes.size(), 10u);
}

TEST_F(MedialAxes, SkipSmoothJointsOnly) {
  MedialOptions options;
  // A corner that turns by 2 degrees in a long side.
  const Region nearly = made({{{0, 0},
                               {{{10, 0}, {}},
                                {{20, 10.0 * std::tan(2.0 * kPi / 180.0)}, {}},
                                {{20, 10}, {}},
                                {{0, 10}, {}},
                                {{0, 0}, {}}}}});
  const std::size_t sharp = axis_of(nearly, options).edges.size();
  options.smooth = degrees(3.0);
  EXPECT_LT(axis_of(nearly, options).edges.size(), sharp + 1);
}

/// A disc that opens into a channel: its axis comes from the channel and ends in the centre, whatever arcs
/// the circle is drawn as. The circles near the centre touch both sides of the opening, which are tangent
/// nowhere.
TEST_F(MedialAxes, OfADiscWithAnOpeningReachItsCentre) {
  for (const double radius : {0.4, 2.0, 6.1, 40.0})
    for (const double narrowness : {0.01, 0.025, 0.1, 0.6}) {
      const double half = narrowness * radius, x = std::sqrt(radius * radius - half * half);
      const Point2 low{-x, -half}, high{-x, half}, bottom{0, -radius}, top{0, radius}, right{radius, 0};
      const auto on = [&](double degree) {
        return Point2{radius * std::cos(degree * kPi / 180.0), radius * std::sin(degree * kPi / 180.0)};
      };
      const double end = 180.0 - std::asin(narrowness) * 180.0 / kPi;
      const std::vector<std::vector<Segment>> arcs{
          {{high, right}},
          {{right, bottom}, {high, top}},
          {{right, bottom}, {on(end - 10.0), top}, {high, on(end - 3.0)}},
          {{on(0.5 - end), on(0.25 - end)}, {on(60), on(-60)}, {high, on(100)}}};
      for (std::size_t i = 0; i < arcs.size(); ++i) {
        Outline outline{{-2.0 * radius, -half}, {{low, {}}}};
        outline.segments.insert(outline.segments.end(), arcs[i].begin(), arcs[i].end());
        outline.segments.push_back({{-2.0 * radius, half}, {}});
        outline.segments.push_back({outline.start, {}});
        const MedialAxis axis = axis_of(made({outline}));
        double nearest = INFINITY;
        for (const MedialEdge& edge : axis.edges)
          for (const MedialPoint& p : edge.points) nearest = std::min(nearest, distance(p.at, {0, 0}));
        EXPECT_LE(nearest, 2.0 * kChord) << radius << " " << narrowness << " " << i;
      }
    }
}

TEST_F(MedialAxes, OfNothingAreEmpty) {
  EXPECT_TRUE(axis_of(Region{}).nodes.empty());
  EXPECT_FALSE(largest_inscribed_circle(Region{}, {}, diagnostics).has_value());
}

TEST(MedialErrors, NameTheArgument) {
  Diagnostics diagnostics;
  MedialOptions options;
  options.region.tolerance.chord = mm(0.0);
  EXPECT_FALSE(medial_axis(Region{{rectangle(0, 0, 1, 1)}}, options, diagnostics).has_value());
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::region_bad_argument);
}

TEST(GridChords, AreSeparateWhereTheyMeetInEndsOnly) {
  using medial_detail::are_separate;
  EXPECT_TRUE(are_separate({{{0, 0}, {4, 0}}, {{4, 0}, {4, 4}}, {{0, 1}, {3, 1}}}));
  EXPECT_FALSE(are_separate({{{0, 0}, {4, 4}}, {{0, 4}, {4, 0}}}));
  EXPECT_FALSE(are_separate({{{0, 0}, {4, 0}}, {{2, 0}, {2, 4}}}));  // an end on the other
  EXPECT_FALSE(are_separate({{{0, 0}, {4, 0}}, {{4, 0}, {2, 0}}}));  // along each other
  EXPECT_FALSE(are_separate({{{0, 0}, {4, 0}}, {{4, 0}, {0, 0}}}));  // the same twice
}

}  // namespace
}  // namespace kerf

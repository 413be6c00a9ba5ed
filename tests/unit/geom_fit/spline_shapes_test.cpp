// Splines of ellipses and through points.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "kerf/geom/fit.h"
#include "kerf/geom/outline.h"

namespace kerf {
namespace {

constexpr double kPi = std::numbers::pi;

double distance_to(const std::vector<Point2>& chain, Point2 p) {
  double nearest = 1e300;
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const Point2 way = chain[i] - chain[i - 1];
    const double t = std::clamp(dot(p - chain[i - 1], way) / std::max(dot(way, way), 1e-300), 0.0, 1.0);
    nearest = std::min(nearest, distance(p, chain[i - 1] + t * way));
  }
  return nearest;
}

TEST(EllipseSpline, FollowsTheEllipseInItsDirection) {
  const Point2 centre{3, 4}, u{20, 10}, v{-3, 6};
  for (const double sweep : {2 * kPi, -2 * kPi, 1.0, -1.0, 4.0, 1e-3}) {
    Diagnostics diagnostics;
    const auto fitted =
        fit_spline(ellipse_spline(centre, u, v, radians(0.3), radians(sweep)), mm(0.01), {}, diagnostics);
    ASSERT_TRUE(fitted && diagnostics.list().empty());
    const auto chain = flattened(*fitted, mm(1e-4));
    for (int i = 0; i <= 100; ++i) {
      const double t = 0.3 + sweep * i / 100;
      EXPECT_LE(distance_to(chain, centre + std::cos(t) * u + std::sin(t) * v), 0.0102) << sweep;
    }
    const Point2 end = centre + std::cos(0.3 + sweep) * u + std::sin(0.3 + sweep) * v;
    EXPECT_LE(distance(fitted->segments.back().to, end), 1e-9);
    EXPECT_EQ(fitted->closed(), std::abs(sweep) > 6.0);
    if (fitted->closed()) {
      const double expected = (sweep > 0 ? 1 : -1) * kPi * cross(u, v);
      EXPECT_NEAR(area(*fitted), expected, 0.001 * std::abs(expected));
    }
  }
}

/// A point of a piece of a cubic spline in Bezier form, t from 0 to 1, and its derivatives by the knots.
struct Local {
  Point2 at, first, second;
};
Local local(const Spline& s, std::size_t piece, double t) {
  const Point2* c = &s.control[3 * piece];
  const double h = s.knots[4 + 3 * piece] - s.knots[3 + 3 * piece], r = 1 - t;
  const Point2 at = r * r * r * c[0] + 3 * r * r * t * c[1] + 3 * r * t * t * c[2] + t * t * t * c[3];
  const Point2 first = (3 / h) * (r * r * (c[1] - c[0]) + 2 * r * t * (c[2] - c[1]) + t * t * (c[3] - c[2]));
  const Point2 second = (6 / h / h) * (r * (c[2] - 2 * c[1] + c[0]) + t * (c[3] - 2 * c[2] + c[1]));
  return {at, first, second};
}

TEST(SplineThrough, PassesThroughItsPointsWithContinuousCurvature) {
  const std::vector<Point2> points{{0, 0}, {4, 7}, {5, 7}, {5, 7}, {12, -3}, {20, 1}};
  Diagnostics diagnostics;
  const auto spline = spline_through(points, {}, {}, diagnostics);
  ASSERT_TRUE(spline);
  ASSERT_EQ(spline->control.size(), 13u);  // one point is repeated
  ASSERT_EQ(spline->knots.size(), 17u);
  for (std::size_t k = 0; k + 1 < 4; ++k) {
    const Local before = local(*spline, k, 1), after = local(*spline, k + 1, 0);
    EXPECT_LE(distance(before.at, after.at), 1e-12);
    EXPECT_LE(distance(before.first, after.first), 1e-12);
    EXPECT_LE(distance(before.second, after.second), 1e-12);
  }
  EXPECT_LE(distance(local(*spline, 1, 1).at, {5, 7}), 1e-12);
  EXPECT_LE(length(local(*spline, 0, 0).second), 1e-12);  // free ends have no curvature
  EXPECT_LE(length(local(*spline, 3, 1).second), 1e-12);
}

TEST(SplineThrough, TakesDirectionsAndClosesSmoothly) {
  Diagnostics diagnostics;
  SplineEnds ends;
  ends.start = {0, 5};
  ends.end = {0, -2};
  const auto arch = spline_through({{0, 0}, {10, 0}}, ends, {}, diagnostics);
  ASSERT_TRUE(arch);
  EXPECT_LE(distance(local(*arch, 0, 0).first, {0, 1}), 1e-12);
  EXPECT_LE(distance(local(*arch, 0, 1).first, {0, -1}), 1e-12);
  EXPECT_NEAR(local(*arch, 0, 0.5).at.y, 2.5, 1e-12);

  SplineEnds ring;
  ring.closed = true;
  std::vector<Point2> circle;
  for (int i = 0; i < 12; ++i) circle.push_back({10 * std::cos(kPi * i / 6), 10 * std::sin(kPi * i / 6)});
  const auto closed = spline_through(circle, ring, {}, diagnostics);
  ASSERT_TRUE(closed);
  const Local before = local(*closed, 11, 1), after = local(*closed, 0, 0);
  EXPECT_LE(distance(before.at, after.at) + distance(before.first, after.first), 1e-12);
  EXPECT_LE(distance(before.second, after.second), 1e-12);
  for (std::size_t k = 0; k < 12; ++k) EXPECT_NEAR(length(local(*closed, k, 0.5).at), 10.0, 0.01);
}

TEST(SplineThrough, OnePointIsNoCurve) {
  for (const std::vector<Point2>& points :
       {std::vector<Point2>{}, {{1, 1}}, {{1, 1}, {1, 1}}, {{0, 0}, {NAN, 1}}}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(spline_through(points, {}, {}, diagnostics));
    EXPECT_TRUE(diagnostics.has_errors());
  }
}

}  // namespace
}  // namespace kerf

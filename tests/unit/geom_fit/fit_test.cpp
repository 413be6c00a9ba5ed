// Curves fitted with arcs stay within the tolerance, with few arcs.
#include "kerf/geom/fit.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "base/codes/outline.h"
#include "geom/outline/segment.h"

namespace kerf {
namespace {

constexpr double kPi = std::numbers::pi;

double off(const Outline& outline, Point2 p) {
  double nearest = 1e300;
  for (std::size_t i = 0; i < outline.segments.size(); ++i)
    nearest = std::min(
        nearest, distance_to(outline_detail::make_carrier(outline.point(i), outline.segments[i], 0.0), p));
  return nearest;
}

std::vector<Point2> round_slot(
    int points) {  // a slot: half circles of radius 5 at x = 0 and 20, lines between
  std::vector<Point2> made;
  for (int i = 0; i <= points; ++i) {
    const double a = kPi * i / points;
    made.push_back({20.0 + 5.0 * std::sin(a), -5.0 * std::cos(a)});
  }
  for (int i = 0; i <= points; ++i) {
    const double a = kPi * i / points;
    made.push_back({-5.0 * std::sin(a), 5.0 * std::cos(a)});
  }
  made.push_back(made.front());
  return made;
}

TEST(FitArcs, FindsTheArcsThatWereFlattened) {
  Diagnostics diagnostics;
  const auto points = round_slot(100);
  const auto made = fit_arcs(points, mm(0.01), {}, diagnostics);
  ASSERT_TRUE(made.has_value());
  EXPECT_TRUE(made->closed());
  EXPECT_LE(made->segments.size(), 6u);
  for (const Point2 p : points) EXPECT_LT(off(*made, p), 0.01);
  for (const Point2 p : flattened(*made, mm(1e-4))) {
    double nearest = 1e300;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      nearest = std::min(nearest,
                         distance_to(outline_detail::make_carrier(points[i], {points[i + 1], {}}, 0.0), p));
    EXPECT_LT(nearest, 0.01);
  }
}

TEST(FitArcs, KeepsCornersAndLines) {
  Diagnostics diagnostics;
  std::vector<Point2> square;
  for (int i = 0; i <= 40; ++i) square.push_back({std::min(i, 20) * 0.5, std::max(i - 20, 0) * 0.5});
  const auto made = fit_arcs(square, mm(0.001), {}, diagnostics);
  ASSERT_EQ(made->segments.size(), 2u);
  EXPECT_FALSE(made->segments[0].via.has_value());
  EXPECT_EQ(made->segments[0].to, (Point2{10, 0}));
}

Point2 bezier_at(const std::vector<Point2>& control, double t) {
  std::vector<Point2> p = control;
  for (std::size_t k = p.size() - 1; k > 0; --k)
    for (std::size_t i = 0; i < k; ++i) p[i] = (1.0 - t) * p[i] + t * p[i + 1];
  return p[0];
}

TEST(FitBezier, StaysWithinTheTolerance) {
  const std::vector<std::vector<Point2>> curves = {
      {{0, 0}, {10, 20}, {30, -15}, {40, 0}},             // an inflexion
      {{0, 0}, {30, 20}, {-10, 20}, {20, 0}},             // a loop
      {{0, 0}, {20, 20}, {0, 20}, {20, 0}},               // a cusp
      {{0, 0}, {5, 5}, {10, 0}},                          // a parabola
      {{0, 0}, {0, 0}, {10, 10}, {10, 0}},                // no direction at the start
      {{0, 0}, {7, 1}, {9, 9}, {3, 12}, {-4, 8}, {0, 0}}  // closed
  };
  for (const auto& control : curves)
    for (const double within : {0.1, 0.001}) {
      Diagnostics diagnostics;
      const auto made = fit_bezier(control, mm(within), {}, diagnostics);
      ASSERT_TRUE(made.has_value());
      EXPECT_TRUE(diagnostics.list().empty());
      EXPECT_EQ(made->start, control.front());
      EXPECT_LT(distance(made->segments.back().to, control.back()), 1e-12);
      EXPECT_LT(made->segments.size(), 3.0 * std::pow(40.0 / within, 1.0 / 3.0) + 60.0);
      for (int i = 0; i <= 1000; ++i) EXPECT_LE(off(*made, bezier_at(control, i / 1000.0)), within);
    }
}

/// The parabola (10 s, 10 s (1 - s)), and the same curve with s = t^2, whose derivative is zero at its start.
TEST(FitBezier, ACurveThatStartsWithoutADerivativeNeedsFewArcs) {
  const std::vector<Point2> regular{{0, 0}, {5, 5}, {10, 0}};
  const std::vector<Point2> slow{{0, 0}, {0, 0}, {10.0 / 6, 10.0 / 6}, {5, 5}, {10, 0}};
  for (const double t : {0.1, 0.5, 0.9})
    ASSERT_LT(distance(bezier_at(slow, t), bezier_at(regular, t * t)), 1e-12);
  for (const double within : {0.1, 0.01, 0.001}) {
    Diagnostics diagnostics;
    const auto want = fit_bezier(regular, mm(within), {}, diagnostics);
    for (const bool backwards : {false, true}) {
      std::vector<Point2> control = slow;
      if (backwards) std::reverse(control.begin(), control.end());
      const auto made = fit_bezier(control, mm(within), {}, diagnostics);
      ASSERT_TRUE(made && want);
      EXPECT_LE(made->segments.size(), 2 * want->segments.size()) << within;
    }
  }
}

TEST(FitSpline, MakesAnExactCircleOfWeights) {
  Diagnostics diagnostics;
  const double w = std::sqrt(0.5);
  Spline circle;
  circle.degree = 2;
  circle.control = {{10, 0},    {10, 10}, {0, 10},   {-10, 10}, {-10, 0},
                    {-10, -10}, {0, -10}, {10, -10}, {10, 0}};
  circle.weights = {1, w, 1, w, 1, w, 1, w, 1};
  circle.knots = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
  const auto made = fit_spline(circle, mm(1e-6), {}, diagnostics);
  ASSERT_TRUE(made.has_value());
  EXPECT_LE(made->segments.size(), 16u);
  Point2 from = made->start;
  for (const Segment& s : made->segments) {
    const auto arc = arc_circle(from, s);
    ASSERT_TRUE(arc.has_value());
    EXPECT_NEAR(arc->radius, 10.0, 1e-9);
    from = s.to;
  }
}

TEST(FitSpline, OfUniformKnotsFollowsTheBasis) {
  Diagnostics diagnostics;
  Spline spline;  // cubic, not clamped: starts at (P0 + 4 P1 + P2) / 6
  spline.control = {{0, 0}, {6, 12}, {12, -6}, {18, 6}, {24, 0}};
  spline.knots = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  const auto made = fit_spline(spline, mm(0.001), {}, diagnostics);
  ASSERT_TRUE(made.has_value());
  EXPECT_NEAR(made->start.x, 6.0, 1e-12);
  EXPECT_NEAR(made->start.y, 7.0, 1e-12);
  EXPECT_NEAR(made->segments.back().to.x, 18.0, 1e-12);
  EXPECT_NEAR(made->segments.back().to.y, 3.0, 1e-12);
}

TEST(FitErrors, NameWhatIsWrong) {
  const auto code_of = [](auto call) {
    Diagnostics diagnostics;
    EXPECT_FALSE(call(diagnostics).has_value());
    return diagnostics.list().empty() ? Code{} : diagnostics.list()[0].code;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code_of([](Diagnostics& d) { return fit_arcs({{0, 0}}, mm(1), {}, d); }), codes::curve_malformed);
  EXPECT_EQ(code_of([](Diagnostics& d) {
              return fit_arcs({{0, 0}, {1, 1}}, mm(0), {}, d);
            }),
            codes::region_bad_argument);
  EXPECT_EQ(code_of([&](Diagnostics& d) {
              return fit_bezier({{0, 0}, {nan, 1}}, mm(1), {}, d);
            }),
            codes::outline_not_finite);
  Spline spline;
  spline.control = {{0, 0}, {1, 1}, {2, 0}, {3, 1}};
  spline.knots = {0, 0, 0, 0, 1, 1, 1};
  EXPECT_EQ(code_of([&](Diagnostics& d) { return fit_spline(spline, mm(1), {}, d); }),
            codes::curve_malformed);
  spline.knots = {0, 0, 0, 0, 1, 1, 1, 1};
  spline.weights = {1, 0, 1, 1};
  EXPECT_EQ(code_of([&](Diagnostics& d) { return fit_spline(spline, mm(1), {}, d); }),
            codes::curve_malformed);
  spline.weights.clear();
  spline.knots = {0, 0, 0, 2, 1, 1, 1, 1};
  EXPECT_EQ(code_of([&](Diagnostics& d) { return fit_spline(spline, mm(1), {}, d); }),
            codes::curve_malformed);
}

double off_chords(const std::vector<Point2>& points, Point2 p) {
  double off = 1e300;
  for (std::size_t i = 1; i < points.size(); ++i)
    off = std::min(off, distance_to(line_between(points[i - 1], points[i]), p));
  return off;
}

TEST(Flattened, ASplineThatIsAParabola) {
  // y = x^2 / 10 from x = -10 to 10; its second derivative by the parameter is 80 mm, so n chords deviate
  // by 10 / n^2.
  const Spline parabola = clamped_spline(2, {{-10, 10}, {0, -10}, {10, 10}});
  EXPECT_EQ(parabola.knots, (std::vector<double>{0, 0, 0, 1, 1, 1}));
  const std::vector<Point2> points = flattened(parabola, mm(0.1), 1000);
  ASSERT_EQ(points.size(), 11u);
  EXPECT_EQ(points.front(), (Point2{-10, 10}));
  EXPECT_EQ(points.back(), (Point2{10, 10}));
  for (const Point2 p : points) EXPECT_NEAR(p.y, p.x * p.x / 10, 1e-12);
  EXPECT_EQ(flattened(parabola, mm(0.1), 4).size(), 5u);
}

TEST(Flattened, ARationalSplineStaysWithinTheChord) {
  // A quarter circle of radius 10, and a half one in two quarters.
  const double w = std::sqrt(0.5);
  Spline half{
      2, {{10, 0}, {10, 10}, {0, 10}, {-10, 10}, {-10, 0}}, {0, 0, 0, 1, 1, 2, 2, 2}, {1, w, 1, w, 1}};
  for (const double chord : {1.0, 0.1, 0.001}) {
    const std::vector<Point2> points = flattened(half, mm(chord), 100'000);
    for (const Point2 p : points) EXPECT_NEAR(length(p), 10, 1e-12);
    for (int i = 0; i <= 200; ++i) {
      const double a = kPi * i / 200;
      EXPECT_LE(off_chords(points, {10 * std::cos(a), 10 * std::sin(a)}), chord);
    }
    EXPECT_LT(static_cast<double>(points.size()), 4 + 6 * std::sqrt(10 / chord));
  }
}

TEST(Flattened, SplinesOfManySpansPassTheirEnds) {
  const Spline spline =
      clamped_spline(3, {{0, 0}, {5, 9}, {9, -4}, {14, 6}, {20, 0}, {22, 5}}, {1, 2, 1, 5, 1, 1});
  EXPECT_EQ(spline.knots, (std::vector<double>{0, 0, 0, 0, 1, 2, 3, 3, 3, 3}));
  const auto coarse = flattened(spline, mm(0.05), 100'000), fine = flattened(spline, mm(0.0005), 100'000);
  EXPECT_GT(fine.size(), 5 * coarse.size());
  for (const Point2 p : fine) EXPECT_LE(off_chords(coarse, p), 0.05);
  EXPECT_EQ(coarse.back(), (Point2{22, 5}));
}

}  // namespace
}  // namespace kerf

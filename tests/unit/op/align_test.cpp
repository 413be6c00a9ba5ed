// Where a workpiece lies, from probed points: expectations are the motion by which the points were moved.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "base/codes/op.h"

#include "kerf/op/rework.h"

namespace kerf {
namespace {

struct Lie {
  double angle;  // degrees
  Point2 shift;
  Point2 operator()(Point2 p) const {
    const double a = angle * std::numbers::pi / 180.0;
    return {shift.x + p.x * std::cos(a) - p.y * std::sin(a), shift.y + p.x * std::sin(a) + p.y * std::cos(a)};
  }
};

Point2 moved(const PathTransform& t, Point2 p) {
  Toolpath path;
  path.add(step::Rapid{{p.x, p.y, 1.0}}, OriginId::none);
  Diagnostics diagnostics;
  const auto there = transformed(path, t, diagnostics);
  EXPECT_TRUE(there);
  return there ? (*there)[0].to().xy() : Point2{};
}
void expect_near(Point2 a, Point2 b, double slack) { EXPECT_LT(distance(a, b), slack); }

TEST(Align, PointsHolesAndCornersFindTheMotion) {
  std::mt19937_64 random(3);
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int k = 0; k < 200; ++k) {
    const Lie lie{k % 4 == 0 ? 90.0 * (k / 4 % 4) : in(-179.0, 179.0), {in(-300, 300), in(-300, 300)}};
    const Point2 a{in(-50, 50), in(-50, 50)}, b = a + Point2{in(5, 90), in(5, 90)};
    AlignOptions options{.points = {{a, {lie(a)}}, {b, {}}}};
    const double radius = in(2, 20);
    for (const double turn : {0.3, 2.0, 4.4})
      options.points[1].measured.push_back(lie(b + radius * Point2{std::cos(turn), std::sin(turn)}));
    Diagnostics diagnostics;
    const auto found = alignment_of(options, diagnostics);
    ASSERT_TRUE(found && diagnostics.list().empty());
    EXPECT_LT(found->farthest.mm(), 1e-6);
    expect_near(moved(found->transform, {7, -3}), lie({7, -3}), 1e-5);

    // The corner of a part at `a`: a probe of 4 mm touches its edges from outside.
    const AlignPoint corner{
        a, {lie(a + Point2{5, -2}), lie(a + Point2{80, -2}), lie(a + Point2{-2, 33})}, true};
    const auto at_corner = alignment_of({.points = {corner}, .probe = mm(4)}, diagnostics);
    ASSERT_TRUE(at_corner);
    expect_near(moved(at_corner->transform, {7, -3}), lie({7, -3}), 1e-5);
  }
}

TEST(Align, OnePointIsAShift) {
  Diagnostics diagnostics;
  const auto found = alignment_of({.points = {{{10, 20}, {{13, 16}}}}}, diagnostics);
  ASSERT_TRUE(found);
  expect_near(moved(found->transform, {100, 100}), {103, 96}, 1e-12);
}

TEST(Align, PointsThatDoNotFitAreAWarning) {
  Diagnostics diagnostics;
  // 100 mm measured as 101: each point is half a millimetre off.
  const auto found = alignment_of({.points = {{{0, 0}, {{0, 0}}}, {{100, 0}, {{101, 0}}}}}, diagnostics);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->farthest.mm(), 0.5, 1e-12);
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::align_misfit);
}

TEST(Align, PointsThatDefineNothingAreErrors) {
  const std::vector<std::vector<AlignPoint>> wrong{
      {{{0, 0}, {{1, 1}}}, {{0, 0}, {{5, 1}}}},                             // one position, two measurements
      {{{0, 0}, {{1, 1}}}, {{9, 0}, {{1, 1}}}},                             // two positions, one measurement
      {{{0, 0}, {{0, 0}, {5, 5}, {10, 10}}}},                               // a hole through points on a line
      {{{0, 0}, {{5, 5}, {5, 5}, {5, 5}}}},                                 // a hole through one point
      {{{0, 0}, {{0, 0}, {0, 0}, {10, 10}}, true}},                         // an edge of one point
      {{{0, 0}, {{0, 0}, {9, 0}, {0, 9}}, true}, {{50, 0}, {{50.0, 0.0}}}}  // a corner and a point
  };
  for (const auto& points : wrong) {
    Diagnostics diagnostics;
    EXPECT_FALSE(alignment_of({.points = points}, diagnostics));
    ASSERT_EQ(diagnostics.list().size(), 1u);
    EXPECT_EQ(diagnostics.list()[0].code, codes::pass_option);
  }
}

TEST(Align, TheOptionIsReadInAllItsForms) {
  ReworkOptions options;
  EXPECT_EQ(set_rework(options, "align", std::string(" 0,0 = 10.2,5.1; 100,0=110.15,7.25/1,2/3,4 ")), "");
  ASSERT_EQ(options.align.points.size(), 2u);
  EXPECT_EQ(options.align.points[1].measured.size(), 3u);
  EXPECT_EQ(set_rework(options, "align", std::string("corner=1,2/3,4/5,6")), "");
  EXPECT_EQ(set_rework(options, "align", std::string("corner 20,10=1,2/3,4/5,6")), "");
  EXPECT_TRUE(options.align.points[0].is_corner && (options.align.points[0].at == Point2{20, 10}));
  for (const char* text : {"", ";", "0,0", "0,0=", "0,0=1", "0,0=1,2/3,4", "corner=1,2", "0,0=1,2;",
                           "x,0=1,2", "0,0=1,2/3,4/5,6/7,8", "0,0=nan,2", "corners=1,2/3,4/5,6"})
    EXPECT_NE(set_rework(options, "align", std::string(text)), "") << text;
}

}  // namespace
}  // namespace kerf

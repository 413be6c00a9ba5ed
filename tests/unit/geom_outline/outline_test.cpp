// Corners of outlines: the geometry of each kind, each reason to stay sharp, their order, transforms.
#include "base/codes/outline.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "kerf/geom/outline.h"

namespace kerf {
namespace {

constexpr double kNear = 1e-9;

struct Requested {
  Outline outline;
  CornerRequests corners;
};

Requested square(double side, double request) {
  return {{{0, 0}, {{{side, 0}}, {{side, side}}, {{0, side}}, {{0, 0}}}}, CornerRequests(4, mm(request))};
}

/// An open outline of two segments with one corner at the origin.
Requested corner(Point2 from, std::optional<Point2> via_in, double request, std::optional<Point2> via_out,
                 Point2 to) {
  return {{from, {{{0, 0}, via_in}, {to, via_out}}}, {Length(), mm(request)}};
}

std::optional<CutOutline> cut_corners(const Requested& shape, const CornerOptions& options,
                                      Diagnostics& diagnostics) {
  return cut_corners(shape.outline, shape.corners, options, diagnostics);
}
CutOutline cut(const Requested& shape, const CornerOptions& options = {}) {
  Diagnostics diagnostics;
  auto made = cut_corners(shape, options, diagnostics);
  EXPECT_TRUE(made.has_value());
  return made.value_or(CutOutline{});
}

/// The only diagnostic of cutting an outline.
Diagnostic diagnostic_of(const Requested& outline, CornerOptions options = {}) {
  Diagnostics diagnostics;
  options.name = "plate";
  cut_corners(outline, options, diagnostics);
  EXPECT_EQ(diagnostics.list().size(), 1u);
  return diagnostics.list().empty() ? Diagnostic{} : diagnostics.list()[0];
}

void expect_point(Point2 got, Point2 wanted) {
  EXPECT_NEAR(got.x, wanted.x, kNear);
  EXPECT_NEAR(got.y, wanted.y, kNear);
}

TEST(Corners, ASmoothedSquareKeepsItsArea) {
  const CutOutline made = cut(square(10, 2));
  ASSERT_EQ(made.corners.size(), 4u);
  EXPECT_TRUE(made.outline.closed());
  EXPECT_EQ(made.outline.segments.size(), 8u);
  expect_point(made.outline.start, {0, 2});
  for (const CornerReport& report : made.corners) {
    EXPECT_EQ(report.outcome, CornerOutcome::smoothed);
    const auto arc = arc_circle(made.outline.point(report.first), made.outline.segments[report.first]);
    ASSERT_TRUE(arc);
    EXPECT_NEAR(arc->radius, 2.0, kNear);
    EXPECT_NEAR(arc->sweep.deg(), 90.0, 1e-6);
    EXPECT_EQ(arc->turn, Turn::ccw);
  }
}

TEST(Corners, EnlargingARightAngleMakesOneArcThroughTheCorner) {
  const Outline made = cut(corner({-10, 0}, {}, -2, {}, {0, 10})).outline;
  ASSERT_EQ(made.segments.size(), 3u);
  const double reach = 2.0 * std::sqrt(2.0);
  expect_point(made.segments[0].to, {-reach, 0});
  ASSERT_TRUE(made.segments[1].via);
  expect_point(*made.segments[1].via, {0, 0});
  expect_point(made.segments[1].to, {0, reach});
}

TEST(Corners, EnlargingAnAcuteAngleMakesAChannelAsWideAsTheBit) {
  // The angle is 60 degrees, so the channel's walls start r / sin(30) from the corner.
  const Outline made = cut(corner({-20, 0}, {}, -1, {}, {-10, 10 * std::sqrt(3.0)})).outline;
  ASSERT_EQ(made.segments.size(), 5u);
  expect_point(made.segments[0].to, {-2, 0});
  EXPECT_FALSE(made.segments[1].via);
  ASSERT_TRUE(made.segments[2].via);
  EXPECT_FALSE(made.segments[3].via);
  EXPECT_NEAR(distance(made.segments[1].to, made.segments[2].to), 2.0, kNear);
  EXPECT_NEAR(distance(made.segments[0].to, made.segments[3].to), 2.0, kNear);
}

TEST(Corners, LineAndArcBothWaysRoundAreMirrorImages) {
  const Requested one = corner({-30, 0}, {}, 2, Point2{-5, 8}, {-4, 20});
  const Requested other{reversed(one.outline), reversed(one.corners, one.outline)};
  const Outline a = cut(one).outline, b = reversed(cut(other).outline);
  ASSERT_EQ(a.segments.size(), 3u);
  ASSERT_EQ(b.segments.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) expect_point(a.segments[i].to, b.segments[i].to);
}

TEST(Corners, ArcsMeetTangentially) {
  const CutOutline made = cut(corner({-17, 10}, Point2{-10, 3}, 2, Point2{10, 8}, {12, 20}));
  ASSERT_EQ(made.corners.at(0).outcome, CornerOutcome::smoothed);
  const auto in = arc_circle(made.outline.start, made.outline.segments[0]);
  const auto bit = arc_circle(made.outline.point(1), made.outline.segments[1]);
  const auto out = arc_circle(made.outline.point(2), made.outline.segments[2]);
  ASSERT_TRUE(in && bit && out);
  EXPECT_NEAR(bit->radius, 2.0, kNear);
  // Circles touch where their centres are the sum or the difference of the radii apart.
  const auto gap = [](const ArcCircle& a, const ArcCircle& b) {
    const double d = distance(a.centre, b.centre);
    return std::min(std::abs(d - a.radius - b.radius), std::abs(d - std::abs(a.radius - b.radius)));
  };
  EXPECT_NEAR(gap(*in, *bit), 0.0, kNear);
  EXPECT_NEAR(gap(*out, *bit), 0.0, kNear);
}

TEST(Corners, AnEnlargedCornerOfArcsLetsTheBitReachIt) {
  const CutOutline made = cut(corner({-17, 10}, Point2{-10, 3}, -2, Point2{10, 8}, {12, 20}));
  ASSERT_EQ(made.corners.at(0).outcome, CornerOutcome::enlarged);
  bool reached = false;
  for (std::size_t i = 0; i < made.outline.segments.size(); ++i)
    if (made.outline.segments[i].via == Point2{}) {
      const auto bit = arc_circle(made.outline.point(i), made.outline.segments[i]);
      reached = bit && std::abs(bit->radius - 2.0) < kNear;
    }
  EXPECT_TRUE(reached);
}

TEST(Corners, AnExactFitLeavesNoSegmentWithoutLength) {
  const CutOutline made = cut(square(10, 5));
  EXPECT_EQ(made.outline.segments.size(), 4u);  // four quarter circles
  EXPECT_TRUE(made.outline.closed());
}

TEST(Corners, TheFirstCornerWinsAnEdgeThatIsTooShortForTwo) {
  Diagnostics diagnostics;
  const auto made = cut_corners(square(10, 6), {.name = "plate"}, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->corners[0].outcome, CornerOutcome::smoothed);
  EXPECT_EQ(made->corners[1].outcome, CornerOutcome::sharp);
  EXPECT_EQ(made->corners[2].outcome, CornerOutcome::smoothed);
  EXPECT_EQ(made->corners[3].outcome, CornerOutcome::sharp);
  EXPECT_EQ(diagnostics.warnings(), 2u);
  EXPECT_NEAR(made->corners[1].largest.mm(), 4.0, 1e-5);
  EXPECT_EQ(diagnostics.list()[0].code, codes::corner_too_large);
  EXPECT_NE(diagnostics.list()[0].message.find("plate.1"), std::string::npos);
  EXPECT_NE(diagnostics.list()[0].message.find("2 too large"), std::string::npos)
      << diagnostics.list()[0].message;
}

TEST(Corners, SharedEvenlyTheResultDoesNotDependOnTheStart) {
  Requested outline = square(10, 6);
  outline.corners[1] = mm(4);
  CornerOptions options{.sharing = EdgeSharing::even, .name = "plate"};
  Diagnostics diagnostics;
  const auto made = cut_corners(outline, options, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->corners[0].outcome, CornerOutcome::sharp);
  EXPECT_EQ(made->corners[1].outcome, CornerOutcome::smoothed);  // 4 of 10: within its half
  EXPECT_EQ(made->corners[0].reason, SharpReason::shared);
  EXPECT_EQ(diagnostics.list()[0].code, codes::corner_shared);
  // The largest radius of the report fits.
  for (const CornerReport& report : made->corners) {
    if (report.outcome != CornerOutcome::sharp) continue;
    Requested smaller = outline;
    smaller.corners[report.element] = report.largest;
    EXPECT_EQ(cut(smaller, options).corners.at(report.element).outcome, CornerOutcome::smoothed);
  }
}

TEST(Corners, SharedEvenlyTheMessageHasTheExcess) {
  Diagnostics diagnostics;
  const CornerOptions options{.sharing = EdgeSharing::even, .name = "plate"};
  const auto made = cut_corners(square(10, 6), options, diagnostics);
  ASSERT_TRUE(made);
  ASSERT_EQ(diagnostics.warnings(), 4u);
  for (const Diagnostic& d : diagnostics.list())
    EXPECT_NE(d.message.find("the radius is 1 too large, the largest here is 5"), std::string::npos)
        << d.message;
}

TEST(Corners, TheLargestRadiusOfAMessageFits) {
  for (const double request : {12.0, 20.0, 1e3, 1e7}) {
    Diagnostics diagnostics;
    const Requested outline = corner({-10, 0}, {}, request, {}, {0, 10});
    ASSERT_TRUE(cut_corners(outline, {.name = "plate"}, diagnostics));
    EXPECT_NE(diagnostics.list().at(0).message.find("the largest here is 10"), std::string::npos)
        << diagnostics.list()[0].message;
  }
  for (const double slant : {1.0, 3.0, 7.0, 9.0}) {
    Diagnostics diagnostics;
    Requested outline = corner({-10, 0}, {}, 50, {}, {slant, 10});
    ASSERT_TRUE(cut_corners(outline, {.name = "plate"}, diagnostics));
    const std::string& message = diagnostics.list().at(0).message;
    const std::size_t at = message.find("the largest here is ");
    ASSERT_NE(at, std::string::npos) << message;
    outline.corners[1] = mm(std::stod(message.substr(at + 20)));
    EXPECT_EQ(cut(outline).corners.at(0).outcome, CornerOutcome::smoothed) << message;
  }
}

TEST(Corners, EachReasonToStaySharpHasItsCode) {
  EXPECT_EQ(diagnostic_of(corner({-10, 0}, {}, 1, {}, {10, 0.001})).code, codes::corner_straight);
  EXPECT_EQ(diagnostic_of(corner({-10, 0}, {}, 1, {}, {-10, 0.001})).code, codes::corner_folded);
  EXPECT_EQ(diagnostic_of(corner({-1, 0}, {}, 5, {}, {0, 10})).code, codes::corner_too_large);
  EXPECT_EQ(diagnostic_of(corner({0, 0}, {}, 1, {}, {0, 10})).code, codes::corner_no_neighbour);
  EXPECT_EQ(diagnostic_of(corner({-1, 0}, {}, 1e-9, {}, {0, 10})).code, codes::corner_radius_tiny);
  // A circle of radius 12 does not fit into an arc of radius 10.
  EXPECT_EQ(diagnostic_of(corner({-30, 0}, {}, 12, Point2{-3, 7}, {-10, 10})).code, codes::corner_too_large);
}

TEST(Corners, ATangentPointNeverLiesOffItsLine) {
  // The line is shorter than the corner needs; the arc is long enough.
  const CutOutline made = cut(corner({-17, 10}, Point2{-10, 2.7}, 5, {}, {0, -1}));
  EXPECT_EQ(made.corners.at(0).outcome, CornerOutcome::sharp);
  EXPECT_GT(made.corners.at(0).largest.mm(), 0.0);
  const Requested again = corner({-17, 10}, Point2{-10, 2.7}, made.corners[0].largest.mm(), {}, {0, -1});
  EXPECT_EQ(cut(again).corners.at(0).outcome, CornerOutcome::smoothed);
}

TEST(Corners, RequestsAtOpenEndsAreIgnoredWithAWarning) {
  Requested outline = corner({-10, 0}, {}, 1, {}, {0, 10});
  outline.corners[0] = mm(3);
  EXPECT_EQ(diagnostic_of(outline).code, codes::outline_end_request);
  outline = square(10, 1);
  outline.corners.push_back(mm(3));
  EXPECT_EQ(diagnostic_of(outline).code, codes::outline_end_request);
  EXPECT_EQ(outline.corners.back(), mm(3));
}

TEST(Corners, AStraightArcBecomesALineWithAWarning) {
  const Requested outline = corner({-10, 0}, Point2{-5, 0}, 1, {}, {0, 10});
  EXPECT_EQ(diagnostic_of(outline).code, codes::outline_arc_straight);
  EXPECT_EQ(cut(outline).outline.segments.size(), 3u);
}

TEST(Corners, MalformedOutlinesAreRefusedByElement) {
  EXPECT_EQ(diagnostic_of({}).code, codes::outline_malformed);
  Requested outline = square(10, 1);
  outline.outline.segments[2].to.x = std::nan("");
  const Diagnostic d = diagnostic_of(outline);
  EXPECT_EQ(d.code, codes::outline_not_finite);
  EXPECT_NE(d.message.find("\"plate\", element 3"), std::string::npos) << d.message;
  outline = square(10, 1);
  outline.corners[2] = mm(std::numeric_limits<double>::infinity());
  EXPECT_EQ(diagnostic_of(outline).code, codes::outline_not_finite);
  EXPECT_EQ(diagnostic_of(corner({0, 0}, Point2{5, 5}, 0, {}, {0, 10})).code,
            codes::outline_arc_undetermined);
}

TEST(Corners, ScalingEverythingScalesTheResult) {
  const Requested small = square(10, 2);
  CornerOptions options;
  const Outline one = cut(small, options).outline;
  const Placement scale{{}, {1e-3, 1e-3}};
  Requested tiny{placed(small.outline, scale), small.corners};
  for (Length& request : tiny.corners) request = 1e-3 * request;
  options.tolerance.weld = 1e-3 * options.tolerance.weld;
  const Outline other = cut(tiny, options).outline;
  ASSERT_EQ(one.segments.size(), other.segments.size());
  for (std::size_t i = 0; i < one.segments.size(); ++i)
    expect_point(1e3 * other.segments[i].to, one.segments[i].to);
}

TEST(Transforms, MirroringKeepsTheSenseAndReversingTwiceGivesTheSame) {
  const Outline outline = corner({-17, 10}, Point2{-10, 2.7}, 5, {}, {0, -1}).outline;
  const Outline plate = square(10, 2).outline;
  EXPECT_EQ(reversed(reversed(outline)), outline);
  EXPECT_EQ(reversed(reversed(plate)), plate);
  const Outline mirrored = placed(plate, {{100, 0}, {-1, 1}});
  expect_point(mirrored.point(1), {100, 10});
  EXPECT_TRUE(closed(outline).closed());
}

TEST(Transforms, RequestsStayWithTheirCorners) {
  // The corner at (10, 0) is element 1 of the plate, and the one before the end of its reverse.
  const Outline plate = square(10, 0).outline, open = corner({-17, 10}, {}, 0, {}, {0, -1}).outline;
  EXPECT_EQ(reversed(CornerRequests{mm(7), mm(1), mm(2), mm(3)}, plate),
            (CornerRequests{mm(7), mm(3), mm(2), mm(1), Length()}));
  EXPECT_EQ(reversed(CornerRequests{mm(7), mm(1)}, open), (CornerRequests{Length(), mm(1), mm(7)}));
}

TEST(Transforms, ACurveTurnsItsTangents) {
  const Curve curve{{{0, 0}, radians(0.5)}, {{10, 0}, radians(-0.5)}};
  const Curve turned = rotated(curve, {0, 0}, degrees(90));
  EXPECT_NEAR(turned[0].heading.rad(), 0.5 + std::numbers::pi / 2, kNear);
  const Curve back = reversed(curve);
  EXPECT_NEAR(back[0].heading.rad(), std::numbers::pi - 0.5, kNear);
  // Mirroring in x reverses its direction, so its order is reversed: the shape stays.
  const Curve mirrored = placed(curve, {{0, 0}, {-1, 1}});
  expect_point(mirrored[0].at, {-10, 0});
  EXPECT_NEAR(mirrored[0].heading.rad(), 0.5, kNear);
}

TEST(Transforms, ACircleIsScaledWithItsFigure) {
  EXPECT_EQ(placed(Circle{{5, 7}, mm(3)}, {{0, 0}, {2, -2}}), (Circle{{10, -14}, mm(6)}));
}

// ---- curves

Curve circle_samples(double r, int count) {
  Curve curve;
  for (int i = 0; i <= count; ++i) {
    const double t = 2.0 * std::numbers::pi * (i % count) / count;
    curve.push_back({{r * std::cos(t), r * std::sin(t)}, radians(t + std::numbers::pi / 2)});
  }
  return curve;
}

TEST(Curves, SamplesOfACircleGiveArcsOfItsRadius) {
  for (const int count : {4, 12, 499, 501, 900}) {  // the original fails beyond 499
    Diagnostics diagnostics;
    const auto made = smooth_curve(circle_samples(10, count), {}, diagnostics);
    ASSERT_TRUE(made) << count;
    EXPECT_EQ(made->segments.size(), 2u * static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < made->segments.size(); ++i) {
      const auto arc = arc_circle(made->point(i), made->segments[i]);
      ASSERT_TRUE(arc);
      EXPECT_NEAR(arc->radius, 10.0, 1e-5);
    }
  }
}

TEST(Curves, AClosedCurveWithoutTangentsIsSmoothAtItsSeam) {
  std::vector<Point2> points;
  for (const CurvePoint& p : circle_samples(10, 6)) points.push_back(p.at);
  points.back() = points.front();
  Diagnostics diagnostics;
  const auto curve = guess_headings(points, {}, diagnostics);
  ASSERT_TRUE(curve);
  const auto made = smooth_curve(*curve, {}, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->segments.size(), 12u);
  EXPECT_TRUE(made->closed());
  EXPECT_EQ(diagnostics.warnings(), 0u);
}

Code code_of_curve(const Curve& curve, CurveOptions options = {}) {
  Diagnostics diagnostics;
  smooth_curve(curve, options, diagnostics);
  EXPECT_FALSE(diagnostics.list().empty());
  return diagnostics.list().empty() ? Code{} : diagnostics.list()[0].code;
}

TEST(Curves, EachErrorHasItsCode) {
  EXPECT_EQ(code_of_curve({{{0, 0}, {}}}), codes::curve_malformed);
  EXPECT_EQ(code_of_curve({{{0, 0}, {}}, {{0, 0}, {}}}), codes::curve_malformed);
  EXPECT_EQ(code_of_curve({{{0, 0}, radians(2)}, {{10, 0}, radians(-0.5)}}), codes::curve_turns_fast);
  EXPECT_EQ(code_of_curve({{{0, 0}, radians(1.2)}, {{10, 0}, radians(-0.5)}}), codes::curve_turns_much);
  EXPECT_EQ(code_of_curve({{{0, 0}, radians(0.001)}, {{10, 0}, radians(-0.5)}}), codes::curve_piece_straight);
  EXPECT_EQ(code_of_curve({{{0, 0}, radians(0.5)}, {{10, 0}, radians(0.5)}}), codes::curve_inflexion);
  EXPECT_EQ(code_of_curve({{{0, 0}, radians(0.5)}, {{10, 0}, radians(-0.5)}}, {.min_radius = mm(50)}),
            codes::curve_radius_small);
  EXPECT_EQ(code_of_curve({{{0, std::nan("")}, {}}, {{10, 0}, {}}}), codes::outline_not_finite);
  Diagnostics diagnostics;
  EXPECT_FALSE(guess_headings({{0, 0}, {10, 0}, {2, 4}}, {}, diagnostics));
  EXPECT_EQ(diagnostics.list()[0].code, codes::curve_turns_fast);
}

TEST(Curves, ManySharpCornersGiveFewMessages) {
  Outline outline;
  for (int i = 1; i <= 2000; ++i) outline.segments.push_back({{1.0 * i, i % 2 == 0 ? 0.0 : 1.0}});
  CornerRequests corners(2000, mm(50));
  corners.front() = Length();
  Diagnostics diagnostics;
  ASSERT_TRUE(cut_corners(outline, corners, {}, diagnostics));
  EXPECT_EQ(diagnostics.warnings(), 1999u);
  EXPECT_LE(diagnostics.list().size(), 50u);
}

TEST(OutlineMeasures, PointsAtALength) {
  // A line of 10 and a quarter circle of radius 2 to the left.
  const Outline path{{0, 0}, {{{10, 0}, {}}, {{12, 2}, Point2{10 + std::sqrt(2.0), 2 - std::sqrt(2.0)}}}};
  EXPECT_EQ(at_length(path, mm(4)).at, (Point2{4, 0}));
  EXPECT_NEAR(at_length(path, mm(4)).heading.deg(), 0.0, 1e-12);
  const CurvePoint half = at_length(path, mm(10 + 0.5 * std::numbers::pi));
  EXPECT_NEAR(half.at.x, 10 + std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(half.at.y, 2 - std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(half.heading.deg(), 45.0, 1e-9);
  EXPECT_EQ(at_length(path, mm(100)).at, (Point2{12, 2}));
  EXPECT_NEAR(at_length(path, mm(100)).heading.deg(), 90.0, 1e-9);
  EXPECT_EQ(at_length(path, mm(-1)).at, (Point2{0, 0}));
}

TEST(OutlineMerging, JoinsLinesAndArcsOfOneCarrier) {
  const Outline steps{
      {0, 0}, {{{4, 0}, {}}, {{10, 0}, {}}, {{10, 5}, {}}, {{10, 10}, {}}, {{0, 10}, {}}, {{0, 0}, {}}}};
  const Outline square = merged(steps, mm(1e-6));
  EXPECT_EQ(square.segments.size(), 4u);
  EXPECT_NEAR(area(square), 100.0, 1e-12);
  // A start within a side moves to a corner.
  const Outline inside_side{{5, 0}, {{{10, 0}, {}}, {{10, 10}, {}}, {{0, 0}, {}}, {{5, 0}, {}}}};
  EXPECT_EQ(merged(inside_side, mm(1e-6)).segments.size(), 3u);
  EXPECT_TRUE(merged(inside_side, mm(1e-6)).closed());
  // Eight arcs of one circle.
  Outline circle{{5, 0}, {}};
  for (int i = 1; i <= 8; ++i) {
    const auto on = [](double eighths) {
      return Point2{5 * std::cos(0.25 * std::numbers::pi * eighths),
                    5 * std::sin(0.25 * std::numbers::pi * eighths)};
    };
    circle.segments.push_back({i == 8 ? circle.start : on(i), on(i - 0.5)});
  }
  const Outline two = merged(circle, mm(1e-6));
  EXPECT_EQ(two.segments.size(), 2u);
  EXPECT_NEAR(area(two), 25.0 * std::numbers::pi, 1e-9);
  // A corner of more than the distance and a line that turns back stay.
  const Outline shallow{{0, 0}, {{{5, 0.01}, {}}, {{10, 0}, {}}}};
  EXPECT_EQ(merged(shallow, mm(0.001)).segments.size(), 2u);
  EXPECT_EQ(merged(shallow, mm(0.02)).segments.size(), 1u);
  const Outline back{{0, 0}, {{{5, 0}, {}}, {{3, 0}, {}}}};
  EXPECT_EQ(merged(back, mm(1)).segments.size(), 2u);
}

}  // namespace
}  // namespace kerf

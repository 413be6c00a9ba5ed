// Arcs in parts: the sweeps of all parts sum to that of the arc, and nothing becomes a whole turn.
#include "path/arc_parts.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace kerf {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// The length in the plane of a path from `from`, by the definition of its steps.
double length_of(const Toolpath& path, Point3 from) {
  double sum = 0.0;
  for (const Step& s : path.steps()) {
    if (s.kind() == StepKind::arc) {
      const ArcWalk walk = walk_of(s, from);
      sum += std::abs(walk.sweep) * walk.start_radius;
    } else {
      sum += distance(from.xy(), s.to().xy());
    }
    from = s.to();
  }
  return sum;
}

TEST(ArcParts, SweepsSumToThatOfTheArc) {
  std::mt19937_64 random(3);
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int run = 0; run < 2000; ++run) {
    const double radius = in(0.5, 50), start = in(-4, 4), sweep = run % 3 == 0 ? kTurn : in(0.001, kTurn);
    const bool ccw = run % 2 == 0;
    const int turns = run % 5 == 0 ? 2 : 0;
    const auto at = [&](double angle, double z) {
      return Point3{radius * std::cos(angle), radius * std::sin(angle), z};
    };
    const Point3 from = at(start, 0);
    step::Arc arc;
    arc.to = sweep == kTurn ? from : at(start + (ccw ? sweep : -sweep), -1);
    arc.turn = ccw ? Turn::ccw : Turn::cw, arc.extra_turns = turns, arc.feed = mm_per_min(100);
    const ArcWalk walk = walk_arc(from, arc.to, arc.centre, arc.plane, arc.turn, arc.extra_turns);
    // Divided anywhere, also twice at almost the same position and near the ends.
    std::vector<double> ts{0.0, 1.0};
    for (int k = 0; k < 6; ++k) {
      const double t = k == 0 ? 1e-16 : k == 1 ? 1.0 - 1e-16 : in(0, 1);
      ts.push_back(t);
      if (k % 2 == 0) ts.push_back(std::nextafter(t, 1.0));
      if (k == 3) ts.push_back(std::min(t + 1e-11, 1.0));
    }
    std::sort(ts.begin(), ts.end());
    Toolpath made;
    Point3 here = from;
    for (std::size_t k = 1; k < ts.size(); ++k) {
      const Point3 to = ts[k] >= 1.0 ? arc.to : walk.at(ts[k]);
      add_part(made, arc_part(arc, walk, ts[k - 1], ts[k], here, to), OriginId::none);
      here = to;
    }
    EXPECT_NEAR(length_of(made, from), std::abs(walk.sweep) * radius, 1e-6) << run;
    EXPECT_LT(distance(here, arc.to), 1e-9);
  }
}

TEST(ArcParts, NoTurnIsMadeOfNothing) {
  step::Arc arc;
  arc.to = {0, 10, 0};
  const Point3 from{10, 0, 0};
  const ArcWalk walk = walk_arc(from, arc.to, {}, Plane::xy, Turn::ccw, 0);
  const Point3 halfway = walk.at(0.5);
  EXPECT_EQ(arc_part(arc, walk, 0.5, 0.5, halfway, halfway).index(), 0u);
  const ArcPart rise = arc_part(arc, walk, 0.5, 0.5, halfway, {halfway.x, halfway.y, 3});
  ASSERT_TRUE(std::holds_alternative<step::Cut>(rise));
  EXPECT_EQ(std::get<step::Cut>(rise).to.z, 3);
}

TEST(ArcParts, UnknownHeightsAreNotInvented) {
  Toolpath path;
  path.add(step::Arc{.to = {0, 10, -1}, .centre = {}, .feed = mm_per_min(100)}, OriginId::none);
  PathPosition from{{10, 0, -10}, 0};
  EXPECT_TRUE(can_be_divided(path[0], from));
  from.unknown = 4;  // as after a probe
  EXPECT_FALSE(can_be_divided(path[0], from));
  path.set_unknown_axes(0, 4);
  EXPECT_FALSE(can_be_divided(path[0], from));  // by a distance from an unknown height
  from.at.z = -1;
  EXPECT_TRUE(can_be_divided(path[0], from));  // level, at an unknown height
  from.unknown = 1;
  EXPECT_FALSE(can_be_divided(path[0], from));
}

}  // namespace
}  // namespace kerf

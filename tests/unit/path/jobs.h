// Tools and single-motion jobs for the simulator's tests: silhouettes given as knots, so that these tests
// depend on nothing else.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "kerf/path/toolpath.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf::test {

inline constexpr double kQuarter = 0.41421356237309503;  // bulge of a quarter circle

struct NamedProfile {
  std::string name;
  Profile profile;
};

inline Profile profile(std::vector<Knot> knots) { return Profile{std::move(knots)}; }

/// A ball of radius r on a tangent cone of half angle a that reaches radius R.
inline Profile tapered_ball(double r, double a, double R) {
  const double touch_r = r * std::cos(a), touch_z = r - r * std::sin(a);
  const double sweep = std::numbers::pi / 2 - a;
  return profile(
      {{0, 0, std::tan(sweep / 4)}, {touch_r, touch_z, 0}, {R, touch_z + (R - touch_r) / std::tan(a), 0}});
}

inline std::vector<NamedProfile> all_profiles() {
  return {
      {"square", profile({{0, 0, 0}, {3, 0, 0}, {3, 12, 0}})},
      {"ball", profile({{0, 0, kQuarter}, {3, 3, 0}, {3, 12, 0}})},
      {"bull_nose", profile({{0, 0, 0}, {2, 0, kQuarter}, {3, 1, 0}, {3, 12, 0}})},
      {"bowl", profile({{0, 0, 0}, {1, 0, kQuarter}, {5, 4, 0}, {5, 12, 0}})},
      {"vee", profile({{0, 0, 0}, {4, 4, 0}, {4, 12, 0}})},
      {"flat_vee", profile({{0, 0, 0}, {1, 0, 0}, {4, 5, 0}})},
      {"tapered_ball", tapered_ball(0.8, 0.2, 2.5)},
      {"keyhole", profile({{0, 0, 0}, {4, 0, 0}, {4, 2.5, 0}, {2, 2.5, 0}, {2, 6, 0}})},
      {"dovetail", profile({{0, 0, 0}, {5, 0, 0}, {3, 7, 0}})},
      {"roundover", profile({{0, 0, 0}, {0.5, 0, -kQuarter}, {2.5, 2, 0}, {2.5, 6, 0}})},
      {"thread_mill", profile({{1.5, 0, 0}, {3, 1, 0}, {1.5, 2, 0}, {1.5, 6, 0}})},
      {"lollipop", profile({{0, 0, kQuarter},
                            {3, 3, std::tan(std::acos(0.5) / 4 + 0.0)},
                            {1.5, 3 + 3 * std::sin(std::acos(0.5)), 0},
                            {1.5, 8, 0}})},
      {"t_slot", profile({{0, 0, 0}, {5, 0, 0}, {5, 2, 0}, {1.5, 2, 0}, {1.5, 7, 0}})},
      {"rounded_disc",
       profile({{0, 0, 0}, {3, 0, kQuarter}, {4, 1, kQuarter}, {3, 2, 0}, {1, 2, 0}, {1, 7, 0}})},
  };
}

inline Tool make_drawn(int number, Profile cutting) {
  Tool tool;
  tool.number = number;
  tool.silhouette.cutting = std::move(cutting);
  return tool;
}

inline Stock block(Point3 low, Point3 high) {
  Stock stock;
  stock.block.add(low);
  stock.block.add(high);
  return stock;
}

/// Builds toolpaths with one origin.
class Path {
 public:
  Path() : origin_(path_.origins().add(CallLocation{.file = "", .line = 7, .call = "test"})) {}
  Path& tool(int number) { return path_.add(step::ToolChange{number}, origin_), *this; }
  Path& spindle(SpindleTurn turn) { return path_.add(step::Spindle{rpm(9000), turn}, origin_), *this; }
  Path& rapid(Point3 to) { return path_.add(step::Rapid{to}, origin_), *this; }
  Path& cut(Point3 to) { return path_.add(step::Cut{to, mm_per_min(500)}, origin_), *this; }
  Path& arc(step::Arc arc) { return path_.add(arc, origin_), *this; }
  Toolpath& path() { return path_; }
  OriginId origin() const { return origin_; }

 private:
  Toolpath path_;
  OriginId origin_;
};

inline ToolTable square_and_keyhole() {
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 12, 0}})));
  tools.set(2, make_drawn(2, profile({{0, 0, 0}, {4, 0, 0}, {4, 2.5, 0}, {2, 2.5, 0}, {2, 9, 0}})));
  tools.set(3, make_drawn(3, profile({{0, 0, kQuarter}, {2, 2, 0}, {2, 12, 0}})));
  return tools;
}

/// Moves of all kinds with three tools over a block of 50 x 40 x 10 whose top is Z0.
inline Toolpath random_job(unsigned seed, int moves) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() % 100000) / 1e5;
  };
  Path path;
  Point3 at{0, 0, 5};
  path.tool(1).rapid(at);
  for (int k = 0; k < moves; ++k) {
    if (k % 40 == 0) path.tool(1 + (k / 40) % 3);
    const Point3 to{between(-3, 53), between(-3, 43), between(-9, 1)};
    if (k % 7 == 3) {
      path.arc({.to = {to.x, to.y, at.z},
                .centre = {0.5 * (at.x + to.x), 0.5 * (at.y + to.y)},
                .turn = k % 2 == 0 ? Turn::cw : Turn::ccw,
                .feed = mm_per_min(100)});
      at = {to.x, to.y, at.z};
      continue;
    }
    if (k % 11 == 5) {
      path.rapid(to);
    } else {
      path.cut(to);
    }
    at = to;
  }
  return path.path();
}

}  // namespace kerf::test

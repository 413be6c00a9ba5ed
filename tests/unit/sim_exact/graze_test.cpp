// Grazes: planted hazards 0.02 mm deep, each with a near miss that has 0.02 mm of clearance instead. The
// position of the tool follows from the dimensions of tool, block and earlier cuts by hand.
#include <fmt/format.h>
#include <functional>
#include <gtest/gtest.h>
#include <set>

#include "../sim_cut/cut_jobs.h"
#include "sim/exact/grazes.h"

namespace kerf::test {
namespace {

constexpr double kGraze = 0.02;  // mm, above the depth of 0.01 mm that is reported
const Stock kBlock = block({0, 0, -12}, {100, 60, 0});

Profile cylinder(double radius, double bottom, double top) {
  return profile({{radius, bottom, 0}, {radius, top, 0}});
}
Profile square(double diameter, double flute) {
  return profile({{0, 0, 0}, {diameter / 2, 0, 0}, {diameter / 2, flute, 0}});
}

/// A job that touches the material by `depth`, or is clear of it by -depth.
struct Planted {
  std::string name;
  HazardKind kind;
  std::function<Toolpath(double depth)> path;
  ToolTable tools;
};

ToolTable table(Tool tool) {
  ToolTable tools;
  tools.set(1, std::move(tool));
  return tools;
}

Path started() {
  Path path;
  path.tool(1).spindle(SpindleTurn::cw);
  return path;
}

/// A rapid from a to b at depth, and up.
void low_rapid(Path& path, Point2 a, Point2 b, double z) {
  path.rapid({a.x, a.y, 5}).rapid({a.x, a.y, z}).rapid({b.x, b.y, z}).rapid({b.x, b.y, 5});
}

/// Rapids along the four sides of the block, by tools of several diameters.
void add_sides(std::vector<Planted>& all) {
  for (const double d : {0.6, 3.175, 6.0, 12.7, 50.0})
    for (int side = 0; side < 4; ++side) {
      const auto path = [d, side](double depth) {
        const double away = d / 2 - depth, far = d + 20;  // of the axis from the side
        Path made = started();
        if (side == 0) low_rapid(made, {-far, -away}, {100 + far, -away}, -3);
        if (side == 1) low_rapid(made, {-far, 60 + away}, {100 + far, 60 + away}, -3);
        if (side == 2) low_rapid(made, {-away, -far}, {-away, 60 + far}, -11.5);
        if (side == 3) low_rapid(made, {100 + away, 60 + far}, {100 + away, -far}, -0.5);
        return made.path();
      };
      all.push_back({fmt::format("side {} with d {}", side, d), HazardKind::rapid_in_stock, path,
                     table(make_drawn(1, square(d, 30)))});
    }
}

/// Rapids past a vertical edge of the block, at several angles.
void add_edges(std::vector<Planted>& all) {
  for (const double degrees : {20.0, 45.0, 71.0})
    for (int edge = 0; edge < 4; ++edge) {
      const auto path = [degrees, edge](double depth) {
        const double sx = edge % 2 == 0 ? -1.0 : 1.0, sy = edge < 2 ? -1.0 : 1.0;
        const Point2 corner{sx < 0 ? 0.0 : 100.0, sy < 0 ? 0.0 : 60.0};
        const double a = degrees * std::numbers::pi / 180.0;
        const Point2 out{sx * std::cos(a), sy * std::sin(a)}, along{-out.y, out.x};
        const Point2 nearest = corner + (3.0 - depth) * out;
        Path made = started();
        low_rapid(made, nearest + -40.0 * along, nearest + 40.0 * along, -4);
        return made.path();
      };
      all.push_back({fmt::format("edge {} at {}", edge, degrees), HazardKind::rapid_in_stock, path,
                     table(make_drawn(1, square(6, 30)))});
    }
}

/// Rapids that end just inside a side.
void add_ends(std::vector<Planted>& all) {
  for (int side = 0; side < 4; ++side) {
    const auto path = [side](double depth) {
      const double away = 3.0 - depth;
      Path made = started();
      if (side == 0) low_rapid(made, {-30, 21.7}, {-away, 21.7}, -3);
      if (side == 1) low_rapid(made, {130, 21.7}, {100 + away, 21.7}, -3);
      if (side == 2) low_rapid(made, {33.3, -30}, {33.3, -away}, -3);
      if (side == 3) low_rapid(made, {50, 90}, {33.3, 60 + away}, -3);
      return made.path();
    };
    all.push_back({fmt::format("end at side {}", side), HazardKind::rapid_in_stock, path,
                   table(make_drawn(1, square(6, 30)))});
  }
}

/// Rapids along a wall of a slot that a wider tool has cut.
void add_slots(std::vector<Planted>& all) {
  for (const double degrees : {0.0, 30.0, 45.0, 90.0, 118.0})
    for (const double side : {-1.0, 1.0}) {
      const auto path = [degrees, side](double depth) {
        const double a = degrees * std::numbers::pi / 180.0;
        const Point2 along{std::cos(a), std::sin(a)}, across{-along.y, along.x}, centre{50, 30};
        const Point2 from = centre + -12.0 * along, to = centre + 12.0 * along;
        const Point2 shift = side * (5.0 - 3.0 + depth) * across;
        Path made = started();
        made.rapid({from.x, from.y, 5})
            .cut({from.x, from.y, -6})
            .cut({to.x, to.y, -6})
            .rapid({to.x, to.y, 5});
        made.tool(2).rapid({from.x + shift.x, from.y + shift.y, 5});
        made.rapid({from.x + shift.x, from.y + shift.y, -5.5});
        made.rapid({to.x + shift.x, to.y + shift.y, -5.5});
        made.rapid({to.x + shift.x, to.y + shift.y, 5});
        return made.path();
      };
      ToolTable tools = table(make_drawn(1, square(10, 30)));
      tools.set(2, make_drawn(2, square(6, 30)));
      all.push_back(
          {fmt::format("slot at {} side {}", degrees, side), HazardKind::rapid_in_stock, path, tools});
    }
}

/// A shank or holder beside the block or the wall of a pocket, above flutes that do not touch it.
void add_shanks(std::vector<Planted>& all) {
  for (const bool holder : {false, true})
    for (int side = 0; side < 4; ++side) {
      Tool tool = make_drawn(1, square(6, 4));
      (holder ? tool.silhouette.holder : tool.silhouette.shank) = cylinder(5, 4, 30);
      const auto path = [side](double depth) {
        const double away = 5.0 - depth;
        Path made = started();
        const auto cut = [&](Point2 a, Point2 b) {
          made.rapid({a.x, a.y, 5}).cut({a.x, a.y, -7}).cut({b.x, b.y, -7}).rapid({b.x, b.y, 5});
        };
        if (side == 0) cut({-20, -away}, {120, -away});
        if (side == 1) cut({-20, 60 + away}, {120, 60 + away});
        if (side == 2) cut({-away, -20}, {-away, 80});
        if (side == 3) cut({100 + away, -20}, {100 + away, 80});
        return made.path();
      };
      all.push_back({fmt::format("{} at side {}", holder ? "holder" : "shank", side),
                     holder ? HazardKind::holder_contact : HazardKind::shank_contact, path, table(tool)});
    }
}

/// A V at the height where its flank reaches the side, and a ball.
void add_tapered(std::vector<Planted>& all) {
  for (const double half_angle : {15.0, 30.0, 45.0}) {
    const double slope = std::tan(half_angle * std::numbers::pi / 180.0);
    const Tool tool = make_drawn(1, profile({{0, 0, 0}, {20 * slope, 20, 0}}));
    for (int side = 0; side < 2; ++side)
      all.push_back({fmt::format("V of {} at side {}", half_angle, side), HazardKind::rapid_in_stock,
                     [slope, side](double depth) {
                       // At Z0 a tip at Z-2 has the radius 2 * slope. The depth is perpendicular to the
                       // flank.
                       const double cosine = 1.0 / std::hypot(1.0, slope);
                       const double away = 2.0 * slope - 3.0 * depth / cosine;
                       Path made = started();
                       if (side == 0) low_rapid(made, {-20, -away}, {120, -away}, -2);
                       if (side == 1) low_rapid(made, {100 + away, -20}, {100 + away, 80}, -2);
                       return made.path();
                     },
                     table(tool)});
  }
}

std::vector<Planted> planted() {
  std::vector<Planted> all;
  add_sides(all);
  add_edges(all);
  add_ends(all);
  add_slots(all);
  add_shanks(all);
  add_tapered(all);
  return all;
}

/// Kinds of the hazards of columns and of grazes; several motions may touch.
std::set<HazardKind> kinds(const Planted& job, double depth, double pitch) {
  Diagnostics diagnostics;
  const auto simulation = run(job.path(depth), job.tools, kBlock, pitch, diagnostics);
  EXPECT_TRUE(simulation);
  std::set<HazardKind> found;
  for (const Hazard& h : simulation->hazards) found.insert(h.kind);
  for (const Hazard& h : find_grazes(*simulation)) found.insert(h.kind);
  return found;
}

TEST(Grazes, SixtyPlantedHazardsAreFoundAndSixtyNearMissesAreSilent) {
  const auto all = planted();
  ASSERT_GE(all.size(), 60u);
  for (const double pitch : {0.11, 1.0})
    for (const Planted& job : all) {
      EXPECT_EQ(kinds(job, kGraze, pitch), std::set{job.kind}) << job.name << " at " << pitch;
      EXPECT_EQ(kinds(job, -kGraze, pitch), std::set<HazardKind>{}) << job.name << " at " << pitch;
      EXPECT_EQ(kinds(job, 0.0, pitch), std::set<HazardKind>{}) << job.name << " touching, at " << pitch;
    }
}

TEST(Grazes, APathInItsOwnCutIsSilent) {
  Path path = started();
  path.rapid({10, 10, 5}).cut({10, 10, -5}).cut({50, 20, -5});
  path.arc({.to = {50, 40, -5}, .centre = {50, 30}, .turn = Turn::ccw, .feed = mm_per_min(100)});
  path.rapid({50, 40, 5}).rapid({50, 20, 5}).rapid({50, 20, -5}).rapid({10, 10, -5}).rapid({10, 10, 5});
  Diagnostics diagnostics;
  const auto simulation = run(path.path(), table(make_drawn(1, square(6, 30))), kBlock, 0.5, diagnostics);
  ASSERT_TRUE(simulation);
  EXPECT_TRUE(simulation->hazards.empty());
  EXPECT_TRUE(find_grazes(*simulation).empty());
}

TEST(Grazes, AShankAsWideAsItsFlutesFollowsThem) {
  Path path = started();
  path.rapid({10, 30, 5}).cut({10, 30, -9.5}).cut({40, 30, -9.5}).rapid({40, 30, 5});
  Tool tool = make_drawn(1, square(6, 9));
  tool.silhouette.shank = cylinder(3, 9, 40);
  Diagnostics diagnostics;
  const auto simulation = run(path.path(), table(tool), kBlock, 0.5, diagnostics);
  ASSERT_TRUE(simulation);
  EXPECT_TRUE(find_grazes(*simulation).empty());
}

TEST(Grazes, ThinToolsAreFoundBetweenWideColumns) {
  Path path = started();
  low_rapid(path, {-10, 30.2}, {110, 30.2}, -5);
  Diagnostics diagnostics;
  const auto simulation = run(path.path(), table(make_drawn(1, square(0.6, 30))), kBlock, 1.0, diagnostics);
  ASSERT_TRUE(simulation);
  const auto found = find_grazes(*simulation);
  ASSERT_EQ(simulation->hazards.size() + found.size(), 1u);
  if (!found.empty()) {
    EXPECT_NEAR(found[0].depth.mm(), 5.0, 0.05);
  }
}

TEST(Grazes, AreNotSearchedBeyondTheLimit) {
  Path path = started();
  path.rapid({10, 30, 5}).cut({10, 30, -5}).cut({90, 30, -5}).rapid({90, 30, 5});
  path.rapid({90, 32.02, 5}).rapid({90, 32.02, -5}).rapid({10, 32.02, -5}).rapid({10, 32.02, 5});
  Diagnostics diagnostics;
  const auto simulation = run(path.path(), table(make_drawn(1, square(6, 30))), kBlock, 1.0, diagnostics);
  ASSERT_TRUE(simulation);
  GrazeOptions options;
  options.max_distances = 1;
  EXPECT_LE(find_grazes(*simulation, options).size(), 1u);
}

}  // namespace
}  // namespace kerf::test

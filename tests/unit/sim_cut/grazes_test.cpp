// No false and no missed hazards: every kind of hazard a hundredth of a millimetre before and beyond its
// limit in depth, and one column before and beyond it sideways, for every motion that can cause it.
#include <gtest/gtest.h>

#include "../stock/solids.h"
#include "cut_jobs.h"

#include "kerf/sim/simulate.h"
#include "kerf/stock/stock.h"

namespace kerf::test {
namespace {

constexpr double kPitch = 0.1;
constexpr double kHair = 0.01;  // mm
constexpr double kBlockZ = 20;  // the block is 60 x 40 x 20 with its top at Z0

enum class Travel { line, back, across, plunge, slope, arc, dip };
const char* name_of(Travel travel) {
  constexpr const char* kNames[] = {"line", "back", "across", "plunge", "slope", "arc", "dip"};
  return kNames[static_cast<int>(travel)];
}

enum class Speed { feed, rapid };

/// A motion whose extreme position is `tip`: the lowest of all, and of arcs the highest in Y.
void travel_to(Path& path, Travel travel, Speed speed, Point3 tip) {
  const auto go = [&](Point3 to) { speed == Speed::feed ? path.cut(to) : path.rapid(to); };
  const auto from = [&](Point3 to) { path.rapid({to.x, to.y, 70}).rapid(to); };
  const auto [x, y, z] = tip;
  switch (travel) {
    case Travel::line: from({-40, y, z}), go({100, y, z}); break;
    case Travel::back: from({100, y, z}), go({-40, y, z}); break;
    case Travel::across: from({x, -40, z}), go({x, y, z}); break;
    case Travel::plunge: from({x, y, 60}), go(tip); break;
    case Travel::slope: from({x - 60, y, z + 15}), go(tip); break;
    case Travel::arc:
      from({x, y - 80, z});
      path.arc({.to = tip, .centre = {x, y - 40}, .turn = Turn::ccw, .feed = mm_per_min(100)});
      break;
    case Travel::dip:
      from({x - 40, y, z + 40});
      path.arc({.to = {x + 40, y, z + 40},
                .centre = {x, z + 40},
                .plane = Plane::xz,
                .turn = Turn::cw,
                .feed = mm_per_min(100)});
      break;
  }
}

/// Flutes of 2 mm, 10 long, and the parts of a case above them.
Tool slim(const Profile& neck, const Profile& shank, const Profile& holder) {
  Tool tool = make_drawn(1, profile({{0, 0, 0}, {1, 0, 0}, {1, 10, 0}}));
  tool.silhouette.neck = neck;
  tool.silhouette.shank = shank;
  tool.silhouette.holder = holder;
  return tool;
}
Profile cylinder(double radius, double low, double high) {
  return profile({{radius, low, 0}, {radius, high, 0}});
}
Tool with_neck() { return slim(cylinder(3, 10, 20), {}, {}); }
Tool with_shank() { return slim({}, cylinder(4, 10, 60), {}); }
Tool with_holder() { return slim({}, cylinder(1, 10, 15), cylinder(12, 15, 60)); }
Tool flutes_only() { return make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 5, 0}})); }
Tool ball() { return make_drawn(1, profile({{0, 0, kQuarter}, {3, 3, 0}, {3, 12, 0}})); }

/// A limit and the motions to it. The distance `beyond` it is applied along `axis`: 2 deeper, 1 sideways in
/// Y.
struct Limit {
  const char* name;
  HazardKind kind;
  Tool tool;
  Speed speed;
  Point3 tip;  // of the tip at the limit
  int axis;
  double depth;  // of the contact just beyond it; 0: equal to `beyond`
  std::vector<Travel> travels;
  bool has_slot = false;  // 4 wide along X at Y20, through the block
  bool spindle_off = false;
};

std::vector<Limit> limits() {
  using T = Travel;
  constexpr auto kRapid = HazardKind::rapid_in_stock;
  const std::vector<T> rapids{T::line, T::back, T::across, T::plunge, T::slope};
  const std::vector<T> feeds{T::line, T::back, T::plunge, T::slope, T::arc, T::dip};
  const std::vector<T> level{T::line, T::back, T::arc};
  const std::vector<T> in_slot{T::line, T::back, T::plunge, T::slope, T::dip};
  const std::vector<T> rapids_in_slot{T::line, T::back, T::plunge, T::slope};
  const std::vector<T> along{T::line, T::back, T::plunge, T::arc};
  const std::vector<T> rapids_along{T::line, T::back, T::plunge, T::across};
  constexpr auto kFeed = Speed::feed;
  constexpr auto kFast = Speed::rapid;
  return {
      // In depth.
      {"rapid, flutes", kRapid, flutes_only(), kFast, {30, 20, 0}, 2, 0, rapids},
      {"rapid, ball", kRapid, ball(), kFast, {30, 20, 0}, 2, 0, rapids},
      {"rapid, neck", kRapid, with_neck(), kFast, {30, 20, -10}, 2, 0, rapids_in_slot, true},
      {"rapid, shank", kRapid, with_shank(), kFast, {30, 20, -10}, 2, 0, rapids_in_slot, true},
      {"rapid, holder", kRapid, with_holder(), kFast, {30, 20, -15}, 2, 0, rapids_in_slot, true},
      {"neck", HazardKind::neck_contact, with_neck(), kFeed, {30, 20, -10}, 2, 0, in_slot, true},
      {"shank", HazardKind::shank_contact, with_shank(), kFeed, {30, 20, -10}, 2, 0, in_slot, true},
      {"holder", HazardKind::holder_contact, with_holder(), kFeed, {30, 20, -15}, 2, 0, in_slot, true},
      {"over flute", HazardKind::over_flute, flutes_only(), kFeed, {30, 20, -5}, 2, 0, level},
      {"below floor", HazardKind::below_floor, slim({}, {}, {}), kFeed, {30, 20, -20}, 2, 0, in_slot, true},
      {"spindle", HazardKind::spindle_off, flutes_only(), kFeed, {30, 20, 0}, 2, 0, feeds, false, true},
      // Sideways, beside the block.
      {"rapid beside, flutes", kRapid, flutes_only(), kFast, {30, -3, -4}, 1, 4, rapids_along},
      {"rapid beside, above the flutes", kRapid, flutes_only(), kFast, {30, -3, -40}, 1, 20, rapids_along},
      {"rapid beside, neck", kRapid, with_neck(), kFast, {30, -3, -16}, 1, 6, rapids_along},
      {"rapid beside, shank", kRapid, with_shank(), kFast, {30, -4, -16}, 1, 6, rapids_along},
      {"rapid beside, holder", kRapid, with_holder(), kFast, {30, -12, -16}, 1, 1, rapids_along},
      {"neck beside", HazardKind::neck_contact, with_neck(), kFeed, {30, -3, -16}, 1, 6, along},
      {"shank beside", HazardKind::shank_contact, with_shank(), kFeed, {30, -4, -16}, 1, 6, along},
      {"holder beside", HazardKind::holder_contact, with_holder(), kFeed, {30, -12, -16}, 1, 1, along},
      {"over flute beside", HazardKind::over_flute, flutes_only(), kFeed, {30, -3, -8}, 1, 3, level},
      {"spindle beside",
       HazardKind::spindle_off,
       flutes_only(),
       kFeed,
       {30, -3, -4},
       1,
       4,
       along,
       false,
       true},
      // Sideways, in a slot narrower than the shank by 1: only the shank reaches the wall.
      {"shank in the slot",
       HazardKind::shank_contact,
       slim({}, cylinder(1.5, 10, 60), {}),
       kFeed,
       {30, 20.5, -16},
       1,
       6,
       {T::line, T::back, T::plunge},
       true},
      {"rapid, shank in the slot",
       kRapid,
       slim({}, cylinder(1.5, 10, 60), {}),
       kFast,
       {30, 20.5, -16},
       1,
       6,
       {T::line, T::back, T::plunge},
       true},
  };
}

/// The hazards of a motion that goes `beyond` the limit.
std::vector<Hazard> hazards_beyond(const Limit& limit, Travel travel, double beyond, const Stock& stock) {
  ToolTable tools;
  tools.set(1, limit.tool);
  tools.set(2, make_drawn(2, profile({{0, 0, 0}, {2, 0, 0}, {2, 60, 0}})));
  Path path;
  path.spindle(SpindleTurn::cw);
  if (limit.has_slot) path.tool(2).rapid({-30, 20, 70}).cut({-30, 20, -20}).cut({90, 20, -20});
  path.rapid({-30, 20, 70}).tool(1);
  if (limit.spindle_off) path.spindle(SpindleTurn::off);
  Point3 tip = limit.tip;
  tip[limit.axis] += limit.axis == 2 ? -beyond : beyond;
  travel_to(path, travel, limit.speed, tip);
  Diagnostics diagnostics;
  const auto result = run(path.path(), tools, stock, kPitch, diagnostics);
  EXPECT_TRUE(result) << limit.name;
  return result ? result->hazards : std::vector<Hazard>{};
}

std::string text_of(const std::vector<Hazard>& hazards) {
  std::string text;
  for (const Hazard& h : hazards)
    text += std::string(to_string(h.kind)) + " step " + std::to_string(h.step) + " depth " +
            std::to_string(h.depth.mm()) + "\n";
  return text;
}

void expect_none_before_and_one_beyond(const Stock& stock) {
  for (const Limit& limit : limits()) {
    const double step = limit.axis == 2 ? kHair : kPitch;
    for (const Travel travel : limit.travels) {
      SCOPED_TRACE(testing::Message() << limit.name << ", " << name_of(travel));
      for (const double beyond : {-step, 0.0}) {
        const auto none = hazards_beyond(limit, travel, beyond, stock);
        EXPECT_TRUE(none.empty()) << text_of(none);
      }
      const auto some = hazards_beyond(limit, travel, step, stock);
      ASSERT_EQ(some.size(), 1u) << text_of(some);
      EXPECT_EQ(some[0].kind, limit.kind) << text_of(some);
      EXPECT_NEAR(some[0].depth.mm(), limit.depth > 0 ? limit.depth : kHair, 2e-3);
    }
  }
}

TEST(Grazes, OfABlock) { expect_none_before_and_one_beyond(block({0, 0, -kBlockZ}, {60, 40, 0})); }

TEST(Grazes, OfAMesh) {
  const Triangles mesh = box_mesh({0, 0, -kBlockZ}, {60, 40, 0});
  Diagnostics diagnostics;
  expect_none_before_and_one_beyond(
      stock_of(make_mesh_body(mesh.positions, mesh.triangles, "box.stl", diagnostics)));
}

// ---- fixtures: a box of the size of the block; the tool passes beside and over it

struct FixtureLimit {
  const char* name;
  std::optional<ToolPart> part;
  Tool tool;
  Speed speed;
  Point3 tip;
  int axis;
  double depth;  // see Limit
};

std::vector<FixtureLimit> fixture_limits() {
  const auto edge = ToolPart::cutting, neck = ToolPart::neck, shank = ToolPart::shank,
             holder = ToolPart::holder;
  constexpr auto kFeed = Speed::feed;
  constexpr auto kFast = Speed::rapid;
  return {
      {"edge over it", edge, flutes_only(), kFeed, {30, 20, 0}, 2, 0},
      {"ball over it", edge, ball(), kFeed, {30, 20, 0}, 2, 0},
      {"rapid over it", {}, flutes_only(), kFast, {30, 20, 0}, 2, 0},
      {"edge beside it", edge, flutes_only(), kFeed, {30, -3, -4}, 1, 4},
      {"ball beside it", edge, ball(), kFeed, {30, -3, -4}, 1, 1},
      {"above the flutes beside it", shank, flutes_only(), kFeed, {30, -3, -40}, 1, 20},
      {"neck beside it", neck, with_neck(), kFeed, {30, -3, -16}, 1, 6},
      {"shank beside it", shank, with_shank(), kFeed, {30, -4, -16}, 1, 6},
      {"holder beside it", holder, with_holder(), kFeed, {30, -12, -16}, 1, 1},
      {"rapid beside it, flutes", {}, flutes_only(), kFast, {30, -3, -4}, 1, 4},
      {"rapid beside it, above the flutes", {}, flutes_only(), kFast, {30, -3, -40}, 1, 20},
      {"rapid beside it, shank", {}, with_shank(), kFast, {30, -4, -16}, 1, 6},
      {"rapid beside it, holder", {}, with_holder(), kFast, {30, -12, -16}, 1, 1},
  };
}

std::vector<FixtureContact> contacts_beyond(const FixtureLimit& limit, Travel travel, double beyond,
                                            const Stock& solid) {
  ToolTable tools;
  tools.set(1, limit.tool);
  Path path;
  path.rapid({-30, 20, 70}).tool(1);
  Point3 tip = limit.tip;
  tip[limit.axis] += limit.axis == 2 ? -beyond : beyond;
  travel_to(path, travel, limit.speed, tip);
  Diagnostics diagnostics;
  const auto found =
      find_fixture_contacts(path.path(), tools, std::vector{Fixture{"clamp", solid}}, {}, diagnostics);
  EXPECT_TRUE(found) << limit.name;
  return found.value_or(std::vector<FixtureContact>{});
}

std::vector<Travel> travels_of(const FixtureLimit& limit) {
  using T = Travel;
  std::vector<T> travels{T::line, T::back};
  if (limit.speed == Speed::feed) travels.push_back(T::arc);
  if (limit.axis == 2) travels.push_back(T::slope);
  // A plunge would move the flutes past what the part above them is to touch.
  if (limit.axis == 2 || limit.part != ToolPart::shank) travels.push_back(T::plunge);
  return travels;
}

template <class Travels>
void expect_fixture_reported(const Stock& solid, double sideways, const Travels& travels) {
  for (const FixtureLimit& limit : fixture_limits()) {
    const double step = limit.axis == 2 ? kHair : sideways;
    for (const Travel travel : travels(limit)) {
      SCOPED_TRACE(testing::Message() << limit.name << ", " << name_of(travel));
      for (const double beyond : {-step, 0.0})
        EXPECT_TRUE(contacts_beyond(limit, travel, beyond, solid).empty()) << beyond;
      const auto some = contacts_beyond(limit, travel, step, solid);
      ASSERT_EQ(some.size(), 1u);
      EXPECT_EQ(some[0].part, limit.part);
      // A ball touches sideways at its equator, and higher by the length of the overlap.
      const double flank = limit.tool.silhouette.cutting.knots.front().bulge != 0 && limit.axis == 1 ? 1 : 0;
      EXPECT_NEAR(some[0].depth.mm(), limit.depth > 0 ? limit.depth : kHair, 2e-3 + flank);
    }
  }
}

TEST(Grazes, OfAFixture) { expect_fixture_reported(block({0, 0, -kBlockZ}, {60, 40, 0}), kHair, travels_of); }

TEST(Grazes, OfAFixtureFromAFile) {
  const Triangles mesh = box_mesh({0, 0, -kBlockZ}, {60, 40, 0});
  Diagnostics diagnostics;
  const double columns = 0.049;  // the distance of a million of them
  expect_fixture_reported(stock_of(make_mesh_body(mesh.positions, mesh.triangles, "box.stl", diagnostics)),
                          columns, [](const FixtureLimit&) { return std::vector{Travel::line}; });
}

/// An arc of 100 mm whose flutes, 3 mm in radius, enter the side Y0 by 0.02 mm: along 4 mm, from X32 to X28.
TEST(Grazes, AnArcTouchesAFixtureWhereItEntersIt) {
  constexpr double kDeep = 0.02, kRadius = 100;
  ToolTable tools;
  tools.set(1, flutes_only());
  for (const Turn turn : {Turn::ccw, Turn::cw}) {
    Path path;
    const double side = turn == Turn::ccw ? kRadius : -kRadius, y = -3 + kDeep - kRadius;
    path.rapid({30 + side, y, 70}).tool(1).rapid({30 + side, y, -4});
    path.arc({.to = {30 - side, y, -4}, .centre = {30, y}, .turn = turn, .feed = mm_per_min(100)});
    Diagnostics diagnostics;
    const Stock solid = block({0, 0, -kBlockZ}, {60, 40, 0});
    const auto found =
        find_fixture_contacts(path.path(), tools, std::vector{Fixture{"clamp", solid}}, {}, diagnostics);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->size(), 1u);
    const double half = std::sqrt(kRadius * kRadius - (kRadius - kDeep) * (kRadius - kDeep));
    EXPECT_NEAR(found->front().at.x, turn == Turn::ccw ? 30 + half : 30 - half, 0.15);
    EXPECT_NEAR(found->front().at.y, 0, 1e-9);
    EXPECT_NEAR(found->front().depth.mm(), 4, 1e-6);
  }
}

}  // namespace
}  // namespace kerf::test

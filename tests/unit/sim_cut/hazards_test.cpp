// What is reported as a hazard, and the near misses that must not be.
#include <gtest/gtest.h>

#include "cut_jobs.h"

namespace kerf::test {
namespace {

constexpr double kPitch = 0.1;

/// Square mill of 6 mm, 10 mm of flute, a neck of 5 mm up to 20, a shank of 8 mm up to 40 and a holder of 30
/// mm.
Tool whole_tool(int number) {
  Tool tool = make_drawn(number, profile({{0, 0, 0}, {3, 0, 0}, {3, 10, 0}}));
  tool.silhouette.neck = profile({{2.5, 10, 0}, {2.5, 20, 0}});
  tool.silhouette.shank = profile({{4, 20, 0}, {4, 40, 0}});
  tool.silhouette.holder = profile({{15, 40, 0}, {15, 60, 0}});
  return tool;
}

/// The block is 60 x 40 x 30 with its top at Z0.
std::vector<Hazard> hazards_of(Path& path, double depth_of_block = 30) {
  ToolTable tools;
  tools.set(1, whole_tool(1));
  Diagnostics diagnostics;
  const auto result =
      run(path.path(), tools, block({0, 0, -depth_of_block}, {60, 40, 0}), kPitch, diagnostics, 2);
  EXPECT_TRUE(result);
  return result ? result->hazards : std::vector<Hazard>{};
}

bool has(const std::vector<Hazard>& hazards, HazardKind kind) {
  for (const Hazard& h : hazards)
    if (h.kind == kind) return true;
  return false;
}

TEST(Hazards, RapidThroughTheStockIsReportedWithPositionDepthAndVolume) {
  Path path;
  path.tool(1).rapid({-10, 20, 5}).rapid({-10, 20, -2}).rapid({30, 20, -2});
  const auto hazards = hazards_of(path);
  ASSERT_EQ(hazards.size(), 1u);
  EXPECT_EQ(hazards[0].kind, HazardKind::rapid_in_stock);
  EXPECT_EQ(hazards[0].step, 3u);
  EXPECT_NEAR(hazards[0].at.x, 0.05, 1e-6);
  EXPECT_NEAR(hazards[0].at.z, -2.0, 1e-4);
  EXPECT_NEAR(hazards[0].at.y, 20.0, 0.2);
  EXPECT_NEAR(hazards[0].depth.mm(), 2.0, 1e-4);
  const double exact = (30 * 6 + std::numbers::pi * 9 / 2) * 2;
  EXPECT_NEAR(hazards[0].removed.mm3(), exact, 0.01 * exact);
}

TEST(Hazards, RapidWithFlutesAlreadyThroughTheStock) {
  // The flutes pass below a plate of 10 mm; the parts above them go through it, drawn or not.
  Tool flutes = make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 5, 0}})), all = whole_tool(1);
  const Profile none;
  struct Case {
    const char* name;
    Tool tool;
    double z, radius, depth;
  };
  std::vector<Case> cases{{"flutes only", flutes, -30, 3, 10}, {"half a flute", flutes, -13, 3, 10}};
  cases.push_back({"neck", all, -20, 2.5, 10});
  cases.push_back({"shank", all, -39, 4, 10});
  cases.push_back({"holder", all, -55, 15, 10});
  cases.push_back({"above the holder", all, -200, 15, 10});
  all.silhouette.holder = none;
  cases.push_back({"above the shank", all, -200, 4, 10});
  for (const Case& c : cases) {
    ToolTable tools;
    tools.set(1, c.tool);
    Path path;
    path.tool(1).rapid({-20, 20, c.z}).rapid({80, 20, c.z});
    Diagnostics diagnostics;
    const auto result = run(path.path(), tools, block({0, 0, -10}, {60, 40, 0}), kPitch, diagnostics);
    ASSERT_TRUE(result) << c.name;
    ASSERT_EQ(result->hazards.size(), 1u) << c.name;
    const Hazard& h = result->hazards[0];
    EXPECT_EQ(h.kind, HazardKind::rapid_in_stock) << c.name;
    EXPECT_NEAR(h.depth.mm(), c.depth, 1e-3) << c.name;
    EXPECT_NEAR(h.removed.mm3(), 60 * 2 * c.radius * 10, 0.01 * 60 * 2 * c.radius * 10) << c.name;
    EXPECT_NEAR(h.at.x, 0.05, 1e-6) << c.name;
  }
}

TEST(Hazards, RapidWithAllPartsInTheStockCountsThemTogether) {
  // Straight down 45 mm into a block of 50: flutes, neck, shank and 5 mm of the holder.
  Path path;
  path.tool(1).rapid({30, 20, 2}).rapid({30, 20, -45});
  const auto hazards = hazards_of(path, 50);
  ASSERT_EQ(hazards.size(), 1u);
  EXPECT_EQ(hazards[0].kind, HazardKind::rapid_in_stock);
  EXPECT_NEAR(hazards[0].depth.mm(), 45.0, 1e-3);
  // The flutes cut the whole hole above them; the shank a wider one from 25 on, the holder from 5 on.
  const double exact = std::numbers::pi * (9 * 45 + (16 - 9) * 25 + (225 - 16) * 5);
  EXPECT_NEAR(hazards[0].removed.mm3(), exact, 2e-3 * exact);
}

TEST(Hazards, RapidInAPocketWhoseWallsOnlyTheHolderTouches) {
  // A pocket of 20 x 20, 8 deep, and a tool whose holder of 30 starts 6 above the tip.
  Tool tool = make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 6, 0}}));
  tool.silhouette.holder = profile({{15, 6, 0}, {15, 30, 0}});
  Tool long_tool = make_drawn(2, profile({{0, 0, 0}, {3, 0, 0}, {3, 30, 0}}));
  ToolTable tools;
  tools.set(1, tool);
  tools.set(2, long_tool);
  for (const double z : {-5.9, -7.0}) {
    Path path;
    path.tool(2).rapid({20, 10, 5}).cut({20, 10, -8});
    for (double y = 10; y <= 24; y += 4) path.cut({20, y, -8}).cut({34, y, -8}).cut({20, y, -8});
    path.rapid({20, 22, 5}).tool(1).rapid({27, 18, 5}).rapid({27, 18, z}).rapid({29, 18, z});
    Diagnostics diagnostics;
    const auto result = run(path.path(), tools, block({0, 0, -20}, {60, 40, 0}), kPitch, diagnostics);
    ASSERT_TRUE(result);
    const auto last = static_cast<std::uint32_t>(path.path().size() - 1);
    if (z > -6.0) {
      EXPECT_TRUE(result->hazards.empty());
      continue;
    }
    ASSERT_EQ(result->hazards.size(), 2u);  // the plunge, and the move after it
    EXPECT_EQ(result->hazards[0].step, last - 1);
    EXPECT_EQ(result->hazards[1].step, last);
    for (const Hazard& h : result->hazards) {
      EXPECT_EQ(h.kind, HazardKind::rapid_in_stock);
      EXPECT_NEAR(h.depth.mm(), 1.0, 1e-3);
    }
  }
}

TEST(Hazards, RapidAtTheTopTouchesNothing) {
  Path path;
  path.tool(1).rapid({-10, 20, 0}).rapid({70, 20, 0});
  EXPECT_TRUE(hazards_of(path).empty());
}

TEST(Hazards, RapidAHundredthTooDeepIsReported) {
  Path path;
  path.tool(1).rapid({-10, 20, -0.01}).rapid({70, 20, -0.01});
  const auto hazards = hazards_of(path);
  ASSERT_EQ(hazards.size(), 1u);
  EXPECT_NEAR(hazards[0].depth.mm(), 0.01, 1e-4);
}

TEST(Hazards, RapidBesideTheStockTouchesNothingButOneColumnIsReported) {
  Path beside;  // the side of the tool is exactly at that of the block
  beside.tool(1).rapid({-10, -3, 5}).rapid({-10, -3, -5}).rapid({70, -3, -5});
  EXPECT_TRUE(hazards_of(beside).empty());
  Path inside;  // reaches the first row of columns, at 0.05
  inside.tool(1).rapid({-10, -2.94, 5}).rapid({-10, -2.94, -5}).rapid({70, -2.94, -5});
  EXPECT_EQ(hazards_of(inside).size(), 1u);
}

TEST(Hazards, LeavingAndReturningThroughCutMaterialIsNone) {
  Path path;
  path.tool(1).rapid({10, 10, 2}).cut({10, 10, -4}).rapid({10, 10, 2}).rapid({10, 10, -4});
  path.cut({30.3, 17.7, -4}).rapid({10, 10, -4}).rapid({30.3, 17.7, -4}).rapid({30.3, 17.7, 5});
  path.arc({.to = {30.3, 17.7, 5}, .centre = {25, 17.7}, .feed = mm_per_min(100)});
  EXPECT_TRUE(hazards_of(path).empty());
}

TEST(Hazards, FollowingWallsAndCirclesCutBeforeIsNone) {
  Path path;
  path.tool(1).rapid({35, 20, 2}).cut({35, 20, -4});
  path.arc({.to = {35, 20, -4}, .centre = {30, 20}, .turn = Turn::ccw, .feed = mm_per_min(100)});
  path.rapid({35, 20, -3.9}).rapid({35, 20, -4}).rapid({35, 20, 1});
  path.arc(
      {.to = {35, 20, -4}, .centre = {30, 20}, .turn = Turn::cw, .extra_turns = 2, .feed = mm_per_min(100)});
  EXPECT_TRUE(hazards_of(path).empty());
}

TEST(Hazards, PassesDeeperThanTheFluteAreNone) {
  // 18 mm deep in steps of 6: the neck is thinner, and everything beside the flutes has been cut.
  Path path;
  path.tool(1).rapid({10, 20, 2});
  for (const double z : {-6.0, -12.0, -18.0}) path.cut({10, 20, z}).cut({40, 20, z}).cut({10, 20, z});
  path.rapid({10, 20, 5});
  EXPECT_TRUE(hazards_of(path).empty());
}

TEST(Hazards, CuttingDeeperThanTheFluteInOnePass) {
  Path path;
  path.tool(1).rapid({-10, 20, 2}).cut({-10, 20, -12}).cut({30, 20, -12});
  const auto hazards = hazards_of(path);
  EXPECT_TRUE(has(hazards, HazardKind::over_flute));
  EXPECT_FALSE(has(hazards, HazardKind::neck_contact));  // one fault, reported once
  EXPECT_FALSE(has(hazards, HazardKind::shank_contact));
  for (const Hazard& h : hazards) {
    if (h.kind == HazardKind::over_flute) {
      EXPECT_NEAR(h.depth.mm(), 2.0, 1e-3);
    }
  }
}

TEST(Hazards, ACutThatIsTooDeepIsReportedOnce) {
  // An end mill whose shank is as thick as its flutes; material above the flutes is removed with the cut.
  Tool tool = make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 10, 0}}));
  for (const bool has_shank : {true, false}) {
    tool.silhouette.shank = has_shank ? profile({{3, 10, 0}, {3, 50, 0}}) : Profile{};
    ToolTable tools;
    tools.set(1, tool);
    Path path;
    path.tool(1).rapid({-10, 20, 2}).cut({-10, 20, -12}).cut({30, 20, -12}).rapid({30, 20, 5});
    path.rapid({10, 20, 5}).rapid({10, 20, -12});
    Diagnostics diagnostics;
    const auto result = run(path.path(), tools, block({0, 0, -30}, {60, 40, 0}), kPitch, diagnostics);
    ASSERT_TRUE(result);
    ASSERT_EQ(result->hazards.size(), 1u);
    EXPECT_EQ(result->hazards[0].kind, HazardKind::over_flute);
    EXPECT_EQ(result->hazards[0].step, 3u);
  }
}

TEST(Hazards, UndercutsWithANarrowNeckAreNone) {
  // A disc on a thin neck in a slot that an end mill has cut before.
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 12, 0}})));
  Tool disc = make_drawn(2, profile({{0, 0, 0}, {6, 0, 0}, {6, 2, 0}}));
  disc.silhouette.neck = profile({{2.5, 2, 0}, {2.5, 30, 0}});
  tools.set(2, disc);
  Path path;
  path.tool(1).rapid({-10, 20, 2}).cut({-10, 20, -8}).cut({70, 20, -8}).rapid({70, 20, 5});
  path.tool(2).rapid({-10, 20, 5}).cut({-10, 20, -8}).cut({70, 20, -8}).rapid({70, 20, 5});
  Diagnostics diagnostics;
  const auto result = run(path.path(), tools, block({0, 0, -12}, {60, 40, 0}), kPitch, diagnostics);
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->hazards.empty());
  EXPECT_NEAR(result->removed_by_step[8], 60 * 6 * 2, 0.1);  // the undercut itself
}

TEST(Hazards, NothingIsTouchedBesideABlockThatThePitchDoesNotDivide) {
  // The last columns of a row are narrower than half a pitch.
  const Stock odd = block({0, 0, -30}, {59.93, 39.94, 0});
  ToolTable tools;
  tools.set(1, whole_tool(1));
  const double x = 62.93, y = 42.94;  // a radius beside the block
  const auto move_around = [&](double inwards, Path& path, bool at_feed) {
    const auto go = [&](Point3 to) { at_feed ? path.cut(to) : path.rapid(to); };
    path.tool(1).rapid({x + 5, -10, 5}).rapid({x + 5, -10, -5});
    go({x - inwards, -10, -5});
    go({x - inwards, y + 10, -5});
    go({-10, y + 10, -5});
    go({-10, y - inwards, -5});
    go({x + 10, y - inwards, -5});
  };
  for (const bool at_feed : {false, true}) {
    Path tangent, inside;
    move_around(0.0, tangent, at_feed);
    move_around(0.03, inside, at_feed);  // the last columns are 0.015 and 0.02 mm from the sides of the block
    Diagnostics diagnostics;
    const auto none = run(tangent.path(), tools, odd, kPitch, diagnostics);
    const auto some = run(inside.path(), tools, odd, kPitch, diagnostics);
    ASSERT_TRUE(none && some);
    EXPECT_TRUE(none->hazards.empty());
    EXPECT_EQ(none->removed.mm3(), 0.0);
    EXPECT_EQ(some->hazards.size(), at_feed ? 0u : 2u);
    EXPECT_GT(some->removed.mm3(), 0.0);
  }
}

TEST(Hazards, FluteJustLongEnoughIsNone) {
  Path path;
  path.tool(1).rapid({-10, 20, 2}).cut({-10, 20, -10}).cut({30, 20, -10});
  EXPECT_TRUE(hazards_of(path).empty());
}

TEST(Hazards, ShankTooThickForASlotTouchesTheWall) {
  Path path;
  path.tool(1).rapid({10, 20, 2});
  for (const double z : {-8.0, -16.0, -20.0, -22.0}) path.cut({10, 20, z}).cut({40, 20, z}).cut({10, 20, z});
  const auto hazards = hazards_of(path);
  ASSERT_TRUE(has(hazards, HazardKind::shank_contact));
  for (const Hazard& h : hazards) {
    EXPECT_EQ(h.kind, HazardKind::shank_contact);
    EXPECT_NEAR(h.depth.mm(), 2.0, 1e-3);
  }
}

TEST(Hazards, HolderTouchesTheTop) {
  ToolTable tools;
  Tool tool = whole_tool(1);
  tool.silhouette.neck = {};
  tool.silhouette.shank = {};
  tool.silhouette.holder = profile({{15, 10, 0}, {15, 30, 0}});
  tools.set(1, tool);
  Path path;
  path.tool(1).rapid({30, 20, 2}).cut({30, 20, -9.99}).cut({30, 20, -10.02});
  Diagnostics diagnostics;
  const auto result = run(path.path(), tools, block({0, 0, -30}, {60, 40, 0}), kPitch, diagnostics);
  ASSERT_TRUE(result);
  ASSERT_TRUE(has(result->hazards, HazardKind::holder_contact));
  for (const Hazard& h : result->hazards) EXPECT_EQ(h.step, 3u);
}

TEST(Hazards, BelowTheFloor) {
  Path through;
  through.tool(1).rapid({30, 20, 2}).cut({30, 20, -5.5}).cut({80, 20, -5.5}).cut({80, 20, -9});
  const auto hazards = hazards_of(through, 5);
  ASSERT_EQ(hazards.size(), 2u);  // the last move is beside the block
  EXPECT_EQ(hazards[0].kind, HazardKind::below_floor);
  EXPECT_NEAR(hazards[0].depth.mm(), 0.5, 1e-6);
  EXPECT_EQ(hazards[1].step, 3u);
  Path flush;
  flush.tool(1).rapid({30, 20, 2}).cut({30, 20, -5}).cut({40, 20, -5});
  EXPECT_TRUE(hazards_of(flush, 5).empty());
}

TEST(Hazards, BelowTheFloorStartsWhereTheToolPassesIt) {
  // 2 mm down along 40 mm: the floor at Z-5 is passed halfway.
  Path down;
  down.tool(1).rapid({10, 20, 2}).cut({10, 20, -4}).cut({50, 20, -6});
  const auto sinking = hazards_of(down, 5);
  ASSERT_EQ(sinking.size(), 1u);
  EXPECT_EQ(sinking[0].kind, HazardKind::below_floor);
  EXPECT_NEAR(sinking[0].at.x, 30, 0.3);
  EXPECT_NEAR(sinking[0].at.z, -5, 0.02);
  EXPECT_NEAR(sinking[0].depth.mm(), 1, 1e-6);
  Path up;
  up.tool(1).rapid({10, 20, 2}).cut({10, 20, -4}).rapid({10, 20, 2}).rapid({-20, 20, 2}).rapid({-20, 20, -6});
  up.cut({60, 20, -4});  // over the block from X-3 on, below the floor until X20
  const auto rising = hazards_of(up, 5);
  ASSERT_EQ(rising.size(), 1u);
  EXPECT_NEAR(rising[0].at.x, 0, 1e-6) << "the nearest point of the block";
  EXPECT_NEAR(rising[0].depth.mm(), 6 - 17.0 / 40 - 5, 0.01);
}

TEST(Hazards, SpindleOff) {
  Path off;
  off.tool(1)
      .spindle(SpindleTurn::cw)
      .rapid({10, 20, 2})
      .cut({10, 20, -2})
      .spindle(SpindleTurn::off)
      .cut({20, 20, -2});
  off.cut({15, 20, -2});  // material already removed: no hazard
  const auto hazards = hazards_of(off);
  ASSERT_EQ(hazards.size(), 1u);
  EXPECT_EQ(hazards[0].kind, HazardKind::spindle_off);
  EXPECT_EQ(hazards[0].step, 5u);
  Path never;  // the program does not state the spindle
  never.tool(1).rapid({10, 20, 2}).cut({10, 20, -2});
  EXPECT_TRUE(hazards_of(never).empty());
  Path late;
  late.tool(1).rapid({10, 20, 2}).cut({10, 20, -2}).spindle(SpindleTurn::cw).cut({20, 20, -2});
  EXPECT_EQ(hazards_of(late).size(), 1u);
  Path laser = late;
  laser.path().add(step::LaserPower{LaserMode::dynamic, 100}, laser.origin());
  EXPECT_TRUE(hazards_of(laser).empty());
}

TEST(Hazards, ContactsInAnUndercutSlot) {
  // A keyhole head may only leave where it entered.
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, 0}, {4, 0, 0}, {4, 2.5, 0}, {2, 2.5, 0}, {2, 9, 0}})));
  for (const bool at_the_hole : {true, false}) {
    Path path;
    path.tool(1).rapid({20, 20, 2}).cut({20, 20, -6}).cut({35, 20, -6});
    if (at_the_hole) path.cut({20, 20, -6});
    path.rapid({at_the_hole ? 20.0 : 35.0, 20, 2});
    Diagnostics diagnostics;
    const auto result = run(path.path(), tools, block({0, 0, -12}, {60, 40, 0}), kPitch, diagnostics);
    ASSERT_TRUE(result);
    EXPECT_EQ(has(result->hazards, HazardKind::rapid_in_stock), !at_the_hole);
  }
}

}  // namespace
}  // namespace kerf::test

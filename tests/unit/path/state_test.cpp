// The state in force at a step, and the steps that restore it.
#include "path/state.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

constexpr OriginId kNone = OriginId::none;

PathState state_of(const Toolpath& path) {
  StateReader reader(path);
  reader.to(path.size());
  return reader.state();
}

/// A path that sets every part.
Toolpath full(double value) {
  Toolpath path;
  path.add(step::WorkZero{.kind = ZeroKind::offset, .system = 1, .axes = 7, .zero = {0, 0, 0}}, kNone);
  path.add(step::WorkZero{.kind = ZeroKind::offset, .system = 2, .axes = 7, .zero = {value, 0, 0}}, kNone);
  path.add(step::WorkZero{.system = value > 1 ? 2 : 1, .zero = {value > 1 ? value : 0, 0, 0}}, kNone);
  path.add(step::ToolChange{static_cast<int>(value)}, kNone);
  path.add(step::ToolLength{.kind = ToolLengthKind::table, .number = static_cast<int>(value)}, kNone);
  path.add(step::PathMode{PathModeKind::blend, mm(0.01 * value)}, kNone);
  path.add(step::Spindle{rpm(1000 * value), SpindleTurn::cw}, kNone);
  path.add(step::Coolant{value > 1, true}, kNone);
  path.add(step::LaserPower{LaserMode::constant, value}, kNone);
  path.add(step::MotionLimits{LimitKind::acceleration, {value, 0, 0, 0}, 1}, kNone);
  path.add(step::Extruder{static_cast<int>(value)}, kNone);
  path.add(step::Temperature{Heater::bed, 50 + value}, kNone);
  path.add(step::Fan{0, 0.1 * value}, kNone);
  path.add(step::Layer{"layer " + std::to_string(value), 1}, kNone);
  const std::size_t turned = path.add(step::Rapid{{value, 0, 5}}, kNone);
  MotionExtra extra;
  extra.abc = {value, 0, 0};
  path.set_extra(turned, extra);
  return path;
}

TEST(State, WhatIsRestoredEqualsWhatWasWanted) {
  const PathState wanted = state_of(full(2));
  const StateParts own = difference(wanted, state_of(full(1)));
  EXPECT_EQ(own, kAllState & ~bit_of(StatePart::filament));
  Toolpath path = full(1);
  PathState now = state_of(path);
  EXPECT_EQ(restore(now, wanted, kAllState, kNone, path), 0u);
  EXPECT_EQ(difference(now, wanted), 0u) << to_text(difference(now, wanted));
  // The reader of the whole path sees the same.
  EXPECT_EQ(difference(state_of(path), wanted), 0u);
  // Nothing is left to do.
  const std::size_t size = path.size();
  EXPECT_EQ(restore(now, wanted, kAllState, kNone, path), 0u);
  EXPECT_EQ(path.size(), size);
}

TEST(State, PartsDifferInEachOfTheirValues) {
  const auto differ = [](auto a, auto b) {
    Toolpath first, second;
    first.add(a, kNone);
    second.add(b, kNone);
    return difference(state_of(first), state_of(second)) != 0;
  };
  using step::LaserPower;
  EXPECT_FALSE(differ(LaserPower{LaserMode::constant, 300}, LaserPower{LaserMode::constant, 300}));
  EXPECT_TRUE(differ(LaserPower{LaserMode::constant, 300}, LaserPower{LaserMode::dynamic, 300}));
  EXPECT_TRUE(differ(LaserPower{LaserMode::constant, 300}, LaserPower{LaserMode::constant, 301}));
  EXPECT_TRUE(differ(step::Spindle{rpm(900), SpindleTurn::cw}, step::Spindle{rpm(900), SpindleTurn::ccw}));
  EXPECT_TRUE(differ(step::Spindle{rpm(900), SpindleTurn::cw}, step::Spindle{rpm(901), SpindleTurn::cw}));
  EXPECT_TRUE(differ(step::Coolant{true, false}, step::Coolant{false, true}));
  EXPECT_TRUE(
      differ(step::PathMode{PathModeKind::blend, mm(0.1)}, step::PathMode{PathModeKind::blend, mm(0.2)}));
  EXPECT_TRUE(
      differ(step::PathMode{PathModeKind::blend, mm(0)}, step::PathMode{PathModeKind::exact_stop, mm(0)}));
}

TEST(State, UnstatedSpindleCoolantAndLaserAreOff) {
  Toolpath path;
  path.add(step::Spindle{rpm(9000), SpindleTurn::cw}, kNone);
  path.add(step::Coolant{false, true}, kNone);
  path.add(step::LaserPower{LaserMode::dynamic, 100}, kNone);
  PathState now = state_of(path);
  EXPECT_EQ(restore(now, {}, kAllState, kNone, path), 0u);
  EXPECT_EQ(now.spindle->turn, SpindleTurn::off);
  EXPECT_FALSE(now.coolant->flood);
  EXPECT_EQ(now.laser->mode, LaserMode::off);
  // The beam is off first.
  EXPECT_EQ(path[3].kind(), StepKind::laser_power);
}

TEST(State, WhatCannotBeRestoredIsReported) {
  Toolpath path = full(2);
  PathState now = state_of(path);
  const StateParts lost = restore(now, {}, kAllState, kNone, path);
  for (const StatePart part : {StatePart::work_zero, StatePart::tool, StatePart::tool_length,
                               StatePart::path_mode, StatePart::limits, StatePart::rotary})
    EXPECT_NE(lost & bit_of(part), 0u) << to_string(part);
  // A printer starts with its first extruder: active_extruder = 0 in Marlin, "extruder" in Klipper.
  EXPECT_EQ(lost & bit_of(StatePart::extruder), 0u);
  EXPECT_EQ(now.extruder, 0);
  EXPECT_EQ(lost & bit_of(StatePart::spindle), 0u);
  EXPECT_NE(to_text(lost).find("the path mode"), std::string::npos);
}

TEST(State, ASelectedOffsetAtAnUnknownDistanceLosesThePosition) {
  Toolpath path;
  path.add(step::Rapid{{1, 2, 3}}, kNone);
  const PathState wanted = state_of(path);
  path.add(step::WorkZero{.system = 2, .unknown = 7}, kNone);
  path.add(step::Rapid{{4, 5, 6}}, kNone);
  PathState now = state_of(path);
  EXPECT_TRUE(now.position.is_known());
  EXPECT_EQ(restore(now, wanted, kAllState, kNone, path), 0u);
  EXPECT_EQ(path[path.size() - 1].work_zero().system, 1);
  EXPECT_EQ(now.position.unknown, 7u);
}

TEST(State, WhatIsSetBeforeTheFirstCutNeedsNoOtherValueBefore) {
  Toolpath path;
  path.add(step::Rapid{{0, 0, 5}}, kNone);
  path.add(step::Spindle{rpm(9000), SpindleTurn::cw}, kNone);
  path.add(step::Rapid{{1, 0, 5}}, kNone);
  path.add(step::Cut{{1, 0, -1}, mm_per_min(100)}, kNone);
  path.add(step::Coolant{false, true}, kNone);
  EXPECT_EQ(set_before_cut(path, 0, path.size()), bit_of(StatePart::spindle));
}

TEST(State, FilamentThatIsDrawnBackCounts) {
  Toolpath path;
  path.add(step::Extrude{{0, 0, 0}, mm3(-2), {}, {}, mm_per_min(100)}, kNone);
  EXPECT_EQ(state_of(path).filament().volume, 2.0);
  path.add(step::Extrude{{0, 0, 0}, mm3(1.5), {}, {}, mm_per_min(100)}, kNone);
  EXPECT_EQ(state_of(path).filament().volume, 0.5);
  path.add(step::Extrude{{9, 0, 0}, mm3(3), {}, {}, mm_per_min(100)}, kNone);
  EXPECT_EQ(state_of(path).filament().volume, 0.0);
}

}  // namespace
}  // namespace kerf

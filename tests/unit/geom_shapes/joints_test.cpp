// Slots of finger joints and reliefs of corners: areas and points by hand.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "base/codes/op.h"

#include "kerf/geom/offset.h"
#include "kerf/geom/shapes.h"

namespace kerf {
namespace {

Outline rectangle(double x1, double y1, double x2, double y2) {
  return {{x1, y1}, {{{x2, y1}, {}}, {{x2, y2}, {}}, {{x1, y2}, {}}, {{x1, y1}, {}}}};
}

struct Joints : testing::Test {
  Diagnostics diagnostics;
  Region region(const Outline& outline) {
    return *make_region({outline}, FillRule::nonzero, {}, diagnostics);
  }
};

TEST_F(Joints, SlotsOfTheTwoBoardsFillTheEdge) {
  FingerJoint joint{mm(100), mm(12), 5, FingerJoint::Ends::fingers, {}, {}};
  const auto first = finger_slots(joint, {}, diagnostics);
  joint.ends = FingerJoint::Ends::slots;
  const auto second = finger_slots(joint, {}, diagnostics);
  ASSERT_TRUE(first && second);
  EXPECT_NEAR(area(*first), 2 * 20 * 12, 1e-9);
  EXPECT_NEAR(area(*second), 3 * 20 * 12, 1e-9);
  EXPECT_NEAR(area(combine(*first, *second, Boolean::intersect, {}, diagnostics)->region), 0.0, 1e-9);
}

TEST_F(Joints, SlotsAreWiderByTheFitAndReachOverTheEdge) {
  const FingerJoint joint{mm(100), mm(12), 5, FingerJoint::Ends::slots, mm(0.2), mm(6)};
  const auto slots = finger_slots(joint, {}, diagnostics);
  ASSERT_TRUE(slots);
  // The end slots end at the overhang on one side, by 0.1 further on the other.
  EXPECT_NEAR(area(*slots), (2 * (6 + 20 + 0.1) + 20.2) * 18, 1e-9);
  EXPECT_EQ(bounds(*slots).low, (Point2{-6, -6}));
}

TEST_F(Joints, WrongJointsAreRefused) {
  const auto refused = [&](FingerJoint joint) {
    Diagnostics own;
    EXPECT_FALSE(finger_slots(joint, {}, own));
    EXPECT_GE(own.errors(), 1u);
    EXPECT_EQ(own.list()[0].code, codes::op_option);
  };
  const FingerJoint good{mm(100), mm(12), 5, FingerJoint::Ends::fingers, {}, {}};
  for (const double wrong : {0.0, -1.0, std::nan("")}) {
    FingerJoint joint = good;
    joint.width = mm(wrong);
    refused(joint);
    joint = good;
    joint.depth = mm(wrong);
    refused(joint);
  }
  for (const int wrong : {-1, 0, 1, 4}) {
    FingerJoint joint = good;
    joint.count = wrong;
    refused(joint);
  }
  FingerJoint joint = good;
  joint.fit = mm(20);
  refused(joint);
  joint = good;
  joint.overhang = mm(-1);
  refused(joint);
}

TEST_F(Joints, AToolThatClearsReliefsClearsTheCorners) {
  const Region pocket = region(rectangle(0, 0, 40, 20));
  for (const ReliefStyle style : {ReliefStyle::dog_bone, ReliefStyle::t_bone}) {
    const auto relieved = relieve_corners(pocket, {mm(6), style, nullptr}, {}, diagnostics);
    ASSERT_TRUE(relieved);
    // Where the centre of the tool may be, grown by its radius, is what it clears.
    const auto inside = offset(*relieved, mm(-3), {}, diagnostics);
    const auto cleared = offset(inside->region, mm(3), {}, diagnostics);
    const auto left = combine(pocket, cleared->region, Boolean::subtract, {}, diagnostics);
    EXPECT_LT(area(left->region), 1e-3);
    EXPECT_GT(area(*relieved), area(pocket));
  }
}

TEST_F(Joints, DogBonesLieOnTheBisectorAndTBonesInTheShorterSide) {
  const Region pocket = region(rectangle(0, 0, 40, 20));
  const auto dog = relieve_corners(pocket, {mm(6), ReliefStyle::dog_bone, nullptr}, {}, diagnostics);
  const auto t = relieve_corners(pocket, {mm(6), ReliefStyle::t_bone, nullptr}, {}, diagnostics);
  // The circle through the corner with its centre on the bisector reaches over both sides equally.
  const double reach = 3.002 / std::sqrt(2.0) - 3.002;
  EXPECT_NEAR(bounds(*dog).low.x, reach, 1e-9);
  EXPECT_NEAR(bounds(*dog).low.y, reach, 1e-9);
  EXPECT_NEAR(bounds(*t).low.x, -3.002, 1e-9) << "over the shorter side, which is vertical";
  EXPECT_NEAR(bounds(*t).low.y, 0.0, 1e-9);
}

TEST_F(Joints, OuterCornersAndThoseBeyondTheLimitsStay) {
  const Region slot = region(rectangle(10, -3, 20, 12)), board = region(rectangle(0, 0, 100, 40));
  const auto relieved = relieve_corners(slot, {mm(3), ReliefStyle::dog_bone, &board}, {}, diagnostics);
  ASSERT_TRUE(relieved);
  EXPECT_NEAR(bounds(*relieved).low.y, -3.0, 1e-9);
  EXPECT_GT(bounds(*relieved).high.y, 12.0);
  const Diagnostics none;
  EXPECT_FALSE(relieve_corners(slot, {mm(0), ReliefStyle::dog_bone, nullptr}, {}, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::op_option);
}

TEST(ReliefStyles, HaveNames) {
  EXPECT_EQ(relief_style_named("Dog Bone"), ReliefStyle::dog_bone);
  EXPECT_EQ(relief_style_named("t-bone"), ReliefStyle::t_bone);
  EXPECT_FALSE(relief_style_named("bone"));
}

}  // namespace
}  // namespace kerf

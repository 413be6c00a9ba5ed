// The steps of a print against the limits of a printer.
#include <gtest/gtest.h>
#include <vector>

#include "kerf/path/check.h"

namespace kerf {
namespace {

constexpr OriginId kNone = OriginId::none;

/// A motion that extrudes, or draws back.
void extrude(Toolpath& path, Point3 to, double mm3) {
  path.add(
      step::Extrude{
          .to = to, .volume = Volume::raw(mm3), .width = mm(0.4), .height = mm(0.2), .feed = mm_per_min(600)},
      kNone);
}

std::vector<PrintFaultKind> kinds(const Toolpath& path, const PrinterLimits& limits) {
  std::vector<PrintFaultKind> found;
  for (const PrintFault& fault : check_print(path, limits)) found.push_back(fault.kind);
  return found;
}

/// mm by which a bead that ends at `to` leaves a bed from (0, 10, 0) to (100, 200, 50); 0: it does not.
double outside_at(Point3 to) {
  Toolpath path;
  path.add(step::Rapid{{50, 50, 1}}, kNone);
  extrude(path, to, 1.0);
  PrinterLimits limits;
  limits.bed = Box3{{0, 10, 0}, {100, 200, 50}};
  const std::vector<PrintFault> found = check_print(path, limits);
  EXPECT_LE(found.size(), 1u);
  return found.empty() ? 0.0 : found.front().value;
}

TEST(CheckPrint, TheBedEndsOnBothSidesOfEachAxis) {
  EXPECT_EQ(outside_at({0, 10, 0}), 0.0);
  EXPECT_EQ(outside_at({100, 200, 50}), 0.0);
  EXPECT_EQ(outside_at({-3, 50, 1}), 3.0);
  EXPECT_EQ(outside_at({102, 50, 1}), 2.0);
  EXPECT_EQ(outside_at({50, 6, 1}), 4.0);
  EXPECT_EQ(outside_at({50, 205, 1}), 5.0);
  EXPECT_EQ(outside_at({50, 50, -0.5}), 0.5);
  EXPECT_EQ(outside_at({50, 50, 56}), 6.0);
}

/// Each retraction of 5 mm3 is taken back before the next one: none is the second.
TEST(CheckPrint, WhatIsPrimedIsNoLongerDrawnBack) {
  const Point3 a{10, 10, 0.2}, b{20, 10, 0.2};
  Toolpath path;
  path.add(step::Rapid{a}, kNone);
  for (const Point3 next : {b, a, b}) {
    extrude(path, next, 1.0);
    extrude(path, next, -5.0);
    path.add(step::Rapid{{next.x, 30, 0.2}}, kNone);
    path.add(step::Rapid{next}, kNone);
    extrude(path, next, 5.0);
  }
  EXPECT_EQ(kinds(path, {}), std::vector<PrintFaultKind>{});
  extrude(path, b, -5.0);
  path.add(step::Rapid{a}, kNone);
  extrude(path, a, -5.0);
  EXPECT_EQ(kinds(path, {}), std::vector<PrintFaultKind>{PrintFaultKind::retracted_twice});
}

/// Half of what was drawn back is missing at the start of the bead.
TEST(CheckPrint, PrimingInPartLeavesTheRest) {
  Toolpath path;
  path.add(step::Rapid{{10, 10, 0.2}}, kNone);
  extrude(path, {20, 10, 0.2}, 2.0);
  extrude(path, {20, 10, 0.2}, -4.0);
  extrude(path, {20, 10, 0.2}, 3.0);
  extrude(path, {30, 10, 0.2}, 2.0);
  const std::vector<PrintFault> found = check_print(path, {});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, PrintFaultKind::extruded_drawn_back);
  EXPECT_DOUBLE_EQ(found[0].value, 1.0);
}

}  // namespace
}  // namespace kerf

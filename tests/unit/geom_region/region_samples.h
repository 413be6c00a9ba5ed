// Outlines and regions that the tests of regions, offsets and what is computed from them have in common.
#pragma once

#include <gtest/gtest.h>
#include <numbers>
#include <vector>

#include "kerf/geom/region.h"

namespace kerf {

inline constexpr double kPi = std::numbers::pi;

inline Outline rectangle(double x, double y, double width, double height) {
  return {{x, y}, {{{x + width, y}, {}}, {{x + width, y + height}, {}}, {{x, y + height}, {}}, {{x, y}, {}}}};
}

inline Outline circle(double x, double y, double r) {
  return {{x + r, y}, {{{x - r, y}, Point2{x, y + r}}, {{x + r, y}, Point2{x, y - r}}}};
}

class RegionTest : public testing::Test {
 protected:
  ~RegionTest() override { EXPECT_FALSE(diagnostics.has_errors()) << to_string(diagnostics.list()[0]); }
  Region made(std::vector<Outline> outlines, FillRule rule = FillRule::nonzero) {
    return make_region(outlines, rule, {}, diagnostics).value_or(Region{});
  }
  Region combined(const Region& a, const Region& b, Boolean what) {
    const auto found = combine(a, b, what, {}, diagnostics);
    relation = found->relation;
    return found->region;
  }
  Diagnostics diagnostics;
  Relation relation{};
};

}  // namespace kerf

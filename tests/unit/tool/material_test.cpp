// Chip loads for diameters between, below and above those of a table.
#include "kerf/tool/material.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

TEST(Material, ChipLoadsInProportionBetweenThoseOfTheTable) {
  const Material wood{"wood", {}, {{mm(2), mm(0.1)}, {mm(6), mm(0.3)}}};
  EXPECT_DOUBLE_EQ(highest_chip_load(wood, mm(1)).mm(), 0.05);
  EXPECT_DOUBLE_EQ(highest_chip_load(wood, mm(4)).mm(), 0.2);
  EXPECT_DOUBLE_EQ(highest_chip_load(wood, mm(20)).mm(), 0.3);
}

}  // namespace
}  // namespace kerf

// Comments of slicers: bead sizes, and the filament diameter of the settings at the start or end of a file.
#include "front/gcode/comments/slicer_comments.h"

#include <gtest/gtest.h>
#include <string>

namespace kerf::gcode {
namespace {

TEST(SlicerComments, TheFilamentDiameterIsInTheSettings) {
  EXPECT_EQ(find_filament_diameter("G1 X1\n; filament_diameter = 2.85,1.75\n"), 2.85);
  EXPECT_EQ(find_filament_diameter(";   filamentDiameters,1.75|1.75\n"), 1.75);
  EXPECT_EQ(find_filament_diameter(";Filament Diameter #1: 3.0\r\n"), 3.0);
  EXPECT_EQ(find_filament_diameter("; filament_diameter = 0\n; filament_diameter = 99\n"), std::nullopt);
  EXPECT_EQ(find_filament_diameter("filament_diameter = 2.85\n"), std::nullopt);  // not a comment
  EXPECT_EQ(find_filament_diameter(""), std::nullopt);
  std::string longer;
  for (int i = 0; i < 20'000; ++i) longer += "G1 X10\n";
  longer += "; filament_diameter = 2.85\n";
  EXPECT_EQ(find_filament_diameter(longer), 2.85);
}

TEST(SlicerComments, KindsOfBeadsHaveTheNamesOfEachSlicer) {
  EXPECT_EQ(read_bead_kind("TYPE:External perimeter"), BeadKind::outer_wall);
  EXPECT_EQ(read_bead_kind("TYPE:Outer wall"), BeadKind::outer_wall);
  EXPECT_EQ(read_bead_kind("FEATURE: Outer wall"), BeadKind::outer_wall);
  EXPECT_EQ(read_bead_kind("TYPE:WALL-OUTER"), BeadKind::outer_wall);
  EXPECT_EQ(read_bead_kind("TYPE:Top solid infill"), BeadKind::top);
  EXPECT_EQ(read_bead_kind("TYPE:SKIN "), BeadKind::solid_infill);
  EXPECT_EQ(read_bead_kind("TYPE:something new"), BeadKind::custom);
  EXPECT_EQ(read_bead_kind("TYPES: Outer wall"), std::nullopt);
  EXPECT_EQ(read_bead_kind(""), std::nullopt);
}

}  // namespace
}  // namespace kerf::gcode

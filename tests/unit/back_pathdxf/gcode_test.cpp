// The G-code text of PathDxf2GCode from steps.
#include <gtest/gtest.h>

#include "back/pathdxf/adjust_z.h"
#include "back/pathdxf/pathdxf_gcode.h"

namespace kerf {
namespace {

std::string written(const Toolpath& path) {
  Diagnostics diagnostics;
  const std::string text = pathdxf_gcode(path, {"program", "a.dxf"}, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
  const std::string head = "%\n(program)\n(a.dxf)\nF150\nG17 G21 G40 G49 G54 G80 G90 G94\n";
  EXPECT_EQ(text.substr(0, head.size()), head);
  EXPECT_EQ(text.substr(text.size() - 2), "%\n");
  return text.substr(head.size(), text.size() - head.size() - 2);
}

TEST(PathdxfGcode, WritesTheNamedAxes) {
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  path.set_named_axes(path.add(step::Rapid{{0, 0, 5}}, OriginId::none), 4);
  path.set_named_axes(path.add(step::Rapid{{1, -0.0001, 5}}, OriginId::none), 3);
  path.set_named_axes(path.add(step::Cut{{1, 0, 1}, mm_per_min(150)}, OriginId::none), 4);
  path.set_named_axes(path.add(step::Cut{{2, 0, 1}, mm_per_min(80)}, OriginId::none), 7);
  path.add(step::End{true}, OriginId::none);
  EXPECT_EQ(written(path),
            "T1\nG00 Z5.000\nG00 X1.000 Y-0.000\nG01 Z1.000\nG01 F80.000 X2.000 Y0.000 Z1.000\nM30\n");
}

TEST(PathdxfGcode, WritesCorrectionsAfterZ) {
  Toolpath path;
  const std::size_t i = path.add(step::Cut{{1, 2, 0.8}, mm_per_min(150)}, OriginId::none);
  MotionExtra extra;
  extra.z_correction = "0.800+1.000*[#51-2.000]";
  path.set_extra(i, extra);
  EXPECT_EQ(written(path), "G01 F150.000 X1.000 Y2.000 Z0.800(=0.800+1.000*[#51-2.000])\n");
}

TEST(PathdxfGcode, WritesArcsWithTheirCentreFromTheStart) {
  Toolpath path;
  path.add(step::Rapid{{10, 0, 1}}, OriginId::none);
  step::Arc arc;
  arc.to = {0, 10, 1};
  arc.centre = {0, 0};
  arc.feed = mm_per_min(100);
  path.add(arc, OriginId::none);
  arc.to = {0, -10, 0.5};  // the half circle of a helix
  arc.turn = Turn::cw;
  path.add(arc, OriginId::none);
  EXPECT_EQ(written(path),
            "G00 X10.000 Y0.000 Z1.000\nG03 F100.000 I-10.000 J0.000 X0.000 Y10.000 Z1.000\n"
            "G02 F100.000 I0 J-10.000 X0.000 Y-10.000 Z0.500\n");
}

TEST(PathdxfGcode, WritesNotesWithTheirIndent) {
  Toolpath path;
  path.add(step::Note{"    Q:text"}, OriginId::none);
  path.add(step::Note{"; G00 X1.000 Y2.000"}, OriginId::none);
  path.add(step::Probe{{0, 0, 0}, mm_per_min(50), ProbeKind::contact}, OriginId::none);
  path.add(step::Dwell{seconds(4)}, OriginId::none);
  EXPECT_EQ(written(path), "    (Q:text)\n; G00 X1.000 Y2.000\nG38.3 Z0 F50.000\nG04 P4\n");
}

TEST(PathdxfGcode, RefusesOtherSteps) {
  Toolpath path;
  path.add(step::Coolant{true, false}, OriginId::none);
  Diagnostics diagnostics;
  pathdxf_gcode(path, {}, diagnostics);
  EXPECT_TRUE(diagnostics.has_errors());
}

TEST(AdjustZ, TheFirstExpectedHeightOfAProbeCounts) {
  const auto heights = expected_heights("G01 Z1(=[#51-2.500])\nG01 Z1(=[#52-1]+[#51-9.000])\n");
  EXPECT_EQ(heights, (std::map<int, double>{{51, 2.5}, {52, 1.0}}));
}

TEST(AdjustZ, PositionsInCommentsAreNotProbed) {
  const auto at =
      probed_positions("G00 X1 Y2 (X7 Y8)\nG38.2 Z0 F50\nG00 Y5 ; X9\nG38.2 Z0 (G38.2)\n(G38.2)\n");
  EXPECT_EQ(at, (std::vector<std::array<double, 2>>{{1, 2}, {1, 5}}));
}

}  // namespace
}  // namespace kerf

// Programs that compute: parameters, expressions, O-words, subroutines, offsets. The end points are those of
// LinuxCNC's interpreter for the same text.
#include <gtest/gtest.h>

#include "base/codes/gcode.h"

#include "kerf/program/gcode.h"

namespace kerf {
namespace {

struct Case {
  std::string_view text;     // M2 is added
  std::vector<Point3> ends;  // of the motions
};

const Case kCases[] = {
    {"G0 X[1+2*3] Y[SIN[30]*10]\n#1=5 #2=[#1**2]\nG0 Z-#1", {{7, 5, 0}, {7, 5, -5}}},
    {"#1=[2**3**2]\nG0 X#1", {{64, 0, 0}}},
    {"G0 X[1 OR 0 AND 0] Y[-3 MOD 2] Z[1 EQ 1.00005]", {{0, 1, 1}}},
    {"G0 X[2 GT 1 EQ 1] Y[1 LT 2 AND 0 OR 1] Z[3 XOR 1]", {{1, 1, 0}}},
    {"G0 X[1 NE 2] Y[2 GE 2] Z[3 LE 2]", {{1, 1, 0}}},
    {"G0 X[ROUND[-2.5]] Y[FIX[-2.5]] Z[FUP[-2.5]]", {{-3, -3, -2}}},
    {"G0 X[ATAN[-1]/[-1]] Y[-SIN[30]] Z[2*-3]", {{-135, -0.5, -6}}},
    {"G0 X[LN[EXP[2]]] Y[SQRT[9]] Z[ABS[-4]]", {{2, 3, 4}}},
    {"G0 X[ACOS[0]] Y[ASIN[1]] Z[COS[60]+TAN[45]]", {{90, 90, 1.5}}},
    {"#<foo bar>=3\n#17=#<FooBar>\n#18=EXISTS[#<nope>]\nG0 X#17 Y#18 Z[5-3]", {{3, 0, 2}}},
    {"#30=2 #30=[#30+1]\nG0 X#30", {{1, 0, 0}}},
    {"#1=3\n#3=8\nG0 X##1", {{8, 0, 0}}},
    {"o100 sub\nG0 X#1 Y#2\no100 endsub [#1+1]\no100 call [3] [4]\nG0 X#<_value> Y#<_value_returned> Z#1",
     {{3, 4, 0}, {4, 1, 0}}},
    {"o<x> sub\n#<d>=3\nG0 Z#<d>\no<x> return\nG0 X9\no<x> endsub\n#<d>=2\no<x> call\nG0 Z#<d>",
     {{0, 0, 3}, {0, 0, 2}}},
    {"#1=0\no1 while [#1 LT 5]\n#1=[#1+1]\no2 if [#1 EQ 2]\no1 continue\no2 endif\no3 if [#1 GT 3]\no1 "
     "break\n"
     "o3 endif\nG0 X#1\no1 endwhile",
     {{1, 0, 0}, {3, 0, 0}}},
    {"#1=0\no1 do\nG0 X#1\n#1=[#1+1]\no1 while [#1 LT 3]", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}},
    {"G91\no1 repeat [2]\no2 repeat [2]\nG0 X1\no2 endrepeat\nG0 Y1\no1 endrepeat",
     {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {3, 1, 0}, {4, 1, 0}, {4, 2, 0}}},
    {"#1=2\no1 if [#1 EQ 1]\nG0 X1\no1 elseif [#1 EQ 2]\nG0 X2\no1 elseif [#1 EQ 2]\nG0 X3\no1 else\nG0 X4\n"
     "o1 endif\nG0 Y1",
     {{2, 0, 0}, {2, 1, 0}}},
    {"G0 X1\nM98 P200 L2\nM2\nO200\nG91 G0 X1\nM99", {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}},
    {"G10 L2 P1 X10 Y5 R30\nG0 X1 Y0\nG0 X0", {{10.8660254, 5.5, 0}, {10, 5, 0}}},
    {"G0 X5\nG92 X0\nG0 X1\nG92.1\nG0 X2", {{5, 0, 0}, {6, 0, 0}, {2, 0, 0}}},
    {"G0 X5 Y5\nG10 L20 P1 X0 Y0\nG0 X1 Y1", {{5, 5, 0}, {6, 6, 0}}},
    {"G52 X3\nG0 X1", {{4, 0, 0}}},
    {"G0 X1\nG10 L2 P2 X10\nG55 G0 X1\nG54 G0 X2", {{1, 0, 0}, {11, 0, 0}, {2, 0, 0}}},
    {"G0 X10 Y10\nG30.1\nG0 X0\nG30 Y5", {{10, 10, 0}, {0, 10, 0}, {0, 5, 0}, {0, 10, 0}}},
    {"G0 @10 ^90", {{0, 10, 0}}},
    {"G0 X1\nG91 G0 @5 ^90", {{1, 0, 0}, {0, 6, 0}}},
    {"G7\nG0 X10\nG8\nG0 X10", {{5, 0, 0}, {10, 0, 0}}},
    {"o1 sub\nM73\nG91\nG0 X1\no1 endsub\no1 call\no1 call\nG0 X10", {{1, 0, 0}, {2, 0, 0}, {10, 0, 0}}},
    {"M70\nG20 G91\nG0 X1\nM72\nG0 X1", {{25.4, 0, 0}, {1, 0, 0}}},
    {"M3 S100\nG33 Z-5 K1\nG33.1 Z-8 K1", {{0, 0, -5}, {0, 0, -8}, {0, 0, -5}}},
    {"G51 X2 Y-1\nG0 X1 Y1\nG50\nG0 X1", {{2, -1, 0}, {1, -1, 0}}},
    {"G68 A1 B0 R90\nG0 X2 Y0\nG69\nG0 X0 Y0", {{1, 1, 0}, {0, 0, 0}}},
};

std::vector<Point3> ends_of(const Toolpath& path) {
  std::vector<Point3> ends;
  for (const Step& s : path.steps())
    if (s.is_motion()) ends.push_back(s.to());
  return ends;
}

TEST(GcodeProgram, EndPointsAreThoseOfTheControllers) {
  for (const Case& c : kCases) {
    Diagnostics diagnostics;
    const GcodeProgram program = read_gcode(std::string(c.text) + "\nM2\n", {}, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << c.text << "\n" << to_string(diagnostics.list().front());
    const std::vector<Point3> ends = ends_of(program.path);
    ASSERT_EQ(ends.size(), c.ends.size()) << c.text;
    for (std::size_t i = 0; i < ends.size(); ++i)
      EXPECT_NEAR(distance(ends[i], c.ends[i]), 0.0, 1e-6)
          << c.text << ": motion " << i << " ends at " << ends[i].x << " " << ends[i].y << " " << ends[i].z;
  }
}

TEST(GcodeProgram, SubroutinesAreReadFromFilesBesideTheProgram) {
  GcodeReadOptions options;
  std::vector<std::string> asked;
  options.read_file = [&](const std::string& name) -> std::optional<std::string> {
    asked.push_back(name);
    if (name == "hole.ngc") return "o<hole> sub\nG0 X#1\no<hole> endsub\n";
    return std::nullopt;
  };
  Diagnostics diagnostics;
  const auto program =
      read_gcode("o<hole> call [3]\no<Hole> call [4]\no<../etc> call\nM2\n", options, diagnostics);
  EXPECT_EQ(program.path.size(), 3u);  // and M2
  EXPECT_EQ(asked, std::vector<std::string>{"hole.ngc"});
  ASSERT_EQ(diagnostics.errors(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::sub_missing);
  EXPECT_EQ(std::get<TextLocation>(program.path.origin_of(0)).line, 2u);
}

/// A cut whose corner waits for the next line is before the stop or the end behind it.
TEST(GcodeProgram, ACutThatWaitsForItsCornerIsBeforeAStop) {
  const auto kinds = [](const std::string& stop) {
    Diagnostics diagnostics;
    const GcodeProgram program =
        read_gcode("%\nG1 X50 F100 ,R5\n" + stop + "\n", {.dialect = GcodeDialect::fanuc}, diagnostics);
    EXPECT_TRUE(diagnostics.has_errors()) << stop;
    std::vector<StepKind> all;
    for (const Step& s : program.path.steps()) all.push_back(s.kind());
    return all;
  };
  EXPECT_EQ(kinds("#3006=1\nG1 Y30"), (std::vector{StepKind::cut, StepKind::pause, StepKind::cut}));
  EXPECT_EQ(kinds("#3000=1 (TOO LONG)\nG1 Y30"), (std::vector{StepKind::cut, StepKind::end}));
  EXPECT_EQ(kinds("M30"), (std::vector{StepKind::cut, StepKind::end}));
  EXPECT_EQ(kinds("M0\nG1 Y30"), (std::vector{StepKind::cut, StepKind::pause, StepKind::cut}));
  EXPECT_EQ(kinds("%").front(), StepKind::cut);
}

TEST(GcodeProgram, ALaserSwitchesItsBeam) {
  Diagnostics diagnostics;
  const auto program = read_gcode("; LightBurn\nM4 S0\nG1 X1 S200 F100\nX2 S0\nM5\nM2\n", {}, diagnostics);
  EXPECT_EQ(program.dialect, GcodeDialect::laser);
  std::vector<double> powers;
  for (const Step& s : program.path.steps()) {
    EXPECT_NE(s.kind(), StepKind::spindle);
    if (s.kind() == StepKind::laser_power) powers.push_back(s.laser_power().power);
  }
  EXPECT_EQ(powers, (std::vector<double>{0, 200, 0, 0}));
}

TEST(GcodeProgram, APrinterExtrudesFilament) {
  Diagnostics diagnostics;
  GcodeReadOptions options;
  options.dialect = GcodeDialect::marlin;
  options.filament_diameter = 2.0;
  const auto program = read_gcode(
      "M104 S200\nM117 hello there\nG28\nG92 E0\nG1 X0 Y0 F600\nG1 X10 E1\nM83\nG1 X20 E2\nM106 S255\nG4 "
      "P500\n",
      options, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << to_string(diagnostics.list().front());
  std::vector<double> volumes;
  int dwells = 0, temperatures = 0, fans = 0;
  for (std::size_t i = 0; i < program.path.size(); ++i) {
    const Step& s = program.path[i];
    if (s.kind() == StepKind::extrude) volumes.push_back(program.path.extrude(i).volume.raw());
    if (s.kind() == StepKind::dwell) {
      EXPECT_NEAR(s.dwell().time.seconds(), 0.5, 1e-12);
      ++dwells;
    }
    if (s.kind() == StepKind::temperature) {
      EXPECT_EQ(s.temperature().celsius, 200.0);
      ++temperatures;
    }
    if (s.kind() == StepKind::fan) {
      EXPECT_EQ(s.fan().fraction, 1.0);
      ++fans;
    }
  }
  EXPECT_EQ(dwells, 1);
  EXPECT_EQ(temperatures, 1);
  EXPECT_EQ(fans, 1);
  ASSERT_EQ(volumes.size(), 2u);
  EXPECT_NEAR(volumes[0], 3.14159265, 1e-6);
  EXPECT_NEAR(volumes[1], 2 * 3.14159265, 1e-6);
}

TEST(GcodeProgram, SplinesStayNearTheirCurve) {
  Diagnostics diagnostics;
  const auto program = read_gcode(
      "F100\nG5 I0 J3 P0 Q-3 X1 Y1\nG5 P0 Q-3 X2 Y2\nG5.1 X4 I1 J2\nG5.2 X5 Y5 P1 L3\nX7 Y3\nG5.3\nM2\n", {},
      diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << to_string(diagnostics.list().front());
  EXPECT_GT(program.path.size(), 40u);
  Point3 last;
  for (const Step& s : program.path.steps())
    if (s.is_motion()) last = s.to();
  EXPECT_EQ(last, (Point3{7, 3, 0}));
}

TEST(GcodeProgram, CommentsDescribeTools) {
  Diagnostics diagnostics;
  const auto program = read_gcode(
      "(T1  D=6. CR=1. - ZMIN=-2. - bullnose end mill)\n( T3 : 0.25 )\n( Tool #5 \"x\" / Diameter 3.175 mm "
      ")\n"
      "(HSS, 2-Flute Endmill, 2mm)\nG20\nG0 X1\nG1 X2 F9\nM2\n",
      {}, diagnostics);
  ASSERT_EQ(program.tools.size(), 4u);
  EXPECT_EQ(name_of(program.tools.at(1).shape), "bull nose");
  EXPECT_NEAR(program.tools.at(1).diameter.mm(), 6 * 25.4, 1e-9);
  EXPECT_NEAR(program.tools.at(3).diameter.mm(), 6.35, 1e-9);
  EXPECT_NEAR(program.tools.at(5).diameter.mm(), 3.175, 1e-9);
  EXPECT_NEAR(program.tools.at(0).diameter.mm(), 2.0, 1e-9);
}

TEST(GcodeProgram, AMirroredArcTurnsTheOtherWay) {
  struct Mirror {
    const char* scale;
    double x, y;  // factors
    Turn turn;    // of a clockwise arc
  };
  for (const Mirror& m : {Mirror{"G51 X1 Y-1", 1, -1, Turn::ccw}, Mirror{"G51 X-1 Y1", -1, 1, Turn::ccw},
                          Mirror{"G51 X-1 Y-1", -1, -1, Turn::cw}, Mirror{"G50", 1, 1, Turn::cw}}) {
    // Clockwise from the left of the centre (5, 0) to the point above it.
    for (const char* arc : {"G2 X5 Y5 I5 J0", "G2 X5 Y5 R5"}) {
      Diagnostics diagnostics;
      const auto program =
          read_gcode("F100\nG0 X0 Y0\n" + std::string(m.scale) + "\n" + arc + "\nM2\n", {}, diagnostics);
      ASSERT_FALSE(diagnostics.has_errors()) << m.scale << to_string(diagnostics.list().front());
      ASSERT_EQ(program.path[1].kind(), StepKind::arc) << m.scale;
      const step::Arc made = program.path[1].arc();
      EXPECT_EQ(made.turn, m.turn) << m.scale << " " << arc;
      EXPECT_NEAR(distance(made.centre, {5 * m.x, 0}), 0, 1e-9) << m.scale << " " << arc;
      EXPECT_NEAR(distance(made.to.xy(), {5 * m.x, 5 * m.y}), 0, 1e-9) << m.scale << " " << arc;
    }
  }
}

}  // namespace
}  // namespace kerf

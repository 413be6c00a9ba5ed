// Printers' programs: extrusion and retraction, and the comments of slicers.
#include <gtest/gtest.h>
#include <numbers>

#include "base/codes/gcode.h"

#include "kerf/program/gcode.h"

namespace kerf::test {
namespace {

const std::string kHead = "M104 S200\nM109 S200\nG28\nG1 X0 Y0 Z0.2 F600\n";
constexpr double kUsual = std::numbers::pi / 4.0 * 1.75 * 1.75;  // mm2

std::vector<step::Extrude> beads(const std::string& text, GcodeReadOptions options = {}) {
  Diagnostics diagnostics;
  if (!options.dialect) options.dialect = GcodeDialect::marlin;
  const auto program = read_gcode(text, options, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << to_string(diagnostics.list().front());
  std::vector<step::Extrude> out;
  for (std::size_t i = 0; i < program.path.size(); ++i)
    if (program.path[i].kind() == StepKind::extrude) out.push_back(program.path.extrude(i));
  return out;
}

TEST(Printer, HomingLeavesItsAxesUnknown) {
  Diagnostics diagnostics;
  GcodeReadOptions options;
  options.dialect = GcodeDialect::marlin;
  const auto program = read_gcode("G1 X10 Y20 Z5 F600\nG28 X0 Y0\nG28\n", options, diagnostics);
  ASSERT_EQ(program.path.size(), 3u);
  const auto homing = [&](std::size_t i, unsigned axes) {
    const Step& s = program.path[i];
    EXPECT_EQ(s.kind(), StepKind::rapid);
    EXPECT_EQ(s.reference(), Reference::end_switches);
    EXPECT_EQ(s.reference_axes(), axes);
    EXPECT_EQ(s.unknown_axes(), axes);
  };
  homing(1, 3);
  homing(2, 7);
}

/// Marlin: "The current position is adjusted to align to the new home offset values" (M206); M428 sets them
/// from the position. Klipper: SET_GCODE_OFFSET "to apply to future G-Code commands". Without values they
/// report.
TEST(Printer, CommandsThatMoveTheZeroLoseThePosition) {
  for (const char* line : {"M206 X10", "M206 Z-0.2", "M218 T1 X20 Y0.1", "M428",
                           "SET_GCODE_OFFSET Z=0.2 MOVE=1", "SET_KINEMATIC_POSITION X=10"}) {
    Diagnostics diagnostics;
    const std::string text = std::string("G1 X10 Y20 Z5 F600\n") + line + "\nG1 X20\n";
    const auto program = read_gcode(text, {.dialect = GcodeDialect::marlin}, diagnostics);
    ASSERT_EQ(program.path.size(), 3u) << line;
    EXPECT_EQ(program.path[1].kind(), StepKind::unresolved) << line;
    EXPECT_EQ(program.path[2].unknown_axes(), 6u) << line;
    ASSERT_EQ(diagnostics.list().size(), 1u) << line;
    EXPECT_EQ(diagnostics.list()[0].code, codes::value_unknown);
  }
  for (const char* line : {"M206", "M218 T1", "SET_GCODE_OFFSET"}) {
    Diagnostics diagnostics;
    const std::string text = std::string("G1 X10 Y20 Z5 F600\n") + line + "\nG1 X20\n";
    const auto program = read_gcode(text, {.dialect = GcodeDialect::marlin}, diagnostics);
    ASSERT_EQ(program.path.size(), 3u) << line;
    EXPECT_EQ(program.path[1].kind(), StepKind::verbatim) << line;
    EXPECT_EQ(program.path[2].unknown_axes(), 0u) << line;
  }
}

/// Marlin's page M18: the motors of the given axes, or all, are disabled; with S their time of inactivity is
/// set. Klipper then demands homing. E names extruders.
TEST(Printer, MotorsThatAreOffLoseTheirAxes) {
  const auto lost = [](const std::string& line) {
    Diagnostics diagnostics;
    const auto program = read_gcode("G1 X10 Y20 Z5 F600\n" + line + "\nG1 F900\nG0 Y20\n",
                                    {.dialect = GcodeDialect::marlin}, diagnostics);
    return program.path[program.path.size() - 1].unknown_axes();
  };
  EXPECT_EQ(lost("M84"), 5u);
  EXPECT_EQ(lost("M18"), 5u);
  EXPECT_EQ(lost("M84 X Y"), 1u);
  EXPECT_EQ(lost("M18 Z E"), 4u);
  EXPECT_EQ(lost("M84 E"), 0u);
  EXPECT_EQ(lost("M84 S120"), 0u);
}

/// A T word of a mill's program for a printer's controller is a tool; its G92 E0 extrudes nothing.
TEST(Printer, OnlyMotionsExtrude) {
  Diagnostics diagnostics;
  const auto mill = read_gcode("G92 E0\nT3\nG1 X9 F100\n", {.dialect = GcodeDialect::reprap}, diagnostics);
  EXPECT_TRUE(mill.path.has(StepKind::tool_change));
  const auto print =
      read_gcode("G92 E0\nT3\nG1 X9 E1 F100\n", {.dialect = GcodeDialect::reprap}, diagnostics);
  EXPECT_TRUE(print.path.has(StepKind::extruder));
}

/// Marlin's M207 is in the units of the program (G20); the step has mm.
TEST(Printer, LengthsOfRetractionsAreInUnits) {
  Diagnostics diagnostics;
  const auto program =
      read_gcode("G20\nM207 S0.05 F100 Z0.01\nG10\n", {.dialect = GcodeDialect::marlin}, diagnostics);
  ASSERT_EQ(program.path.size(), 2u);
  EXPECT_EQ(program.path.text(0), "M207 S1.27 F2540 Z0.254");
  EXPECT_EQ(program.path.text(1), "G10");
}

TEST(Printer, PausesOfKlipperAndRepRapFirmwareArePauses) {
  Diagnostics diagnostics;
  const auto klipper = read_gcode("PAUSE\n", {.dialect = GcodeDialect::klipper}, diagnostics);
  const auto reprap = read_gcode("M226\n", {.dialect = GcodeDialect::reprap}, diagnostics);
  EXPECT_EQ(klipper.path.text(0), "gcode_flavor = klipper");  // of the planner
  for (const Toolpath* path : {&klipper.path, &reprap.path})
    EXPECT_EQ((*path)[path->size() - 1].kind(), StepKind::pause);
  EXPECT_EQ(klipper.path.size(), 2u);
  EXPECT_EQ(reprap.path.size(), 1u);
}

/// The limits with which a slicer computes the time are notes before the first step, also those of its end.
TEST(Printer, LimitsOfSlicersAreNotes) {
  const std::string settings =
      "; machine_max_acceleration_x = 16000,9000\n; machine_max_feedrate_x = 0\n;machine_max_jerk_y = 10\n"
      "; the machine_max_jerk_z = 3\n; machine_max_other = 4\n";
  for (const auto& [usage, count] :
       {std::pair{"time_estimate_only", 2u}, {"emit_to_gcode", 2u}, {"ignore", 0u}}) {
    Diagnostics diagnostics;
    const std::string text = "G1 X9 F100\n" + settings + "; machine_limits_usage = " + usage + "\n";
    const auto program = read_gcode(text, {.dialect = GcodeDialect::marlin}, diagnostics);
    ASSERT_EQ(program.path.size(), count + 1) << usage;
    if (count == 0) continue;
    EXPECT_EQ(program.path.text(0), "machine_max_acceleration_x = 16000,9000");
    EXPECT_EQ(program.path.text(1), "machine_max_jerk_y = 10");
  }
}

TEST(Printer, KlippersVelocityLimitsAreReadWordByWord) {
  Diagnostics diagnostics;
  const auto program = read_gcode("SET_VELOCITY_LIMIT VELOCITY=200 ACCEL_TO_DECEL=1500 ACCEL=3000\n",
                                  {.dialect = GcodeDialect::klipper}, diagnostics);
  ASSERT_EQ(program.path.size(), 4u);
  EXPECT_EQ(program.path[1].motion_limits().kind, LimitKind::axis_speed);
  EXPECT_EQ(program.path[2].motion_limits().kind, LimitKind::acceleration);
  EXPECT_EQ(program.path.text(3), "SET_VELOCITY_LIMIT ACCEL_TO_DECEL=1500");
}

/// A macro may home before the first bead; between beads only one that is named for it.
TEST(Printer, MacrosLoseThePosition) {
  for (const auto& [line, before, after] : {std::tuple{"START_PRINT BED=60", 6u, 6u},
                                            {"MY_MACRO", 6u, 0u},
                                            {"HOME_ALL", 6u, 6u},
                                            {"SET_PIN PIN=led VALUE=1", 6u, 0u},
                                            {"RESPOND MSG=a", 0u, 0u},
                                            {"M117 ready", 0u, 0u}}) {
    for (const bool bead : {false, true}) {
      Diagnostics diagnostics;
      const std::string text =
          std::string("M83\nG1 X10 Y20 Z5 F600\n") + (bead ? "G1 X20 E1\n" : "") + line + "\nG1 X30\n";
      const auto program = read_gcode(text, {.dialect = GcodeDialect::klipper}, diagnostics);
      EXPECT_EQ(program.path[program.path.size() - 1].unknown_axes(), bead ? after : before) << line;
    }
  }
}

/// Bambu's G392 switches the detection of clogs, G29.2 the correction by the surface of the bed.
TEST(Printer, CodesThatMoveNothingAreKept) {
  for (const char* line : {"G392 S0", "G29.2 S1"}) {
    Diagnostics diagnostics;
    const auto program = read_gcode(std::string("G1 X1 Y2 Z3 F600\n") + line + "\nG1 X5\n",
                                    {.dialect = GcodeDialect::marlin}, diagnostics);
    ASSERT_EQ(program.path.size(), 3u) << line;
    EXPECT_EQ(program.path.text(1), line);
    EXPECT_EQ(program.path[2].unknown_axes(), 0u);
    EXPECT_TRUE(diagnostics.list().empty());
  }
}

/// The motors are switched off where the program does so, with the words of the line.
TEST(Printer, SwitchingTheMotorsOffIsKept) {
  Diagnostics diagnostics;
  const auto program =
      read_gcode("M84\nM84 S60\nM84 X Y E\n", {.dialect = GcodeDialect::marlin}, diagnostics);
  ASSERT_EQ(program.path.size(), 3u);
  EXPECT_EQ(program.path.text(0), "M84");
  EXPECT_EQ(program.path.text(1), "M84 S60");
  EXPECT_EQ(program.path.text(2), "M84 X Y E");
}

/// Words of slicers' start and end programs: no errors and no warnings, and the position is unknown after a
/// procedure.
TEST(Printer, WordsOfSlicersAreHarmless) {
  const char* const kLines[] = {"M84 X Y E",
                                "M18 E",
                                "G28 X",
                                "G28 X Y",
                                "G28 W",
                                "G28 O",
                                "G4",
                                "G4 S3",
                                "M862.3 P \"MK3S\"",
                                "G29 A",
                                "G29",
                                "G29 P1",
                                "G29.3",
                                "G39.4",
                                "G80",
                                "G150.3",
                                "G380 S2 Z-25 F300",
                                "M221 S95",
                                "M569 S1 X Y",
                                "M1002 gcode_claim_action : 2",
                                "M620 S0A",
                                "M1006 W",
                                "M1006 A0 B10 L100",
                                "T1000",
                                "T0",
                                "M73 P50 R5",
                                "M73 Q50 S5",
                                "M486 AName of object",
                                "G10",
                                "G11"};
  for (const char* line : kLines) {
    for (const GcodeDialect dialect : {GcodeDialect::marlin, GcodeDialect::klipper}) {
      Diagnostics diagnostics;
      GcodeReadOptions options;
      options.dialect = dialect;
      const auto program = read_gcode(kHead + line + "\nG1 X5 F600\n", options, diagnostics);
      for (const Diagnostic& d : diagnostics.list()) EXPECT_EQ(d.severity, Severity::note) << to_string(d);
      const Step& last = program.path[program.path.size() - 1];
      const bool procedure = line[0] == 'G' && line[1] != '4' && std::string(line).rfind("G1", 0) != 0;
      const bool homes_x_only = std::string(line) == "G28 X";
      const bool loses_y = std::string(line) == "G28 X Y" || std::string(line) == "M84 X Y E";
      const unsigned unknown = std::string(line) == "G150.3" ? 6u
                               : loses_y                     ? 2u
                               : !procedure || homes_x_only  ? 0u
                                                             : 6u;
      EXPECT_EQ(last.unknown_axes(), unknown) << line;
      if (line[0] == 'T') {
        const Step& change = program.path[program.path.size() - 2];
        ASSERT_EQ(change.kind(), StepKind::tool_change) << line;
        EXPECT_EQ(change.tool_change().tool, std::stoi(line + 1));
      }
    }
  }
}

GcodeProgram read_as(GcodeDialect dialect, const std::string& text) {
  Diagnostics diagnostics;
  GcodeReadOptions options;
  options.dialect = dialect;
  GcodeProgram program = read_gcode(text, options, diagnostics);
  for (const Diagnostic& d : diagnostics.list()) EXPECT_EQ(d.severity, Severity::note) << to_string(d);
  return program;
}

/// Extruders, and heaters with theirs, in their order.
std::string extruders_of(const Toolpath& path) {
  std::string text;
  for (const Step& s : path.steps()) {
    if (s.kind() == StepKind::extruder) text += "T" + std::to_string(s.extruder().number) + " ";
    if (s.kind() == StepKind::temperature)
      text += "S" + std::to_string(int(s.temperature().celsius)) + "T" +
              std::to_string(s.temperature().extruder) + " ";
    EXPECT_NE(s.kind(), StepKind::tool_change);
  }
  return text;
}

TEST(Printer, ToolsOfAPrintAreExtruders) {
  const std::string text =
      "M104 T1 S205\nM109 S210\nT0\nG28\nM83\nG1 X0 Y0 Z0.2 F600\nG1 X5 E1\nT1\nM104 S0 T0\nG1 X9 E1\n";
  for (const GcodeDialect dialect : {GcodeDialect::marlin, GcodeDialect::klipper, GcodeDialect::reprap})
    EXPECT_EQ(extruders_of(read_as(dialect, text).path), "S205T1 S210T-1 T0 T1 S0T0 ");
}

TEST(Printer, ToolsOfAMillAreTools) {
  const auto program =
      read_as(GcodeDialect::marlin, "G21\nT1\nM3 S9000\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG1 X9 ; E1\n");
  ASSERT_TRUE(program.path.has(StepKind::tool_change));
  EXPECT_FALSE(program.path.has(StepKind::extruder));
}

TEST(Printer, KlippersExtrudersHaveNames) {
  const std::string text =
      "ACTIVATE_EXTRUDER EXTRUDER=extruder1\nG28\nG1 X0 Y0 Z0.2 F600\nG1 X5 E1\nACTIVATE_EXTRUDER "
      "EXTRUDER=extruder\n";
  EXPECT_EQ(extruders_of(read_as(GcodeDialect::klipper, text).path), "T1 T0 ");
}

TEST(Printer, TemperaturesOfToolsAreThoseOfTheirExtruders) {
  const std::string text = "G10 P0 S200\nG10 P1 S210\nM116\nG28\nG1 X0 Y0 Z0.2 F600\nG1 X5 E1\n";
  EXPECT_EQ(extruders_of(read_as(GcodeDialect::reprap, text).path), "S200T0 S210T1 S200T0 S210T1 ");
}

/// Klipper starts E at 0 with another extruder; the other firmwares have one coordinate for all.
TEST(Printer, TheFilamentPositionAfterAChangeOfTheExtruder) {
  const std::string text = kHead + "M82\nT0\nG1 X5 E4\nT1\nG1 X9 E5\n";
  const auto last = [&](GcodeDialect dialect) {
    GcodeReadOptions options;
    options.dialect = dialect;
    return beads(text, options).back().volume.mm3() / kUsual;
  };
  EXPECT_NEAR(last(GcodeDialect::marlin), 1.0, 1e-9);
  EXPECT_NEAR(last(GcodeDialect::reprap), 1.0, 1e-9);
  EXPECT_NEAR(last(GcodeDialect::klipper), 5.0, 1e-9);
}

TEST(Printer, FactorsOfFlowAreThoseOfAnExtruder) {
  const auto b =
      beads(kHead + "M83\nM221 S90\nM221 S50 T1\nG1 X5 E1\nT1\nG1 X9 E1\nT0\nM221 S100\nG1 X2 E1\n");
  ASSERT_EQ(b.size(), 3u);
  EXPECT_NEAR(b[0].volume.mm3(), 0.9 * kUsual, 1e-9);
  EXPECT_NEAR(b[1].volume.mm3(), 0.5 * kUsual, 1e-9);
  EXPECT_NEAR(b[2].volume.mm3(), kUsual, 1e-9);
}

TEST(Printer, FactorsOfSpeedHoldUntilTheNext) {
  const auto b =
      beads(kHead + "M83\nG1 X5 E1 F1000\nM220 B\nM220 S50\nG1 X9 E1\nG1 X2 E1 F600\nM220 R\nG1 X9 E1\n");
  ASSERT_EQ(b.size(), 4u);
  EXPECT_NEAR(b[0].feed.mm_per_min(), 1000, 1e-9);
  EXPECT_NEAR(b[1].feed.mm_per_min(), 500, 1e-9);
  EXPECT_NEAR(b[2].feed.mm_per_min(), 300, 1e-9);
  EXPECT_NEAR(b[3].feed.mm_per_min(), 600, 1e-9);
}

TEST(Printer, FactorsThatNoFirmwareTakesAreSkippedWithAWarning) {
  for (const std::string line : {"M220 S0", "M221 S1e8"}) {
    Diagnostics diagnostics;
    GcodeReadOptions options;
    options.dialect = GcodeDialect::marlin;
    const auto program = read_gcode(kHead + "M83\n" + line + "\nG1 X5 E1 F1000\n", options, diagnostics);
    ASSERT_EQ(diagnostics.list().size(), 1u) << line;
    EXPECT_EQ(diagnostics.list()[0].severity, Severity::warning);
    EXPECT_EQ(diagnostics.list()[0].code, codes::word_out_of_range);
    EXPECT_NEAR(program.path.extrude(program.path.size() - 1).volume.mm3(), kUsual, 1e-9);
  }
}

TEST(Printer, FilamentIsRetractedWhileMovingToo) {
  const auto b = beads(kHead + "M83\nG1 X10 E1\nG1 X5 E-0.5\nG1 E-0.25\nG1 X5\n");
  ASSERT_EQ(b.size(), 3u);
  EXPECT_NEAR(b[1].volume.mm3(), -0.5 * kUsual, 1e-9);
  EXPECT_EQ(b[1].to, (Point3{5, 0, 0.2}));
  EXPECT_NEAR(b[2].volume.mm3(), -0.25 * kUsual, 1e-9);
}

TEST(Printer, RelativeMovesOfMarlinAreThoseOfTheFilamentToo) {
  const std::string text = kHead + "G92 E5\nG91\nG1 X10 E1\nG90\nG1 X20 E7.5\n";
  const auto marlin = beads(text);
  ASSERT_EQ(marlin.size(), 2u);
  EXPECT_NEAR(marlin[0].volume.mm3(), kUsual, 1e-9);
  EXPECT_NEAR(marlin[1].volume.mm3(), 1.5 * kUsual, 1e-9);
  GcodeReadOptions options;
  options.dialect = GcodeDialect::klipper;
  EXPECT_NEAR(beads(text, options)[0].volume.mm3(), -4.0 * kUsual, 1e-9);
}

TEST(Printer, VolumesCanBeGivenDirectly) {
  const auto b = beads(kHead + "M83\nM200 D1.75\nG1 X10 E3\nM200 D0\nG1 X20 E3\nM200 S1\nG1 X30 E2\n");
  ASSERT_EQ(b.size(), 3u);
  EXPECT_NEAR(b[0].volume.mm3(), 3.0, 1e-9);
  EXPECT_NEAR(b[1].volume.mm3(), 3.0 * kUsual, 1e-9);
  EXPECT_NEAR(b[2].volume.mm3(), 2.0, 1e-9);
}

TEST(Printer, CommentsGiveTheSizesOfBeads) {
  const auto b = beads(kHead +
                       "M83\nG1 X10 E1\n;HEIGHT:0.3\n;WIDTH:0.45\nG1 X20 E1\n; LAYER_HEIGHT: 0.2\n"
                       "; LINE_WIDTH: 0.42\nG1 X30 E1\n;Layer height: 0.1\n;HEIGHT:nonsense\nG1 X40 E1\n");
  ASSERT_EQ(b.size(), 4u);
  EXPECT_EQ(b[0].width, mm(0));
  EXPECT_EQ(b[1].width, mm(0.45));
  EXPECT_EQ(b[1].height, mm(0.3));
  EXPECT_EQ(b[2].width, mm(0.42));
  EXPECT_EQ(b[2].height, mm(0.2));
  EXPECT_EQ(b[3].height, mm(0.2));
  Diagnostics diagnostics;
  const auto milled = read_gcode(";HEIGHT:0.3\nG1 X10 F100\nM2\n", {}, diagnostics);
  EXPECT_EQ(milled.dialect, GcodeDialect::rs274);
}

TEST(Printer, CommentsGiveTheKindsOfBeads) {
  const auto list = beads(kHead +
                          "M83\nG1 X1 E1\n;TYPE:Outer wall\n"
                          "G1 X2 E1\nG1 X3 E1\n;TYPE:Bridge\nG1 X4 E1\n");
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(list[0].kind, BeadKind::none);
  EXPECT_EQ(list[1].kind, BeadKind::outer_wall);
  EXPECT_EQ(list[2].kind, BeadKind::outer_wall);
  EXPECT_EQ(list[3].kind, BeadKind::bridge);
}

std::vector<step::MotionLimits> limits(const std::string& line, GcodeDialect dialect) {
  Diagnostics diagnostics;
  GcodeReadOptions options;
  options.dialect = dialect;
  const auto program = read_gcode(kHead + line + "\n", options, diagnostics);
  std::vector<step::MotionLimits> out;
  for (const Step& s : program.path.steps())
    if (s.kind() == StepKind::motion_limits) out.push_back(s.motion_limits());
  return out;
}

TEST(Printer, LimitsOfMotionsAreSteps) {
  constexpr GcodeDialect marlin = GcodeDialect::marlin, reprap = GcodeDialect::reprap;
  const auto both = limits("M204 S800", marlin);  // beads and travel
  ASSERT_EQ(both.size(), 1u);
  EXPECT_EQ(both[0].given, 5u);
  EXPECT_EQ(both[0].values[0], 800);
  EXPECT_EQ(both[0].values[2], 800);
  const auto three = limits("M204 P1000 R1200 T1500 ; all", marlin);
  ASSERT_EQ(three.size(), 1u);
  EXPECT_EQ(three[0].values, (std::array<double, 4>{1000, 1200, 1500, 0}));
  const auto jerk = limits("M205 X8 Y9 J0.02", marlin);
  ASSERT_EQ(jerk.size(), 2u);
  EXPECT_EQ(jerk[0].kind, LimitKind::jerk);
  EXPECT_EQ(jerk[0].given, 3u);
  EXPECT_EQ(jerk[1].kind, LimitKind::junction_deviation);
  EXPECT_EQ(jerk[1].values[0], 0.02);
  const auto slow = limits("M203 X6000", reprap), fast = limits("M203 X100", marlin);
  ASSERT_TRUE(slow.size() == 1 && fast.size() == 1);
  EXPECT_EQ(slow[0].values[0], 100);  // mm/min there
  EXPECT_EQ(fast[0].values[0], 100);
  const auto own = limits("SET_VELOCITY_LIMIT ACCEL=3000 SQUARE_CORNER_VELOCITY=6", GcodeDialect::klipper);
  ASSERT_EQ(own.size(), 2u);
  EXPECT_EQ(own[0].values[2], 3000);
  EXPECT_EQ(own[1].kind, LimitKind::corner_speed);
}

TEST(Printer, RepRapFirmwareSetsTemperaturesOfToolsToo) {
  Diagnostics diagnostics;
  GcodeReadOptions options;
  options.dialect = GcodeDialect::reprap;
  const auto program =
      read_gcode("G10 S205 P0 ; set temperature\nG28\nM116 ; wait\nG10\n", options, diagnostics);
  ASSERT_EQ(program.path.size(), 4u);
  EXPECT_EQ(program.path.text(3), "G10");  // retraction by the firmware
  EXPECT_EQ(program.path[0].temperature().celsius, 205);
  EXPECT_FALSE(program.path[0].temperature().wait);
  EXPECT_TRUE(program.path[2].temperature().wait);
  EXPECT_EQ(program.path[2].temperature().celsius, 205);
}

TEST(Printer, MinimumFeedsOfZeroAreNoLimit) {
  Diagnostics diagnostics;
  GcodeReadOptions options;
  options.dialect = GcodeDialect::marlin;
  const auto program = read_gcode("M205 S0 T0 ; none\nM205 S5\n", options, diagnostics);
  ASSERT_EQ(program.path.size(), 1u);
  EXPECT_EQ(program.path.text(0), "M205 S5");
}

/// They stay lines that are passed on.
TEST(Printer, LimitsWithOtherWordsAreLeftAsTheyAre) {
  for (const char* line :
       {"M204", "M204 P-5", "M204 Pfast", "M204 P1e99", "M205 B20000", "M201 Q5", "M566 X60"})
    EXPECT_TRUE(limits(line, GcodeDialect::marlin).empty()) << line;
  EXPECT_TRUE(limits("SET_VELOCITY_LIMIT ACCEL=nan", GcodeDialect::klipper).empty());
  EXPECT_TRUE(limits("SET_VELOCITY_LIMIT MINIMUM_CRUISE_RATIO=0.5", GcodeDialect::klipper).empty());
}

TEST(Printer, FansOfRepRapFirmwareAreFractionsToo) {
  for (const auto& [line, fraction] : {std::pair{"M106 S0.5", 0.5}, {"M106 S1", 1.0}, {"M106 S255", 1.0}}) {
    Diagnostics diagnostics;
    GcodeReadOptions options;
    options.dialect = GcodeDialect::reprap;
    const auto program = read_gcode(kHead + line + "\n", options, diagnostics);
    EXPECT_EQ(program.path[program.path.size() - 1].fan().fraction, fraction) << line;
  }
}

TEST(Printer, ProgramsNeedNoEnd) {
  Diagnostics diagnostics;
  GcodeReadOptions options;
  options.dialect = GcodeDialect::marlin;
  read_gcode(kHead, options, diagnostics);
  EXPECT_TRUE(diagnostics.list().empty()) << to_string(diagnostics.list().front());
}

TEST(Printer, TheFilamentDiameterIsThatOfTheOptionsElseOfTheComments) {
  const double area = std::numbers::pi / 4.0 * 2.85 * 2.85;
  EXPECT_NEAR(beads("; filament_diameter = 2.85\n" + kHead + "M83\nG1 X10 E1\n")[0].volume.mm3(), area, 1e-9);
  GcodeReadOptions options;
  options.filament_diameter = 1.0;  // the caller's value has precedence
  EXPECT_NEAR(beads("; filament_diameter = 2.85\n" + kHead + "M83\nG1 X10 E1\n", options)[0].volume.mm3(),
              std::numbers::pi / 4.0, 1e-9);
}

TEST(Printer, FilamentInInchesIsConverted) {
  const auto made = beads("M104 S200\nG20\nM83\nG1 X0 Y0 Z0.01 F20\nG1 X1 E0.5\n");
  ASSERT_EQ(made.size(), 1u);
  EXPECT_NEAR(made[0].volume.mm3(), 0.5 * 25.4 * kUsual, 1e-9);
  EXPECT_NEAR(made[0].to.x, 25.4, 1e-9);
}

}  // namespace
}  // namespace kerf::test

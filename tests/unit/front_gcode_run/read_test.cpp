// Reading of G-code beyond the moves: settings as steps, unknown axes, feeds, tools and stock of comments,
// limits.
#include <cmath>
#include <gtest/gtest.h>

#include "base/codes/gcode.h"

#include "kerf/program/gcode.h"

namespace kerf {
namespace {

struct Reading {
  GcodeProgram program;
  Diagnostics diagnostics;
  const Step& operator[](std::size_t i) const { return program.path[i]; }
  std::size_t size() const { return program.path.size(); }
};

Reading read(std::string_view text, GcodeReadOptions options = {}) {
  Reading r;
  r.program = read_gcode(text, options, r.diagnostics);
  return r;
}

std::string kinds(const Toolpath& path) {
  std::string text;
  for (const Step& s : path.steps())
    text += std::string(text.empty() ? "" : " ") + std::string(name_of(s.kind()));
  return text;
}

double feed_of(const Reading& r, std::size_t i) { return r[i].feed().mm_per_min(); }

TEST(ReadGcode, SettingsBecomeStepsInTheOrderOfTheirEffect) {
  const Reading r =
      read("G21\nM8 M3 M6 T102 S16000 G61.1 X1 G0\nG64 P0.02\nM7\nM9\nS9000\nM4\nM5\nM0\nG4 P1.5\nM30\n");
  EXPECT_TRUE(r.diagnostics.list().empty()) << to_string(r.diagnostics.list().front());
  ASSERT_EQ(kinds(r.program.path),
            "tool spindle coolant pathmode rapid pathmode coolant coolant spindle spindle spindle pause "
            "dwell end");
  EXPECT_EQ(r[0].tool_change().tool, 102);
  EXPECT_EQ(r[1].spindle().speed, rpm(16000));
  EXPECT_EQ(r[1].spindle().turn, SpindleTurn::cw);
  EXPECT_TRUE(r[2].coolant().flood);
  EXPECT_EQ(r[3].path_mode().kind, PathModeKind::exact_stop);
  EXPECT_EQ(r[5].path_mode().tolerance, mm(0.02));
  EXPECT_TRUE(r[6].coolant().mist && r[6].coolant().flood);
  EXPECT_FALSE(r[7].coolant().mist || r[7].coolant().flood);
  EXPECT_EQ(r[8].spindle().speed, rpm(9000));
  EXPECT_EQ(r[9].spindle().turn, SpindleTurn::ccw);
  EXPECT_EQ(r[10].spindle().turn, SpindleTurn::off);
  EXPECT_EQ(r[11].pause().kind, PauseKind::always);
  EXPECT_NEAR(r[12].dwell().time.seconds(), 1.5, 1e-12);
  EXPECT_TRUE(r[13].end().rewind);
  EXPECT_TRUE(r.program.ended);
}

TEST(ReadGcode, StepsHaveTheirLineAndColumn) {
  const Reading r = read("\n  G0 X1\n\n N5 G81 X1 Z-1 R1 F50\nM2");
  EXPECT_EQ(to_string(r.program.path.origin_of(0)), "<text>:2:3");
  EXPECT_EQ(to_string(r.program.path.origin_of(1)), "<text>:4:5");
  EXPECT_EQ(to_string(r.program.path.origin_of(3)), "<text>:4:5");
  EXPECT_EQ(r[1].origin(), r[3].origin());
}

const Step& last_motion(const Reading& r) { return r[*r.program.path.motion_before(r.size())]; }

/// The heights of a cycle may be measured ones: the height after it is unknown if that of R is.
TEST(ReadGcode, HeightIsUnknownAfterCycleToMeasuredPlane) {
  const Reading depth = read("F9 G0 X0 Y0 Z9\nG38.2 Z-9\nG82 P1 X1 R5 Z[#5063+1]\nM2");
  EXPECT_EQ(last_motion(depth).unknown_axes(), 0u);
  EXPECT_EQ(last_motion(depth).to(), (Point3{1, 0, 5}));
  const Reading plane = read("F9 G0 X0 Y0 Z9\nG38.2 Z-9\nG82 P1 X1 R[#5063+5] Z-9\nX2\nM2");
  EXPECT_EQ(last_motion(plane).unknown_axes(), 4u);
  const Reading hole = read("F9 G19 G0 X0 Y0 Z9\nG38.2 Y-9\nG81 Y[#5062+1] R5 X[#5062+1]\nM2");
  EXPECT_EQ(last_motion(hole).unknown_axes(), 2u);
}

TEST(ReadGcode, AxesBecomeKnownWhenCommandedInWorkCoordinates) {
  const Reading r = read("G0 Z5\nG91 X1\nG90 X2\nG53 Z-5\nG0 Y3\nZ1\nG28 G91 Z0\nG90 G0 Z2\nM2");
  const unsigned want[] = {3, 3, 2, 6, 4, 0, 0, 4, 0};
  ASSERT_EQ(r.size(), 10u);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(r[i].unknown_axes(), want[i]) << i;
  EXPECT_EQ(r[3].to(), (Point3{2, 0, -5}));
}

TEST(ReadGcode, FeedsOfAllModes) {
  const Reading mm_mode = read("G21 G1 X10 F300\nX20\nF120\nX30\nM2");
  EXPECT_EQ(feed_of(mm_mode, 0), 300);
  EXPECT_EQ(feed_of(mm_mode, 1), 300);
  EXPECT_EQ(feed_of(mm_mode, 2), 120);
  EXPECT_NEAR(feed_of(read("G20\nG1 X10 F10\nM2"), 0), 254, 1e-9);
  const Reading inverse = read("G93 G1 X10 F2\nX20 F4\nM2");
  EXPECT_NEAR(feed_of(inverse, 0), 20, 1e-12);
  EXPECT_NEAR(feed_of(inverse, 1), 40, 1e-12);
  const Reading arc = read("G0 X10\nG93 G3 X0 Y10 I-10 F2\nM2");
  EXPECT_NEAR(feed_of(arc, 1), 31.41592653589793, 1e-9);
  EXPECT_NEAR(feed_of(read("S1000 M3\nG95 G1 X10 F0.1\nM2"), 1), 100, 1e-12);
}

TEST(ReadGcode, UnitsHoldForTheFeedOfTheirLine) {
  const Reading r = read("G20 F6\nG1 X1\nM2");
  EXPECT_NEAR(feed_of(r, 0), 152.4, 1e-9);
  EXPECT_TRUE(r.program.inch);
  ASSERT_EQ(r.diagnostics.list().size(), 1u);
  EXPECT_EQ(r.diagnostics.list()[0].code, codes::feed_with_units);
  EXPECT_EQ(r.diagnostics.list()[0].severity, Severity::note);
  EXPECT_FALSE(read("G21 G0 X1\nG20 X2\nM2").program.inch);
}

TEST(ReadGcode, ShiftedZeroKeepsTheFrameOfWhatWasCutBefore) {
  const Reading r = read("G0 X10 Y0\nG92 X0\nG0 X5\nG2 X7 I1 F10\nG92.2\nG0 X5\nG92.3\nX5\nG92.1\nX5\nM2");
  EXPECT_EQ(r[1].to().x, 15);
  EXPECT_EQ(r[2].to().x, 17);
  EXPECT_EQ(r[2].arc().centre.x, 16);
  EXPECT_EQ(r[3].to().x, 5);
  EXPECT_EQ(r[4].to().x, 15);
  EXPECT_EQ(r[5].to().x, 5);
  const Reading first = read("G92 X3 Y4\nG91 G0 X1\nM2");  // unknown before: the coordinates as given
  EXPECT_EQ(first[1].to(), (Point3{4, 4, 0}));
  EXPECT_EQ(first[1].unknown_axes(), 4u);
}

/// A home is stored in machine coordinates: where the tip is there depends on the tool's length.
TEST(ReadGcode, HeightsOfHomesAreUnknownAfterAnotherToolLength) {
  for (const char* length : {"G43 H1", "G43.1 Z5", "G49"}) {
    const Reading r = read(std::string("G0 X1 Y2 Z3\nG28.1\nG0 X9\n") + length + "\nG0 Z8\nG28\nM2");
    ASSERT_EQ(r.size(), 8u);
    EXPECT_EQ(r[4].unknown_axes(), 0u) << length;
    EXPECT_EQ(r[6].reference(), Reference::home);
    EXPECT_EQ(r[6].unknown_axes(), 4u) << length;
    EXPECT_EQ(r[6].to().x, 1.0);
  }
}

/// LinuxCNC moves to the values that a program has assigned to the parameters of its homes.
TEST(ReadGcode, AnAssignedHomeIsInMachineCoordinates) {
  const Reading r = read("G20\n#5161=1 #5162=2 #5163=4\nG0 X1 Y2 Z3\nG28\nG28 Z5\nM2");
  ASSERT_EQ(r.size(), 6u);
  EXPECT_EQ(r[2].reference(), Reference::machine);
  EXPECT_EQ(r[2].unknown_axes(), 7u);
  EXPECT_EQ(r[2].to(), (Point3{25.4, 50.8, 101.6}));
  EXPECT_EQ(r[4].reference(), Reference::machine);
  EXPECT_EQ(r[4].to().z, 101.6);
}

TEST(ReadGcode, AHomeOfWhichSomeAxesAreAssignedIsKnownToTheControllerAlone) {
  const Reading r = read("G0 X1 Y2 Z3\n#5181=1\nG30\nG30 X3\nG0 X1 Y2 Z3\nG30.1\nG30\nM2");
  ASSERT_EQ(r.size(), 10u);
  EXPECT_EQ(r[2].reference(), Reference::measured);
  EXPECT_EQ(r[4].reference(), Reference::machine);
  EXPECT_EQ(r[8].unknown_axes(), 0u) << "stored again by G30.1";
}

/// The controller has stored the shift of a G92 at an unknown position, so that G92.1 to G92.3 matter to it.
TEST(ReadGcode, AShiftOfUnknownSizeEndsOnlyWithG921) {
  for (const auto& [words, ends] :
       {std::pair("G92.3", 1u), std::pair("G92.2\nG92.3", 2u), std::pair("G92.2\nG92.2\nG92.3", 2u)}) {
    const Reading r = read(std::string("G92 X5\n") + words + "\nG0 X1\nG92.1\nM2");
    unsigned zeros = 0;
    for (const Step& s : r.program.path.steps())
      zeros += s.kind() == StepKind::work_zero && s.work_zero().kind != ZeroKind::shift;
    EXPECT_EQ(zeros, ends + 1) << words;
  }
}

TEST(ReadGcode, RepeatsOfPolarWordsAreOnACircle) {
  const Reading r = read("S9 M4 F100 G0 X10 Y0 Z5\nG91 G81 ^20 Z-1 R1 L17\nM2");
  int holes = 0;
  const auto& steps = r.program.path.steps();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].kind() != StepKind::cut) continue;
    const double angle =
        20.0 * ++holes * 3.14159265358979 / 180.0;  // each 20 degrees after the one before it
    EXPECT_NEAR(steps[i].to().x, 10 * std::cos(angle), 1e-9) << holes;
    EXPECT_NEAR(steps[i].to().y, 10 * std::sin(angle), 1e-9) << holes;
  }
  EXPECT_EQ(holes, 17);
}

TEST(ReadGcode, OffsetsInParametersTakeEffectWhereTheirSystemIsSelected) {
  const Reading r = read("#5221=30\nG0 X5\nG54 X6\nG55 X7\nG54 X8\nM2");
  EXPECT_EQ(r[0].to().x, 5);
  std::vector<double> ends;
  for (const Step& s : r.program.path.steps())
    if (s.is_motion()) ends.push_back(s.to().x);
  EXPECT_EQ(ends, (std::vector<double>{5, 6, 7, 38}))
      << "as LinuxCNC: G54 is in force already in the third line";
}

TEST(ReadGcode, ArcsInOtherPlanesTurnWithTheCoordinates) {
  const Reading r = read("F100 G0 X0 Y0 Z5\nG10 L2 P1 R90\nG18 G2 X10 Z5 I5\nM2");
  std::size_t cuts = 0;
  for (const Step& s : r.program.path.steps()) {
    if (!s.is_cutting()) continue;
    ++cuts;  // X of the program is Y of the toolpath
    EXPECT_NEAR(s.to().x, 0, 1e-9);
    EXPECT_NEAR(std::hypot(s.to().y - 5, s.to().z - 5), 5, 1e-9);
    EXPECT_LE(s.to().z, 5 + 1e-9) << "seen from +Y, G2 passes below";
  }
  EXPECT_GT(cuts, 20u);
}

TEST(ReadGcode, ProbesAndRotaryAxes) {
  const Reading r = read("F50 G38.3 Z-5\nG1 X5 A90\nG91 X1 A5 C-1\nM2");
  EXPECT_EQ(r[0].probe().kind, ProbeKind::contact);
  EXPECT_EQ(r[0].to().z, -5);
  EXPECT_EQ(r.program.path.extra(0), nullptr);
  ASSERT_NE(r.program.path.extra(2), nullptr);
  EXPECT_EQ((*r.program.path.extra(1)->abc)[0], 90);
  EXPECT_EQ((*r.program.path.extra(2)->abc)[0], 95);
  EXPECT_EQ((*r.program.path.extra(2)->abc)[2], -1);
}

/// Step::named_axes: bits 1 to 32 are X, Y, Z, A, B, C.
TEST(ReadGcode, MotionsNameTheAxesOfTheirWords) {
  const Reading r = read("F50 G1 X5 A90\nB1 C1\nY1\nG53 G0 Z1 A0\nM2");
  const unsigned want[] = {1 + 8, 16 + 32, 2, 4 + 8};
  ASSERT_EQ(r.size(), 5u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(r[i].named_axes(), want[i]) << i;
}

TEST(ReadGcode, ToolsAndStockOfComments) {
  const Reading r = read(
      "(stockMin:0.00mm, 0.00mm, -1.00mm)\n(stockMax:100.00mm, 50.00mm, 0.00mm)\nG90 G21\n"
      "(TOOL/MILL,3.175, 0.00, 12.7, 0.00)\nM6T102\nG0 X1\nM6 T2\n(TOOL/MILL, 6.35, 3.175, 12.7, 0)\nG0 X2\n"
      "G20\n(TOOL/MILL, 0.125, 0, 0.5, 0)\nT3\nM6\nM2\n");
  ASSERT_TRUE(r.program.stock);
  EXPECT_EQ(r.program.stock->block.high, (Point3{100, 50, 0}));
  ASSERT_EQ(r.program.tools.size(), 3u);
  EXPECT_NEAR(r.program.tools.at(102).diameter.mm(), 3.175, 1e-12);
  EXPECT_EQ(name_of(r.program.tools.at(2).shape), "ball");
  EXPECT_NEAR(r.program.tools.at(3).diameter.mm(), 3.175, 1e-12);
}

TEST(ReadGcode, TheHandRetractionOfG88IsARapid) {
  const Reading r = read("M3 S100\nG0 Z5\nG88 X10 Z-3 R2 P0.5 F9\nM2");
  ASSERT_EQ(kinds(r.program.path),
            "spindle rapid rapid rapid cut dwell spindle pause rapid spindle spindle end");
  EXPECT_EQ(r[7].pause().kind, PauseKind::always);
  EXPECT_EQ(r[8].to(), (Point3{10, 0, 2}));
}

TEST(ReadGcode, MotionCodesAloneSetTheModeInAHeader) {
  const Reading r = read("G1 G17\nG20\nX1 F1\nG1\nM2");
  ASSERT_EQ(kinds(r.program.path), "cut cut end");  // the second is of length 0
  EXPECT_TRUE(r.program.inch);
  EXPECT_TRUE(r.diagnostics.list().empty()) << to_string(r.diagnostics.list().front());
}

TEST(ReadGcode, MessagesForTheOperatorAreKept) {
  const Reading r = read("(MSG, turn the part)\n(just a comment)\nG0 X1\nM2");
  ASSERT_EQ(kinds(r.program.path), "note rapid end");
  EXPECT_EQ(r.program.path.text(0), "turn the part");
}

TEST(ReadGcode, TheEndStopsOrNot) {
  const std::string text = "G18 G91 M3 S100\nG0 X1\nM30\n%\nX5 Z5\nM2";
  const Reading stop = read(text);
  EXPECT_EQ(kinds(stop.program.path), "spindle rapid spindle end");
  EXPECT_TRUE(stop.program.ended);
  const Reading on = read(text, {.after_end = AfterEnd::read_on});
  ASSERT_EQ(kinds(on.program.path), "spindle rapid spindle end cut end");
  EXPECT_EQ(on[4].to(), (Point3{5, 0, 5}));  // the end set G90 and G1
  EXPECT_EQ(on.diagnostics.list()[0].code, codes::lone_percent);
}

TEST(ReadGcode, StoppingAndStoringHaveStepsOfTheirOwn) {
  const Reading r = read("G0 X1 Y2 Z3\nM1\nM60\nG28.1\nG30.1\nM30");
  ASSERT_EQ(kinds(r.program.path), "rapid pause pause storehome storehome end");
  EXPECT_EQ(r[1].pause().kind, PauseKind::optional);
  EXPECT_EQ(r[2].pause().kind, PauseKind::pallet_change);
  EXPECT_EQ(r[3].store_home().home, Reference::home);
  EXPECT_EQ(r[4].store_home().home, Reference::second_home);
  EXPECT_TRUE(r[5].end().rewind);
}

TEST(ReadGcode, PlainLinesAreReadAsAllOthers) {
  const std::vector<std::string> lines = {"G21 G90 F100",
                                          "G0 X1 Y2",
                                          "N10 G1 X3.5 Z-1",
                                          "X4",
                                          "Y-5 F250",
                                          "G0 Z5",
                                          "G1X1Y1",
                                          "G01 X2",
                                          "F300 X3",
                                          "G20 X1",
                                          "G54 X2",
                                          "G1 X3",
                                          "G92 X0",
                                          "G1 X5",
                                          "X6 X7",
                                          "G91 X1",
                                          "X1",
                                          "G90 X1",
                                          "G3 X2 I1",
                                          "X3 I.5",
                                          "G1 X1",
                                          "N1 N2 X4",
                                          "X99999999999",
                                          "X5",
                                          "F-1 X6",
                                          "G1 F0 X7",
                                          "F5 X8",
                                          "G18 X1",
                                          "G68 R10",
                                          "X5",
                                          "G69",
                                          "X6",
                                          "M3 S5",
                                          "X7 S6",
                                          "A5 X1",
                                          "X2",
                                          "G80",
                                          "X3",
                                          "G1",
                                          "G0 Z1 F",
                                          "X9",
                                          "G41.1 D2",
                                          "X20",
                                          "X30",
                                          "G40",
                                          "Y9",
                                          "M2",
                                          "X1",
                                          "X2"};
  std::string plain, commented;  // a comment prevents the fast path
  for (const std::string& line : lines) {
    plain += line + "\n";
    commented += line + " (comment)\n";
  }
  const Reading fast = read(plain), slow = read(commented);
  EXPECT_EQ(fast.diagnostics.list().size(), slow.diagnostics.list().size());
  ASSERT_EQ(kinds(fast.program.path), kinds(slow.program.path));
  for (std::size_t i = 0; i < fast.size(); ++i) {
    EXPECT_EQ(fast[i].to(), slow[i].to()) << i;
    EXPECT_EQ(fast[i].feed().mm_per_min(), slow[i].feed().mm_per_min()) << i;
    EXPECT_EQ(fast[i].unknown_axes(), slow[i].unknown_axes()) << i;
    EXPECT_EQ(fast[i].rests_before(), slow[i].rests_before()) << i;
    EXPECT_EQ(fast.program.path.origin_of(i), slow.program.path.origin_of(i)) << i;
  }
}

TEST(ReadGcode, SeveralProgramsOfAFileAreRead) {
  const Reading r = read(
      "%\nO1000\nG0 X1\nM98 P3000\nM30\nO2000 (again)\nG0 X2\nM2\nO3000\nG0 X3 (M30)\nM99\nG0 X4\nM30\n%");
  std::string ends;
  for (const Step& s : r.program.path.steps())
    if (s.is_motion()) ends += std::to_string(static_cast<int>(s.to().x));
  EXPECT_EQ(ends, "1324");  // the subprogram only where it is called
  EXPECT_EQ(r.diagnostics.errors() + r.diagnostics.warnings(), 0u);
}

TEST(ReadGcode, LimitsAreErrors) {
  const Reading r = read("G0 X1\nX2\nX3\nX4\nM2", {.max_steps = 2});
  EXPECT_EQ(r.size(), 2u);
  EXPECT_TRUE(r.program.cut_short && !r.program.ended);
  ASSERT_EQ(r.diagnostics.list().size(), 1u);  // not also that the end is missing
  EXPECT_EQ(r.diagnostics.list()[0].code, codes::too_many_steps);
  const Reading many = read("F1 G91 G83 X1 Z-1000 R0 Q0.02 L10000\nM2", {.max_steps = 1000});
  EXPECT_EQ(many.size(), 0u);  // counted before the first is added
  EXPECT_EQ(many.diagnostics.list()[0].code, codes::too_many_steps);
}

TEST(ReadGcode, AShortProgramDoesNotFillTheMemory) {
  const GcodeReadOptions few{.max_made_steps = 1000};
  const Reading loop = read("O1 repeat [100000]\nG91 G0 X1\nO1 endrepeat\nM2", few);
  EXPECT_EQ(loop.diagnostics.list()[0].code, codes::too_many_steps);
  EXPECT_LT(loop.size(), 1100u);
  std::string plain;
  for (int i = 0; i < 50'000; ++i) plain += i % 2 == 0 ? "G0X1\n" : "X2\n";
  const Reading written = read(plain + "M2", few);
  EXPECT_EQ(written.size(), 50'001u);
  EXPECT_EQ(written.diagnostics.errors(), 0u);
}

class Stopper : public Progress {
 public:
  void phase(std::string_view) override {}
  void report(double fraction) override { last = fraction; }
  bool stop_requested() override { return true; }
  double last = -1.0;
};

TEST(ReadGcode, CanBeStopped) {
  std::string text;
  for (int i = 0; i < 100'000; ++i) text += "G0 X1\n";
  Diagnostics diagnostics;
  Stopper stopper;
  EXPECT_EQ(read_gcode(text, {}, diagnostics, &stopper).path.size(), 0u);
  EXPECT_GT(stopper.last, 0.0);
  EXPECT_LT(stopper.last, 0.5);
}

TEST(ReadGcode, ThePitchOfAThreadIsInTheProgramsUnit) {
  EXPECT_NEAR(feed_of(read("G21 S100 M3\nG33 Z-5 K1.5\nM2"), 1), 1.5 * 100, 1e-9);
  EXPECT_NEAR(feed_of(read("G20 S100 M3\nG33 Z-1 K0.1\nM2"), 1), 0.1 * 25.4 * 100, 1e-9);
}

}  // namespace
}  // namespace kerf

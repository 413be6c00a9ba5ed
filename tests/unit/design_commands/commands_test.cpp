// The commands of the machine, called without a language: motions, tools, files and messages, by hand
// computation.
#include "design/commands/commands.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "design/machine/machine.h"

#include "kerf/stock/stock.h"

namespace kerf::design {
namespace {

class Site final : public CallSite {
 public:
  Origin where() const override { return TextLocation{"part.txt", 3, 5}; }
  OriginId origin(OriginTable& origins) override { return origins.add(where()); }
  void error(Problem what, std::string message) override {
    problem = what;
    found.error(Code{}, where(), std::move(message));
  }
  void warning(std::string message) override { found.warning(Code{}, where(), std::move(message)); }
  Diagnostics& diagnostics() override { return found; }
  void print(std::string_view line) override { printed += std::string(line) + "\n"; }
  std::string shown(const Value& value) const override {
    return value.is(Type::text) ? "\"" + value.text() + "\"" : text_of(value);
  }
  std::string as_text(const Value& value) const override { return text_of(value); }
  std::optional<std::vector<Outline>> children() override { return child; }
  std::optional<double> variable(std::string_view name) const override {
    return name == "retractheight" ? retract_height : std::nullopt;
  }

  Diagnostics found{1000};
  Problem problem = Problem::type;
  std::optional<std::vector<Outline>> child;
  std::optional<double> retract_height;
  std::string printed;
};

class Flat final : public Surface {
 public:
  double height(Point2) const override { return -1.5; }
};

Value words(std::string text) { return text; }
Value list(Value::List items) { return items; }

/// A table with the tools that the tests use.
ToolTable tools() {
  ToolTable table;
  Diagnostics diagnostics;
  const auto add = [&](int number, const ToolShape& shape, std::vector<std::string> names = {}) {
    Tool tool = *make_tool(number, shape, {}, {}, diagnostics);
    tool.names = std::move(names);
    table.set(number, std::move(tool));
  };
  add(102, shape::Square{mm(3.175), mm(12.7)}, {"Carbide 3D 102", "100036"});
  add(201, shape::Square{mm(6.35), mm(19.05)}, {"100047"});
  add(202, shape::Ball{mm(6.35), mm(19.05)});
  add(301, shape::Vee{mm(12.7), mm(6.35), degrees(90), {}, {}});
  add(374, shape::Keyhole{mm(9.525), mm(3.175), mm(6.35), mm(9.525)});
  add(390, shape::Vee{mm(3.175), mm(1.5875), degrees(90), {}, {}});
  add(814, shape::Dovetail{mm(12.7), mm(12.7), degrees(14)});
  return table;
}

std::unique_ptr<Machine> machine_with(MachineOptions options) { return std::make_unique<Machine>(options); }

struct Commands : testing::Test {
  ToolTable table = tools();
  std::unique_ptr<Machine> state = machine_with({.tools = &table});
  Site site;
  Diagnostics& diagnostics = site.found;

  Machine& machine() { return *state; }
  const Toolpath& path() { return machine().path(); }

  Value run(std::string_view name, std::vector<Value> arguments = {}) {
    for (const Command& command : commands())
      if (command.name == name) {
        Call call(command, site, arguments);
        return design::run(*state, call);
      }
    ADD_FAILURE() << "there is no command " << name;
    return {};
  }
  Results finished() {
    return finish(machine(), [&](std::string message) { site.warning(std::move(message)); });
  }
  void start(const char* mode = "cut") {
    run("gcodepreview", {words(mode), Value::truth(true), Value::truth(true)});
  }
  /// A machine at X0 Y0 Z0 with a block of 100 x 60 x 12.7 mm.
  void prepare() {
    start();
    run("setupstock", {100.0, 60.0, 12.7, words("Top"), words("Lower-Left"), 9.0});
    run("rapid", {0.0, 0.0, 0.0});
  }
  std::vector<Point3> ends() {
    std::vector<Point3> all;
    for (const Step& step : path().steps())
      if (step.is_motion()) all.push_back(step.to());
    return all;
  }
  const Step& last() { return path()[path().size() - 1]; }
  std::string message() { return diagnostics.list().empty() ? "" : diagnostics.list().back().message; }
  void expect_error(std::string_view part) {
    EXPECT_TRUE(diagnostics.has_errors());
    EXPECT_NE(message().find(part), std::string::npos) << message();
  }
  void expect_end(Point3 at) {
    EXPECT_LT(distance(last().to(), at), 1e-9)
        << last().to().x << " " << last().to().y << " " << last().to().z;
  }
};

// ---- the object

TEST_F(Commands, RequireGcodepreviewFirst) {
  run("rapid", {1.0, 2.0, 3.0});
  expect_error("gcodepreview(...) must come first");
  EXPECT_EQ(site.problem, Problem::state);
  EXPECT_EQ(path().size(), 0u);
  start();
  start();
  expect_error("called before");
}

TEST_F(Commands, TheTableHasUniqueNamesAndOrderedParameters) {
  std::vector<std::string> names;
  for (const Command& command : commands()) names.emplace_back(command.name);
  EXPECT_GT(names.size(), 170u);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
  for (const Command& command : commands())
    if (command.name == "setupstock") {
      EXPECT_EQ(signature_of(command),
                "setupstock(stockXwidth, stockYheight, stockZthickness, zeroheight=\"Top\", "
                "stockzero=\"Lower-Left\", retractheight=undef)");
    }
}

/// A million random calls cannot be made by hand: every command with every kind of wrong argument.
TEST_F(Commands, NoArgumentCrashesACommand) {
  const std::vector<Value> wrong{Value(),
                                 Value(std::nan("")),
                                 Value(HUGE_VAL),
                                 Value(-1e300),
                                 Value(0.0),
                                 Value(7.0),
                                 Value(1e7),
                                 Value::truth(true),
                                 words(""),
                                 words("Both"),
                                 list({}),
                                 list({1.0, 2.0, 3.0}),
                                 list({list({0.0, 0.0}), list({0.0, 0.0})})};
  for (const Command& command : commands())
    for (const Value& value : wrong)
      for (std::size_t count = 0; count <= command.parameters.size() + 1; ++count) {
        if (count > command.parameters.size() && command.further == Further::refused) continue;
        state = machine_with({.tools = &table});
        start();
        const std::vector<Value> arguments(count, value);
        Call call(command, site, arguments);
        design::run(*state, call);
        for (const Step& step : path().steps()) {
          if (step.is_motion()) {
            ASSERT_TRUE(finite(step.to())) << command.name;
          }
        }
      }
}

TEST_F(Commands, PositionsAreZeroAtFirstAndFollowMotions) {
  start();
  EXPECT_EQ(run("xpos").number(), 0.0);
  run("cutline", {1.0, 2.0, -3.0});
  EXPECT_EQ(run("xpos").number(), 1.0);
  EXPECT_EQ(run("ypos").number(), 2.0);
  EXPECT_EQ(run("zpos").number(), -3.0);
}

TEST_F(Commands, APositionSetWithoutMotionIsReachedByRapidsWithAWarning) {
  prepare();
  run("cutline", {10.0, 10.0, -2.0});
  run("setzpos", {9.0});
  run("rapidXY", {20.0, 20.0});
  EXPECT_EQ(diagnostics.warnings(), 1u);
  EXPECT_NE(message().find("Z9 without a motion"), std::string::npos);
  const auto all = ends();
  EXPECT_EQ(all[all.size() - 2], (Point3{10, 10, 9}));
  EXPECT_EQ(all.back(), (Point3{20, 20, 9}));
}

TEST_F(Commands, TheFirstMoveInZLeavesXAndYUnknown) {
  start();
  run("movetosafeZ");
  EXPECT_EQ(last().unknown_axes(), 3u);
  EXPECT_EQ(last().to().z, 5.0);
  run("rapidXY", {10.0, 20.0});
  EXPECT_EQ(last().unknown_axes(), 0u);
  EXPECT_EQ(last().to(), (Point3{10, 20, 5}));
}

// ---- motions

TEST_F(Commands, AxesThatAreNotNamedStay) {
  prepare();
  run("cutline", {1.0, 2.0, -3.0});
  run("rapidXZ", {5.0, 4.0});
  expect_end({5, 2, 4});
  run("rapidYZ", {7.0, 6.0});
  expect_end({5, 7, 6});
  run("cutlineXZ", {1.0, -1.0});
  expect_end({1, 7, -1});
  run("cutlineYZwithfeed", {3.0, -2.0, 123.0});
  expect_end({1, 3, -2});
  EXPECT_EQ(last().feed().mm_per_min(), 123.0);
  run("cutlineZgcfeed", {-2.5, 77.0});
  expect_end({1, 3, -2.5});
}

TEST_F(Commands, FeedsAreThoseOfTheToolAndOfPlunges) {
  prepare();
  run("opengcodefile", {words("part"), 102.0, 3.175, 100.0, 400.0, 16000.0});
  run("setfeeds", {Value(), Value(), Value(), 0.75});  // small_square
  run("cutline", {0.0, 0.0, -1.0});
  EXPECT_EQ(last().feed().mm_per_min(), 75.0);
  run("cutline", {10.0, 0.0, -1.0});
  EXPECT_EQ(last().feed().mm_per_min(), 300.0);
  run("toolchange", {201.0});
  run("cutline", {20.0, 0.0, -1.0});
  EXPECT_EQ(last().feed().mm_per_min(), 400.0);
}

TEST_F(Commands, OriginsAreThoseOfTheCall) {
  prepare();
  EXPECT_EQ(to_string(path().origin_of(path().size() - 1)), "part.txt:3:5");
}

TEST_F(Commands, ALaserIsOnDuringCutsAlone) {
  prepare();
  run("setlaserpower", {600.0});
  run("rapid", {5.0, 5.0, 0.0});
  run("cutline", {9.0, 5.0, 0.0});
  run("cutline", {9.0, 9.0, 0.0});
  run("rapid", {20.0, 5.0, 0.0, words("laser")});
  run("cutline", {30.0, 5.0, 0.0});
  run("closegcodefile");
  std::vector<double> powers;  // during each motion
  double power = 0.0;
  for (const Step& step : path().steps()) {
    if (step.kind() == StepKind::laser_power)
      power = step.laser_power().mode == LaserMode::off ? 0.0 : step.laser_power().power;
    if (step.is_motion()) powers.push_back(power);
  }
  EXPECT_EQ(powers, (std::vector<double>{0, 0, 0, 600, 600, 0, 600}));
  run("setlaserpower", {-1.0});
  expect_error("power must not be below 0");
}

/// Without a laser the tool of such a rapid is a mill that turns: it must not touch the material.
TEST_F(Commands, AMillPassesAboveTheMaterial) {
  prepare();
  run("toolchange", {102.0, 16000.0});
  run("cutline", {5.0, 5.0, -2.0});
  run("rapid", {20.0, 5.0, 0.0, words("laser")});
  const auto all = ends();
  const std::vector<Point3> made(all.end() - 3, all.end());
  EXPECT_EQ(made, (std::vector<Point3>{{5, 5, 9}, {20, 5, 9}, {20, 5, 0}}));
  EXPECT_FALSE(path().has(StepKind::laser_power));
}

// ---- arcs

struct Quadrant {
  const char* name;
  double x, y;  // direction of the start from the centre
  double u, v;  // of the end
};
void PrintTo(const Quadrant& q, std::ostream* out) { *out << q.name; }

class Quarters : public Commands, public testing::WithParamInterface<Quadrant> {};

TEST_P(Quarters, EndAtTheGivenPointOfTheirCircle) {
  const Quadrant q = GetParam();
  prepare();
  constexpr double kRadius = 5.0;
  const Point2 centre{50, 30};
  run("cutline", {centre.x + kRadius * q.x, centre.y + kRadius * q.y, -1.0});
  const Point3 end{centre.x + kRadius * q.u, centre.y + kRadius * q.v, -2.0};
  run(q.name, {end.x, end.y, end.z, kRadius});
  ASSERT_EQ(last().kind(), StepKind::arc) << q.name;
  expect_end(end);
  EXPECT_LT(distance(last().arc().centre, centre), 1e-9);
  EXPECT_EQ(last().arc().turn, q.x * q.v - q.y * q.u > 0 ? Turn::ccw : Turn::cw);
  EXPECT_EQ(diagnostics.list().size(), 0u);
}

INSTANTIATE_TEST_SUITE_P(
    All, Quarters,
    testing::Values(Quadrant{"cutquarterCCNE", 1, 0, 0, 1}, Quadrant{"cutquarterCCNW", 0, 1, -1, 0},
                    Quadrant{"cutquarterCCSW", -1, 0, 0, -1}, Quadrant{"cutquarterCCSE", 0, -1, 1, 0},
                    Quadrant{"cutquarterCWNE", 0, 1, 1, 0}, Quadrant{"cutquarterCWNW", -1, 0, 0, 1},
                    Quadrant{"cutquarterCWSW", 0, -1, -1, 0}, Quadrant{"cutquarterCWSE", 1, 0, 0, -1},
                    Quadrant{"cutquarterCCSEdxf", 0, -1, 1, 0}, Quadrant{"cutquarterCWNWdxf", -1, 0, 0, 1}));

TEST_F(Commands, ArcsReachTheirEndAndDepth) {
  prepare();
  run("cutarcCC", {0.0, 90.0, 0.0, 0.0, 10.0, -2.0, 5.0});
  expect_end({0, 10, -2});
  EXPECT_EQ(ends()[ends().size() - 2], (Point3{10, 0, 0})) << "a cut to the start of the arc";
  run("cutarcCW", {90.0, 0.0, 0.0, 0.0, 10.0, -1.0});
  expect_end({10, 0, -3});
  run("cutarcCC", {0.0, 720.0, 0.0, 0.0, 10.0, -1.0});
  expect_end({10, 0, -4});
  EXPECT_EQ(last().arc().extra_turns, 1);
  run("cutarcCC", {90.0, 0.0, 0.0, 0.0, 10.0, 0.0});
  expect_error("earc must be above barc");
}

TEST_F(Commands, ArcsAboutACentreCheckTheirRadius) {
  prepare();
  run("cutline", {10.0, 0.0, -1.0});
  run("cutarcNECCdxfgc", {0.0, 10.0, -2.0, 0.0, 0.0, 10.0});
  expect_end({0, 10, -2});
  run("arcCWgc", {10.0, 0.0, -2.0, 0.0, 0.0, 10.0});
  expect_end({10, 0, -2});
  run("arcCCgc", {0.0, 11.0, -2.0, 0.0, 0.0, 10.0});
  expect_error("(ex, ey) is 11.0000 mm from the centre");
}

TEST_F(Commands, CirclesEndAtTheirDepth) {
  prepare();
  run("cutcircleCC", {20.0, 20.0, -1.0, -3.175, 6.0});
  expect_end({26, 20, -3.175});
  EXPECT_EQ(last().arc().turn, Turn::ccw);
  run("cutcircleCW", {20.0, 20.0, -3.175, -3.175, 6.0});
  EXPECT_EQ(last().arc().turn, Turn::cw);
}

// ---- tools

TEST_F(Commands, ToolsHaveTheMakersAndTheGeneratedNumber) {
  prepare();
  run("toolchange", {100047.0, 12000.0});
  EXPECT_EQ(machine().tool().number, 201);
  EXPECT_EQ(run("currenttoolnumber").number(), 100047.0);
  EXPECT_EQ(last().spindle().speed.rpm(), 12000.0);
  run("toolchange", {999.0});
  expect_error("there is no tool 999; known: 102, 201");
  EXPECT_EQ(machine().tool().number, 201) << "the tool stays";
}

TEST_F(Commands, DiametersDependOnTheHeight) {
  start();
  EXPECT_NEAR(run("tool_diameter", {202.0, 1.0}).number(), 2 * std::sqrt(3.175 * 3.175 - 2.175 * 2.175),
              1e-9);
  EXPECT_NEAR(run("tool_radius", {301.0, 2.0}).number(), 2.0, 1e-9);
  EXPECT_NEAR(run("tool_diameter", {374.0, 1.0}).number(), 9.525, 1e-9);
  EXPECT_NEAR(run("tool_diameter", {374.0, 5.0}).number(), 6.35, 1e-9);
  EXPECT_NEAR(run("tool_diameter", {814.0, 2.0}).number(), 12.7 - 4 * std::tan(14 * std::numbers::pi / 180),
              1e-9);
  run("tool_diameter", {202.0, -1.0});
  expect_error("0 or more");
}

TEST_F(Commands, OwnToolsAndToolsOfComments) {
  prepare();
  std::vector<Value> arguments{901.0, words("ball"), 8.0};  // its first dimension is the diameter
  run("addtool", arguments);
  run("toolchange", {901.0});
  EXPECT_EQ(machine().tool().diameter(), 8.0);
  run("settoolparameters", {words("mill"), 5.0, 0.0, 20.0, 0.0});
  EXPECT_EQ(machine().tool().diameter(), 5.0);
  EXPECT_EQ(machine().tool().number, 901);
  const Results result = finished();
  EXPECT_EQ(result.tools.at(901).diameter.mm(), 5.0);
  EXPECT_FALSE(diagnostics.has_errors());
}

TEST_F(Commands, CutsKeepTheirTool) {
  prepare();
  run("toolchange", {102.0, 12000.0});
  run("settoolparameters", {words("mill"), 4.0, 0.0, 20.0, 0.0});
  run("cutline", {10.0, 0.0, -1.0});
  run("settoolparameters", {words("mill"), 8.0, 0.0, 20.0, 0.0});
  EXPECT_EQ(last().kind(), StepKind::spindle) << "the new tool turns";
  run("cutline", {20.0, 0.0, -1.0});
  run("definesquaretool", {10.0, 20.0, 30.0});
  run("cutline", {30.0, 0.0, -1.0});
  std::map<double, double> diameters;  // by X of the end
  const Results result = finished();
  for_each_motion(result.path, [&](const Step& step, const MotionContext& context) {
    if (step.kind() == StepKind::cut) diameters[step.to().x] = result.tools.at(*context.tool).diameter.mm();
  });
  EXPECT_EQ(diameters, (std::map<double, double>{{10, 4}, {20, 8}, {30, 10}}));
}

TEST_F(Commands, AToolThatHasCutIsNotReplaced) {
  prepare();
  run("addtool", {901.0, words("ball"), 8.0});
  run("toolchange", {901.0});
  run("cutline", {10.0, 0.0, -1.0});
  run("addtool", {901.0, words("ball"), 6.0});
  expect_error("tool 901 has cut already");
}

TEST_F(Commands, DescriptionsOfToolsAreFiles) {
  prepare();
  run("definebowltool", {12.7, 12.7, 3.175, 6.35, 20.0});
  run("showtooloutline");
  run("showtoolshape");
  const Results result = finished();
  ASSERT_EQ(result.files.size(), 2u);
  EXPECT_EQ(result.files[0].name, "102_outline.svg");
  EXPECT_NE(result.files[0].bytes.find("<svg"), std::string::npos);
  // Binary STL: 80 bytes, the number of triangles, 50 bytes each.
  EXPECT_EQ((result.files[1].bytes.size() - 84) % 50, 0u);
}

// ---- stock and files

TEST_F(Commands, TheStockIsNotedForSimulators) {
  start();
  run("setupstock", {220.0, 150.0, 8.35, words("Top"), words("center")});
  ASSERT_TRUE(machine().stock);
  EXPECT_EQ(machine().stock->block.low, (Point3{-110, -75, -8.35}));
  std::string notes;
  for (std::size_t i = 0; i < path().size(); ++i)
    if (path()[i].kind() == StepKind::note) notes += std::string(path().text(i)) + "\n";
  EXPECT_EQ(notes,
            "stockMin:-110.0mm, -75.0mm, -8.35mm\nstockMax:110.0mm, 75.0mm, 0.00mm\n"
            "STOCK/BLOCK, 220, 150, 8.35, 110.0, 75.0, 8.35\n");
  run("setupstock", {220.0, 150.0, 8.35, words("Top"), words("Somewhere")});
  expect_error("stockzero: \"Somewhere\" is unknown; known: Lower-Left");
}

TEST_F(Commands, TheStockIsNotedAsItIsInTheEnd) {
  start();
  run("setupstock", {100.0, 60.0, 10.0});
  run("cutline", {10.0, 0.0, -1.0});
  run("shiftstock", {5.0, 0.0, 0.0});
  run("addtostock", {10.0, 60.0, 10.0, 105.0, 0.0, -10.0});
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < path().size(); ++i)
    if (path()[i].kind() == StepKind::note) notes.emplace_back(path().text(i));
  EXPECT_EQ(notes,
            (std::vector<std::string>{"stockMin:5.0mm, 0.00mm, -10mm", "stockMax:115.0mm, 60mm, 0.00mm",
                                      "STOCK/BLOCK, 110, 60, 10, -5.0, 0.00, 10"}));
  EXPECT_EQ(last().kind(), StepKind::cut);
}

TEST_F(Commands, StockIsMovedAndAddedTo) {
  start();
  run("addtostock", {10.0, 10.0, 10.0});
  expect_error("setupstock must be called first");
  run("setupstock", {100.0, 60.0, 10.0});
  run("shiftstock", {5.0, 0.0, 0.0});
  EXPECT_EQ(machine().stock->block.low, (Point3{5, 0, -10}));
  run("addtostock", {10.0, 10.0, 10.0, 5.0, 0.0, 0.0});
  EXPECT_EQ(machine().stock->block.high, (Point3{105, 60, 10}));
  ASSERT_TRUE(machine().stock->body);
  EXPECT_NEAR(machine().stock->body->volume().mm3(), 100 * 60 * 10 + 1000, 1e-6);
}

TEST_F(Commands, FilesAreThoseThatWereClosed) {
  prepare();
  run("opengcodefile", {words("part")});
  run("opendxffile", {words("part")});
  run("cutline", {0.0, 0.0, -1.0});
  run("cutlinedxfgc", {50.0, 0.0, -1.0});
  run("closegcodefile");
  expect_end({50, 0, 9});  // lifted to the retract height
  run("closedxffile");
  run("closedxffile");
  expect_error("no file is open");
  run("opengcodefile", {words("more")});
  const Results result = finished();
  EXPECT_NE(message().find("more.nc is not written"), std::string::npos);
  ASSERT_EQ(result.programs.size(), 1u);
  EXPECT_EQ(result.programs[0].name, "part.nc");
  EXPECT_EQ(result.programs[0].post, "carbide");
  ASSERT_EQ(result.files.size(), 1u);
  EXPECT_EQ(result.files[0].name, "part.dxf");
  EXPECT_NE(result.files[0].bytes.find("Layer_Black"), std::string::npos);
}

/// The second of two files has its own motions, from the state in which the first one ends.
TEST_F(Commands, FilesFollowEachOther) {
  start();
  run("opengcodefile", {words("a")});
  run("setupstock", {100.0, 60.0, 12.7, words("Top"), words("Lower-Left"), 9.0});
  run("toolchange", {201.0, 12000.0});
  run("rapid", {10.0, 10.0, 5.0});
  run("cutline", {10.0, 10.0, -1.0});
  run("closegcodefile");
  run("opengcodefile", {words("b")});
  run("cutline", {50.0, 10.0, -2.0});
  run("closegcodefile");
  run("opengcodefile", {words("c")});
  run("toolchange", {102.0, 9000.0});
  run("rapid", {50.0, 10.0, 5.0});
  run("cutline", {50.0, 10.0, -3.0});
  run("closegcodefile");
  const Results result = finished();
  ASSERT_EQ(result.programs.size(), 3u);
  const auto cuts = [&](std::size_t i) {
    std::vector<std::pair<int, double>> made;  // tool, and Z
    for_each_motion(result.programs[i].path, [&](const Step& step, const MotionContext& context) {
      if (step.kind() != StepKind::cut) return;
      EXPECT_EQ(context.unknown_from, 0u);
      EXPECT_GT(context.spindle.speed.rpm(), 0.0);
      made.emplace_back(*context.tool, step.to().z);
    });
    return made;
  };
  using Cuts = std::vector<std::pair<int, double>>;
  EXPECT_EQ(cuts(0), (Cuts{{201, -1.0}}));
  EXPECT_EQ(cuts(1), (Cuts{{201, -2.0}}));
  EXPECT_EQ(cuts(2), (Cuts{{102, -3.0}}));
  int changes = 0;
  std::string notes;
  const Toolpath& third = result.programs[2].path;
  for (std::size_t i = 0; i < third.size(); ++i) {
    changes += third[i].kind() == StepKind::tool_change ? 1 : 0;
    if (third[i].kind() == StepKind::note) notes += third.text(i);
  }
  EXPECT_EQ(changes, 1) << "a machine does not stop for a tool that cuts nothing";
  EXPECT_NE(notes.find("STOCK/BLOCK, 100, 60, 12.7"), std::string::npos);
}

/// OpenSCAD programs assign to a variable and call setupstock() with five arguments.
TEST_F(Commands, TheRetractHeightIsThatOfTheProgram) {
  site.retract_height = 9.0;
  start();
  EXPECT_EQ(machine().retract_height, 9.0);
  run("setupstock", {100.0, 60.0, 12.7, words("Top"), words("Lower-Left")});
  EXPECT_EQ(machine().retract_height, 9.0);
  run("setupstock", {100.0, 60.0, 12.7, words("Top"), words("Lower-Left"), 7.0});
  EXPECT_EQ(machine().retract_height, 7.0);
}

TEST_F(Commands, ACuttingAreaKeepsTheToolAndItsSpindle) {
  start();
  run("toolchange", {201.0, 12000.0});
  run("rapid", {1.0, 2.0, 3.0});
  run("setupcuttingarea", {40.0, 30.0, 10.0, -20.0, -15.0, -10.0});
  ASSERT_GE(path().size(), 2u);
  EXPECT_EQ(path()[0].tool_change().tool, 201);
  EXPECT_EQ(path()[1].spindle().speed.rpm(), 12000.0);
  EXPECT_EQ(machine().position(), (Point3{}));
}

TEST_F(Commands, WithoutAFlagThereAreNoFiles) {
  run("gcodepreview", {words("cut"), 0.0, 0.0});
  run("opengcodefile", {words("part")});
  run("opendxffile", {words("part")});
  run("dxfline", {0.0, 0.0, 0.0, 10.0, 0.0});
  run("closedxffile");
  run("closegcodefile");
  const Results result = finished();
  EXPECT_TRUE(result.programs.empty() && result.files.empty());
  EXPECT_FALSE(diagnostics.has_errors());
}

TEST_F(Commands, PolylinesAreStartedAndClosed) {
  prepare();
  run("addvertex", {0.0, 1.0, 2.0});
  expect_error("beginpolyline must be called first");
  run("beginpolyline", {0.0});
  for (const Point2 p : {Point2{0, 0}, Point2{10, 0}, Point2{10, 5}, Point2{0, 0}})
    run("addvertex", {0.0, p.x, p.y});
  run("closepolyline", {0.0});
  EXPECT_NE(machine().dxf().find("LWPOLYLINE"), std::string::npos);
}

TEST_F(Commands, LinesThatMeetAreOnePolyline) {
  prepare();
  run("dxfline", {0.0, 0.0, 0.0, 10.0, 0.0});
  run("dxfline", {0.0, 10.0, 0.0, 10.0, 10.0});
  run("dxfarc", {0.0, 0.0, 10.0, 10.0, 270.0, 0.0});
  const std::string dxf = machine().dxf();
  EXPECT_NE(dxf.find("LWPOLYLINE"), std::string::npos);
  EXPECT_EQ(dxf.find("ARC\n"), std::string::npos);
}

// ---- shapes of several motions

TEST_F(Commands, RectanglesAreCutDownwards) {
  prepare();
  run("cutrectangle", {0.0, 10.0, 10.0, 0.0, 30.0, 20.0, 3.0});
  expect_end({10, 10, -3});
  run("cutrectangleround", {0.0, 10.0, 10.0, 0.0, 30.0, 20.0, -3.0, 4.0});
  expect_end({14, 10, -3});
  EXPECT_EQ(diagnostics.warnings(), 1u);
  run("cutrectangleround", {0.0, 10.0, 10.0, 0.0, 30.0, 20.0, 3.0, 11.0});
  expect_error("11 mm does not fit into 30 x 20 mm");
}

TEST_F(Commands, KeyholesAreCutAndLeft) {
  prepare();
  run("toolchange", {374.0});
  run("rapid", {50.0, 30.0, 5.0});
  run("cutkeyholegcdxf", {374.0, 0.0, 4.0, words("N"), 12.0});
  const auto all = ends();
  ASSERT_GE(all.size(), 5u);
  EXPECT_EQ(all[all.size() - 4], (Point3{50, 30, -4}));
  EXPECT_LT(distance(all[all.size() - 3], Point3{50, 42, -4}), 1e-9);
  expect_end({50, 30, 5});
  run("cutkeyholegcdxf", {374.0, 0.0, 4.0, words("up"), 12.0});
  expect_error("known: E, N, W, S");
  run("dxfKH", {201.0, 0.0, 0.0, 0.0, 4.0, 0.0, 12.0});
  expect_error("tool 201 is not a keyhole cutter");
}

TEST_F(Commands, PinsHaveASocketForEachTail) {
  prepare();
  run("toolchange", {814.0});
  run("cut_pins", {100.0, 12.7, 4.0, 8.0, 0.75, 12.7, 14.0});
  // Rows at y = 12.7 + 4; sockets to 12.7 + 8 + 9.525 - 6.35 at 12.5, 37.5, 62.5, 87.5.
  int sockets = 0;
  for (const Point3 p : ends())
    if (std::abs(p.y - 23.875) < 1e-9 && std::abs(p.z + 9.525) < 1e-9) {
      EXPECT_NEAR(p.x, 12.5 + 25 * sockets, 1e-9);
      ++sockets;
    }
  EXPECT_EQ(sockets, 4);
  run("cut_pins", {100.0, 12.7, 4.0, 8.0, 1.0, 12.7, 14.0});
  expect_error("Proportion of a half-blind joint is below 1");
}

TEST_F(Commands, TheToolFitsBetweenTails) {
  prepare();
  run("cut_tails", {100.0, 12.7, 40.0, 8.0, 0.75, 12.7, 14.0});
  expect_error("the tool does not fit between 40 tails");
}

TEST_F(Commands, ABoxJointHasElevenPins) {
  prepare();
  run("Full_Blind_Finger_Joint", {-50.0, 0.0, words("Horizontal"), words("Both"), 100.0, 12.7, 12.7, 3.175});
  std::vector<int> used;
  int slots = 0;
  for (std::size_t i = 0; i < path().size(); ++i)
    if (path()[i].kind() == StepKind::tool_change) used.push_back(path()[i].tool_change().tool);
  for (const Point3 p : ends())
    if (std::abs(std::abs(p.y) - 9.525) < 1e-9 && std::abs(p.z + 11.1125) < 1e-9) ++slots;
  EXPECT_EQ(used, (std::vector<int>{102, 102, 390, 301}));
  EXPECT_EQ(slots, 2 * 21) << "21 slots, each with two corners";
  EXPECT_EQ(diagnostics.warnings(), 1u) << "the V of 12.7 mm reaches 6.35 mm";
}

TEST_F(Commands, ShapesAreValuesAndArePocketed) {
  prepare();
  run("toolchange", {201.0});
  const Value circle = run("shape", {words("circle"), 50.0, 30.0, 20.0});
  ASSERT_TRUE(circle.is(Type::outlines));
  run("cutpocket", {circle, 0.0, 2.0, 0.5});
  double farthest = 0.0;
  for (const Step& step : path().steps())
    if (step.is_cutting()) farthest = std::max(farthest, distance(step.to().xy(), {50, 30}));
  EXPECT_NEAR(farthest, 20 - 3.175, 1e-6);
  run("cutpocket", {list({50.0, 30.0, 3.0}), 0.0, 2.0});
  expect_error("the tool of 6.35 mm does not fit into it");
  run("shape", {words("blob")});
  expect_error("name: \"blob\" is unknown; known: annulus_segment");
}

TEST_F(Commands, ChildrenAreOutlines) {
  prepare();
  site.child = std::vector<Outline>{as_outline(Circle{{50, 30}, mm(20)})};
  run("cutoutline", {Value(), 0.0, 2.0, words("outside")});
  double nearest = 1e9;
  for (const Step& step : path().steps())
    if (step.is_cutting()) nearest = std::min(nearest, distance(step.to().xy(), {50, 30}));
  EXPECT_NEAR(nearest, 20 + 3.175 / 2, 1e-6);
  site.child.reset();
  run("cutoutline", {Value(), 0.0, 2.0});
  expect_error("outline is missing");
}

TEST_F(Commands, RoundedCornersTakeTheirArea) {
  const Value square = run("shape", {words("rectangle"), 0.0, 0.0, 20.0, 10.0});
  const Value made = run("round_corners", {square, 2.0});
  ASSERT_TRUE(made.is(Type::outlines));
  start();
  run("dxfoutline", {0.0, made});
  EXPECT_FALSE(diagnostics.has_errors());
  run("round_corners", {square, 6.0});
  expect_error("6 mm does not fit");
}

TEST_F(Commands, FingersClearTheirSlots) {
  prepare();
  run("cutfingers", {100.0, 12.0, 5.0, 0.0, 3.0});
  double high = 0.0;
  for (const Step& step : path().steps())
    if (step.is_cutting()) high = std::max(high, step.to().y);
  // The tool's radius below the end of the slot, and the relief of its corners beyond that.
  EXPECT_GT(high, 12 - 1.5875);
  EXPECT_LT(high, 12.0);
  run("cutfingers", {100.0, 12.0, 4.0, 0.0, 3.0});
  expect_error("count must be an odd number");
}

TEST_F(Commands, TextIsAsHighAsItsCapitals) {
  prepare();
  run("cuttext", {words("HI"), 10.0, 20.0, 8.0, 0.0, 0.5});
  double low = 1e9, high = 0.0, left = 1e9;
  for (const Step& step : path().steps())
    if (step.is_cutting()) {
      low = std::min(low, step.to().y);
      high = std::max(high, step.to().y);
      left = std::min(left, step.to().x);
    }
  EXPECT_NEAR(low, 20.0, 1e-9);
  EXPECT_NEAR(high, 28.0, 1e-9);
  EXPECT_GE(left, 10.0);
  run("cuttext", {words("HI"), 0.0, 0.0, 8.0, 0.0, 0.5, words("gothic")});
  expect_error("font: \"gothic\" is unknown; known: sans, sans bold");
}

TEST_F(Commands, SurfacesAreCutByTheValueOfABezierSurface) {
  prepare();
  run("toolchange", {202.0});
  const Value row = list({-1.0, -1.0, -1.0, -1.0});
  const Value surface = run("bezier_surface", {0.0, 0.0, 40.0, 20.0, list({row, row, row, row})});
  run("cutsurface", {surface, 5.0, 5.0, 20.0, 6.35, 1.0});
  double low = 0.0;
  for (const Point3 p : ends()) low = std::min(low, p.z);
  EXPECT_NEAR(low, -1.0, 1e-12);
  run("cutsurface",
      {Value(std::shared_ptr<const Surface>(std::make_shared<Flat>())), 5.0, 5.0, 20.0, 6.35, 1.0});
  low = 0.0;
  for (const Point3 p : ends()) low = std::min(low, p.z);
  EXPECT_NEAR(low, -1.5, 1e-12) << "the value of the function";
  run("cutsurface", {7.0, 5.0, 5.0, 20.0, 10.0});
  expect_error("surface must be");
  EXPECT_EQ(site.problem, Problem::type);
}

TEST_F(Commands, CountersinksEndAtTheirEdge) {
  prepare();
  run("cutcountersink", {20.0, 20.0, 12.0, 90.0});
  expect_error("a ball nose must be in use");
  run("toolchange", {202.0});
  run("cutcountersink", {20.0, 20.0, 12.0, 90.0});
  // The ball of radius r touches the edge at 45 degrees: its axis is r cos 45 inside of it.
  double far = 0.0;
  for (const Step& step : path().steps())
    if (step.kind() == StepKind::arc) far = std::max(far, step.to().x - 20);
  EXPECT_NEAR(far, 6 - 3.175 / std::sqrt(2.0), 1e-9);
}

TEST_F(Commands, ThreadsHaveWholeTurns) {
  prepare();
  run("cutthread", {20.0, 20.0, 8.0, 1.25, 0.0, 6.0});
  const auto arc = std::find_if(path().steps().begin(), path().steps().end(),
                                [](const Step& step) { return step.kind() == StepKind::arc; });
  ASSERT_NE(arc, path().steps().end());
  EXPECT_NEAR(arc->to().z, -6 + 5 * 1.25, 1e-9);
  EXPECT_EQ(arc->arc().extra_turns, 4);
  run("cutthread", {20.0, 20.0, 3.0, 1.25, 0.0, 6.0});
  expect_error("does not fit into 3 mm");
}

/// What is drawn back before the first bead is pushed forward with it: absolute E words do so.
TEST_F(Commands, APrimedNozzleStartsItsBeadFull) {
  start("print");
  run("initializeforprinting");
  run("moveatfeedrate", {0.0, 0.0, 0.2, 20000.0});
  run("liftandprimenozzle");
  run("moveatfeedrate", {0.0, 0.0, 0.2, 20000.0});
  run("extrude", {10.0, 20.0, 0.2});
  run("extrude", {20.0, 20.0, 0.2});
  double standing = 0.0;  // mm3 of steps that do not move
  int beads = 0;
  Point3 at;
  for (std::size_t i = 0; i < path().size(); ++i) {
    if (path()[i].kind() == StepKind::extrude) {
      if (distance(path()[i].to(), at) < 1e-9)
        standing += path().extrude(i).volume.mm3();
      else
        ++beads;
    }
    if (path()[i].is_motion()) at = path()[i].to();
  }
  EXPECT_NEAR(standing, 0.0, 1e-12);
  EXPECT_EQ(beads, 2);
}

TEST_F(Commands, BeadsHaveTheVolumeOfAStadium) {
  start("print");
  run("initializeforprinting");
  run("moveatfeedrate", {0.0, 0.0, 0.2, 20000.0});
  run("extrude", {10.0, 20.0, 0.2});
  ASSERT_EQ(last().kind(), StepKind::extrude);
  const step::Extrude bead = path().extrude(path().size() - 1);
  const double area = 0.2 * 0.4 + std::numbers::pi * 0.1 * 0.1;
  EXPECT_NEAR(bead.volume.mm3(), area * std::sqrt(500.0), 1e-9);
  EXPECT_EQ(bead.feed.mm_per_min(), 20000.0);
  run("extrude", {20.0, 20.0, 0.2, 0.1, 0.2});
  expect_error("extrusionwidth must be at least the layer height 0.2");
  run("setandwaitforbedtemperature", {60.0});
  EXPECT_TRUE(last().temperature().wait);
  run("setfanspeed", {1.0, words("128")});
  EXPECT_NEAR(last().fan().fraction, 128.0 / 255, 1e-12);
  run("setbuildpercentage", {50.0});
  EXPECT_EQ(path().text(path().size() - 1), "M73 P50");
}

TEST_F(Commands, StockOfFilesAndSecondSidesNeedTheirService) {
  prepare();
  run("stockfromfile", {words("part.stl")});
  expect_error("cannot be read");
  run("flipstock", {words("x")});
  expect_error("cannot be cut here");
  run("previewgcodefile", {words("part.nc")});
  expect_error("cannot be read");
  Stock half;
  half.block = {{0, 0, -10}, {100, 60, 0}};
  state = machine_with({.tools = &table,
                        .load_stock = [&](const std::string&, Diagnostics&) { return half; },
                        .left_stock = [&](const CutSide&, Diagnostics&) { return half; }});
  start();
  run("stockfromfile", {words("part.stl")});
  run("cutline", {5.0, 5.0, -1.0});
  run("flipstock", {words("x"), Value(), 0.0});
  // Half a turn about an axis along X through the centre of the block, at Z0.
  EXPECT_EQ(machine().stock->block.low, (Point3{0, 0, 0}));
  EXPECT_EQ(machine().stock->block.high, (Point3{100, 60, 10}));
  EXPECT_EQ(path().size(), 1u) << "only the tool of the second side";
}

TEST_F(Commands, MessagesOfAProgram) {
  start();
  run("debug", {words("quiet")});
  EXPECT_EQ(site.printed, "");
  run("setdebug", {Value::truth(true)});
  run("debug", {words("depth"), 3.0});
  EXPECT_EQ(site.printed, "DEBUG: depth 3\n");
  run("writegc", {words("(a comment)")});
  EXPECT_EQ(last().kind(), StepKind::note);
  run("writegc", {words("M400")});
  EXPECT_EQ(last().kind(), StepKind::verbatim);
  EXPECT_EQ(run("pygcpversion").number(), 0.93);
}

TEST_F(Commands, ColoursAndLayers) {
  prepare();
  run("setdxfcolor", {words("dark gray")});
  EXPECT_EQ(machine().colour.layer(), "Layer_Dark_Gray");
  run("setdxfcolor", {words("silver")});
  EXPECT_EQ(machine().colour.name, "Light Gray");
  run("setdxfcolor", {words("greenish")});
  expect_error("known: Black, Red");
  run("setdxflayer", {words("a/b")});
  run("dxfline", {0.0, 0.0, 0.0, 1.0, 1.0});
  expect_error("layer: a name without");
}

}  // namespace
}  // namespace kerf::design

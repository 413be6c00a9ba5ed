// Job files and options as jobs, and the programs made of them.
#include "kerf/program/cut_job.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "base/codes/op.h"

namespace kerf {
namespace {

Outline rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {{{x1, y0}, {}}, {{x1, y1}, {}}, {{x0, y1}, {}}, {{x0, y0}, {}}}};
}

std::vector<ArtShape> art() {
  std::vector<ArtShape> shapes;
  shapes.push_back({"CUT.1", "CUT", rectangle(0, 0, 40, 30), {}, {}});
  shapes.push_back({"HOLES.1", "HOLES", as_outline({{60, 10}, mm(4)}), {}, {}});
  shapes.push_back({"", "HOLES", {}, {}, Point2{70, 10}});
  shapes.push_back({"MARK.1", "MARK", Outline{{0, 40}, {{{20, 40}}}}, {}, {}});
  return shapes;
}

std::map<int, Tool> tools() {
  Diagnostics diagnostics;
  std::map<int, Tool> all;
  all.emplace(1, *make_tool(1, shape::Square{mm(6), mm(20)}, {}, {}, diagnostics));
  all.emplace(2, *make_tool(2, shape::Square{mm(3), mm(20)}, {}, {}, diagnostics));
  return all;
}

std::optional<Toolpath> program(const std::string& text, Diagnostics& diagnostics) {
  const auto job = read_cut_job("art = \"a.dxf\"\n" + text, "job.toml", diagnostics);
  return job ? compile_cut_job(*job, art(), tools(), diagnostics) : std::nullopt;
}

Code code_of(const std::string& text) {
  Diagnostics diagnostics;
  EXPECT_FALSE(program(text, diagnostics)) << text;
  return diagnostics.list().empty() ? Code{} : diagnostics.list().front().code;
}

std::size_t count(const Toolpath& path, StepKind kind) {
  std::size_t n = 0;
  for (const Step& s : path.steps()) n += s.kind() == kind ? 1 : 0;
  return n;
}

TEST(CutJob, OperationsFollowEachOtherWithTheirTools) {
  Diagnostics diagnostics;
  const auto path = program(R"(
[defaults]
feed = 600
depth = 3
rpm = 12000
[[operation]]
op = "pocket"
layers = ["CUT"]
tool = 1
[[operation]]
op = "drill"
layers = "holes"
tool = 2
[[operation]]
op = "engrave"
layers = ["mark"]
tool = 2
depth = 0.5
)",
                            diagnostics);
  ASSERT_TRUE(path) << to_string(diagnostics.list().front());
  EXPECT_TRUE(diagnostics.list().empty());
  EXPECT_EQ(count(*path, StepKind::tool_change), 2u);
  EXPECT_EQ(count(*path, StepKind::note), 3u);
  EXPECT_EQ(path->steps().back().kind(), StepKind::end);
  // Two holes: the centre of the circle and the point.
  std::size_t holes = 0;
  double deepest_mark = 0.0;
  for_each_motion(*path, [&](const Step& s, const MotionContext& context) {
    if (s.is_cutting() && context.tool == 2 && s.to().z == -3.0) ++holes;
    if (s.is_cutting() && s.to().y == 40.0) deepest_mark = std::min(deepest_mark, s.to().z);
  });
  EXPECT_EQ(holes, 2u);
  EXPECT_EQ(deepest_mark, -0.5);
}

/// The lowest Z of the program of a job with a stock 10 mm thick and a drill of 4 mm, 118 degrees, as tool 3.
double lowest(const std::string& keys) {
  Diagnostics diagnostics;
  auto job =
      read_cut_job("art = \"a.dxf\"\n[[operation]]\nop = \"drill\"\nlayers = [\"HOLES\"]\ntool = 3\n" + keys,
                   "job.toml", diagnostics);
  if (!job || !resolve_formulas(*job, Box3{{0, 0, -10}, {100, 100, 0}}, diagnostics)) return NAN;
  auto all = tools();
  all.emplace(3, *make_tool(3, shape::Drill{mm(4), mm(40), degrees(118)}, {}, {}, diagnostics));
  const auto path = compile_cut_job(*job, art(), all, diagnostics);
  double z = INFINITY;
  if (path) for_each_motion(*path, [&](const Step& s, const MotionContext&) { z = std::min(z, s.to().z); });
  return z;
}

TEST(CutJob, AThroughHoleHasItsFullDiameterAtTheBottom) {
  // The point is 2 / tan 59 = 1.2017 mm high.
  EXPECT_NEAR(lowest("through = 0.5\nfeed = 100\n"), -11.7017, 1e-4);
  EXPECT_NEAR(lowest("through = 0.5\nfeed = 100\ndepth-of = \"tip\"\n"), -10.5, 1e-9);
  EXPECT_NEAR(lowest("depth = 6\nfeed = 100\n"), -6.0, 1e-9);
  EXPECT_NEAR(lowest("depth = 6\nfeed = 100\ndepth-of = \"diameter\"\n"), -7.2017, 1e-4);
}

TEST(CutJob, TheWayBetweenOperationsIsAtTheHighestRetractPlane) {
  Diagnostics diagnostics;
  const auto path = program(R"(
[defaults]
feed = 600
depth = 3
tool = 1
[[operation]]
op = "pocket"
layers = ["CUT"]
[[operation]]
op = "drill"
layers = ["HOLES"]
top = 20
)",
                            diagnostics);
  ASSERT_TRUE(path) << to_string(diagnostics.list().front());
  for_each_motion(*path, [](const Step& s, const MotionContext& context) {
    if (s.kind() == StepKind::rapid && s.unknown_axes() == 0 &&
        distance(s.to().xy(), context.from.xy()) > 40.0) {
      EXPECT_EQ(s.to().z, 25.0);
      EXPECT_EQ(context.from.z, 25.0);
    }
  });
}

TEST(CutJob, BadFilesAreErrors) {
  const std::string good =
      "[[operation]]\nop = \"pocket\"\nlayers = [\"CUT\"]\ntool = 1\ndepth = 2\nfeed = 600\n";
  Diagnostics diagnostics;
  EXPECT_TRUE(program(good, diagnostics));
  EXPECT_EQ(code_of("[[operation"), codes::cut_job_syntax);
  EXPECT_EQ(code_of(""), codes::cut_job_key);
  EXPECT_EQ(code_of("operation = 3\n"), codes::cut_job_key);
  EXPECT_EQ(code_of("operation = [3]\n"), codes::cut_job_key);
  EXPECT_EQ(code_of("defaults = 3\n" + good), codes::cut_job_key);
  EXPECT_EQ(code_of("unit = \"ell\"\n" + good), codes::cut_job_key);
  EXPECT_EQ(code_of("tools = 3\n" + good), codes::cut_job_key);
  EXPECT_EQ(code_of("[tools]\n-1 = \"square d=3\"\n" + good), codes::cut_job_key);
  for (const char* line :
       {"depth = []", "feed = true", "tool = 1.5", "layers = [1]", "outlines = []", "rpm = -1", "dwell = -1",
        "feed = nan", "pattern = \"circles\"", "name = \"\"", "depht = 2"})
    EXPECT_EQ(code_of("[defaults]\n" + std::string(line) + "\n" + good), codes::cut_job_key) << line;
  EXPECT_EQ(code_of("[[operation]]\nop = \"pocket\"\ntool = 9\ndepth = 2\nfeed = 600\n"), codes::cut_job_key);
  EXPECT_EQ(code_of(good + "outlines = [\"CUT.9\"]\n"), codes::cut_job_outlines);
  EXPECT_EQ(code_of("[[operation]]\nop = \"pocket\"\nlayers = [\"MARK\"]\ntool = 1\ndepth = 2\nfeed = 600\n"),
            codes::cut_job_outlines);
}

TEST(CutJob, WorkInsideOfWhatIsLooseIsAWarning) {
  const std::string order = "order = \"as-written\"\n";
  const std::string job =
      "[tools]\n1 = \"square d=3\"\n[defaults]\ntool = 1\ndepth = 2\nfeed = 600\n"
      "[[shape]]\nlayer = \"A\"\nrectangle = [0, 0, 40, 40]\n"
      "[[shape]]\nlayer = \"B\"\nrectangle = [10, 10, 30, 30]\n"
      "[[operation]]\nop = \"contour\"\nlayers = [\"A\"]\n"
      "[[operation]]\nop = \"pocket\"\nlayers = [\"B\"]\n";
  const auto is_reported = [](const std::string& text) {
    Diagnostics diagnostics;
    const auto read = read_cut_job(text, "job.toml", diagnostics);
    EXPECT_TRUE(read && compile_cut_job(*read, read->shapes, tools(), diagnostics));
    const auto& list = diagnostics.list();
    return std::any_of(list.begin(), list.end(),
                       [](const Diagnostic& d) { return d.code == codes::cut_job_order; });
  };
  EXPECT_TRUE(is_reported(order + job));
  EXPECT_FALSE(is_reported(job));
}

TEST(CutJob, ShapesOfTheJobItself) {
  Diagnostics diagnostics;
  const std::string text =
      "[[shape]]\nname = \"frame\"\nlayer = \"A\"\nrectangle = [30, 0, 0, 20]\ncorner = 2\n"
      "[[shape]]\ncircle = [50, 10, 8]\n[[shape]]\npolygon = [[0, 30], [10, 30], [0, 40]]\n"
      "[[shape]]\nline = [[0, 50], [10, 50.5]]\n[[shape]]\npoint = [1, 2]\n"
      "[[operation]]\nop = \"pocket\"\ntool = 1\ndepth = 2\nfeed = 600\n";
  const auto job = read_cut_job(text, "job.toml", diagnostics);
  ASSERT_TRUE(job) << to_string(diagnostics.list().front());
  ASSERT_EQ(job->shapes.size(), 5u);
  EXPECT_EQ(job->shapes[0].name, "frame");
  EXPECT_EQ(job->shapes[0].layer, "A");
  // Four corners each keep the square of the radius less a quarter of the circle.
  EXPECT_NEAR(area(*job->shapes[0].outline), 600 - 4 * 4 * (1 - std::numbers::pi / 4), 1e-9);
  EXPECT_EQ(job->shapes[1].circle->centre, (Point2{50, 10}));
  EXPECT_EQ(job->shapes[1].circle->radius, mm(4));
  EXPECT_NEAR(area(*job->shapes[2].outline), 50, 1e-12);
  EXPECT_FALSE(job->shapes[3].outline->closed());
  EXPECT_EQ(job->shapes[4].point, (Point2{1, 2}));
  const std::string rest = "\n[[operation]]\nop = \"pocket\"\ntool = 1\ndepth = 2\nfeed = 600\n";
  for (const char* shape :
       {"rectangle = [0, 0, 0, 20]", "rectangle = [0, 0, 1]", "rectangle = 5", "circle = [0, 0, 0]",
        "circle = [0, 0, nan]", "polygon = [[0, 0], [1, 1]]", "line = [[0, 0], 5]", "point = [1e99, 0]",
        "name = \"x\"", "point = [0, 0]\ncircle = [0, 0, 1]", "point = [0, 0]\ncorner = -1",
        "point = [0, 0]\nname = 5", "square = [0, 0, 1]"}) {
    Diagnostics bad;
    EXPECT_FALSE(read_cut_job("[[shape]]\n" + std::string(shape) + rest, "job.toml", bad)) << shape;
    ASSERT_GE(bad.errors(), 1u) << shape;
    EXPECT_EQ(bad.list()[0].code, codes::cut_job_key);
    EXPECT_GE(std::get<TextLocation>(bad.list()[0].where).line, 1u);
  }
  EXPECT_EQ(code_of("shape = 3" + rest), codes::cut_job_key);
  EXPECT_EQ(code_of("shape = [3]" + rest), codes::cut_job_key);
}

TEST(CutJob, KeysWithoutEffectAreWarnings) {
  Diagnostics diagnostics;
  EXPECT_TRUE(program(
      "[[operation]]\nop = \"drill\"\nlayers = [\"HOLES\"]\ntool = 2\ndepth = 2\nfeed = 60\nlead = 1\n",
      diagnostics));
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.warnings(), 1u);
  EXPECT_NE(diagnostics.list()[0].message.find("lead"), std::string::npos);
}

TEST(CutJob, OptionsMakeTheSameJobAsAFile) {
  Diagnostics diagnostics;
  const auto job = cut_job_of({{"op", "contour"},
                               {"depth", "2.5"},
                               {"feed", "600"},
                               {"layers", "CUT, HOLES"},
                               {"side", "inside"},
                               {"entry", "plunge"}},
                              diagnostics);
  ASSERT_TRUE(job);
  const CutOperation& operation = job->operations[0];
  EXPECT_EQ(operation.row->name, "contour");
  EXPECT_EQ(number_of(operation, "depth"), 2.5);
  EXPECT_EQ(operation.layers, (std::vector<std::string>{"CUT", "HOLES"}));
  EXPECT_EQ(operation.row->key("side")->get(operation), CutValue("inside"));
  EXPECT_EQ(operation.row->key("entry")->get(operation), CutValue("plunge"));
  EXPECT_FALSE(cut_job_of({{"op", "contour"}, {"depth", "deep"}, {"feed", "600"}}, diagnostics));
  EXPECT_FALSE(cut_job_of({{"op", "contour"}, {"depth", "2"}}, diagnostics));
  EXPECT_FALSE(cut_job_of({{"depth", "2"}}, diagnostics));
  EXPECT_EQ(diagnostics.errors(), 3u);
}

TEST(CutJob, NumbersOutOfRangeAreErrorsAtTheirKey) {
  const std::string job = "[[operation]]\nop = \"pocket\"\nlayers = [\"CUT\"]\ntool = 1\nfeed = 600\n";
  for (const auto& [line, rule] :
       {std::pair("depth = 0", "depth must be a number in mm above 0"),
        {"depth = -1", "depth must be a number in mm above 0"},
        {"stepover = 1.5", "stepover must be a number above 0 and at most 1"},
        {"engagement = 10", "engagement must be a number in degrees from 15 to 90"},
        {"stepdown = -1", "stepdown must be a number in mm of 0 or more"},
        {"rest-tool = 1.5", "rest-tool must be the number of a tool"}}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(program(job + line + "\n", diagnostics));
    ASSERT_FALSE(diagnostics.list().empty()) << line;
    EXPECT_EQ(diagnostics.list()[0].message, rule);
    EXPECT_EQ(std::get<TextLocation>(diagnostics.list()[0].where).line, 7u) << line;
  }
}

TEST(CutJob, UnknownNamesAreErrorsWithTheNearestName) {
  const auto message = [](const std::string& text) {
    Diagnostics diagnostics;
    EXPECT_FALSE(program(text, diagnostics));
    return diagnostics.list().empty() ? "" : diagnostics.list()[0].message;
  };
  EXPECT_EQ(message("[[operation]]\nop = \"pocket\"\ntool = 1\ndepht = 2\nfeed = 600\n"),
            "unknown key \"depht\"; did you mean depth?");
  EXPECT_EQ(message("[[operation]]\nop = \"pokcet\"\n"),
            "there is no operation \"pokcet\"; did you mean pocket?");
  Diagnostics diagnostics;
  EXPECT_FALSE(
      cut_job_of({{"op", "pocket"}, {"depth", 2.0}, {"feed", 600.0}, {"stepdwon", 1.0}}, diagnostics));
  ASSERT_EQ(diagnostics.errors(), 1u);
  EXPECT_EQ(diagnostics.list()[0].message, "unknown key \"stepdwon\"; did you mean stepdown?");
}

TEST(CutJob, DefaultsOfKeysAreValuesThatTheyMayHave) {
  for (const CutRow& row : cut_rows()) {
    EXPECT_FALSE(row.sentence.empty()) << row.name;
    for (const CutKey& key : row.keys) {
      const CutOperation usual = row.operation();
      const auto value = key.get(usual);
      EXPECT_FALSE(key.meaning.empty() || (key.example.empty() && key.choices.empty()))
          << row.name << key.name;
      const bool none = !value || key.required || !key.otherwise.empty() ||
                        *value == CutValue(std::string()) || *value == CutValue(std::vector<std::string>());
      if (none) continue;
      CutOperation same = row.operation();
      EXPECT_TRUE(key.set(same, *value)) << row.name << " " << key.name;
      EXPECT_EQ(key.get(same), value) << row.name << " " << key.name;
    }
  }
}

TEST(CutJob, AFloorThatVCarvingLeavesIsReportedUnlessItIsCleared) {
  std::map<int, Tool> all = tools();
  Diagnostics ignored;
  all.emplace(3, *make_tool(3, shape::Vee{mm(20), mm(20), degrees(60), {}, {}}, {}, {}, ignored));
  const std::string carve =
      "art = \"a.dxf\"\n[[operation]]\nop = \"vcarve\"\nlayers = [\"CUT\"]\ntool = 3\ndepth = 3\nfeed = "
      "900\n";
  const std::string floor =
      "[[operation]]\nop = \"vcarve-floor\"\nlayers = [\"CUT\"]\ntool = 2\ncarve-tool = 3\ndepth = 3\nfeed = "
      "900\n";
  const auto notes = [&](const std::string& text) {
    Diagnostics diagnostics;
    const auto job = read_cut_job(text, "job.toml", diagnostics);
    EXPECT_TRUE(job && compile_cut_job(*job, art(), all, diagnostics));
    std::vector<std::string> messages;
    for (const Diagnostic& d : diagnostics.list()) messages.push_back(d.message);
    return messages;
  };
  // 40 x 30 mm, narrower by 3 tan(30 degrees) on all sides; the V tool has no flat tip.
  EXPECT_EQ(notes(carve), std::vector<std::string>{"vcarve 1: a floor of 969.5 mm2 is left"});
  EXPECT_TRUE(notes(carve + floor).empty());
}

TEST(CutJob, ExamplesAreReadWithoutAMessage) {
  for (const std::string& name : cut_operation_names()) {
    const auto text = cut_job_example(name);
    ASSERT_TRUE(text);
    Diagnostics diagnostics;
    const auto job = read_cut_job(*text, "job.toml", diagnostics);
    ASSERT_TRUE(job) << to_string(diagnostics.list().front());
    EXPECT_TRUE(diagnostics.list().empty()) << to_string(diagnostics.list().front());
  }
  EXPECT_FALSE(cut_job_example("weld"));
}

}  // namespace
}  // namespace kerf

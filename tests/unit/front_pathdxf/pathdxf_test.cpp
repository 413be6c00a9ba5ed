// Path drawings from memory: callers, limits, messages.
#include "base/codes/pathdxf.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <set>

#include "front/pathdxf/pathdxf.h"

namespace kerf {
namespace {

std::string line(double x1, double y1, double x2, double y2, std::string_view type, std::string_view layer) {
  return fmt::format("0\nLINE\n8\n{}\n6\n{}\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", layer, type, x1, y1, x2, y2);
}
std::string circle(double x, double y, double diameter, std::string_view layer) {
  return fmt::format("0\nCIRCLE\n8\n{}\n6\nPHANTOM\n10\n{}\n20\n{}\n40\n{}\n", layer, x, y, diameter / 2.0);
}
std::string text(double x, double y, std::string_view value, std::string_view layer) {
  return fmt::format("0\nMTEXT\n8\n{}\n10\n{}\n20\n{}\n40\n1\n71\n5\n1\n{}\n", layer, x, y, value);
}
std::string path(std::string_view layer, std::string_view parameters, const std::string& elements) {
  return "0\nSECTION\n2\nENTITIES\n" + circle(0, 0, 1, layer) + text(0, 0, parameters, layer) + elements +
         circle(10, 0, 2, layer) + "0\nENDSEC\n0\nEOF\n";
}

class Pathdxf : public testing::Test {
 protected:
  Pathdxf() {
    options_.read_file = [this](const std::string& name) -> std::optional<std::string> {
      const auto found = files_.find(name);
      return found == files_.end() ? std::nullopt : std::optional(found->second);
    };
    options_.list_files = [this](const std::string&) {
      std::vector<std::string> names;
      for (const auto& [name, content] : files_) names.push_back(name);
      return names;
    };
  }
  PathdxfRun compile() { return compile_pathdxf("8999.1P.dxf", options_, diagnostics_); }

  std::map<std::string, std::string> files_;
  PathdxfOptions options_;
  Diagnostics diagnostics_;
};

TEST_F(Pathdxf, NamesEmbeddingsAsCallers) {
  files_["8998.dxf"] = path("8998_1P", "M1 O2 T2 I5 B0", line(0, 0, 10, 0, "CONTINUOUS", "8998_1P"));
  files_["8999.1P.dxf"] = path("8999_1P", "M1 O2 T2 S5",
                               line(0, 0, 10, 0, "DASHDOT", "8999_1P") + text(5, 0, ">8998.1P", "8999_1P"));
  const PathdxfRun run = compile();
  ASSERT_EQ(run.programs.size(), 1u);
  EXPECT_EQ(run.files, (std::vector<std::string>{"8999.1P.dxf", "8998.dxf"}));
  const Toolpath& path = run.programs[0].milling;
  std::size_t cuts = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!path[i].is_cutting()) continue;
    ++cuts;
    const Origin origin = path.origin_of(i);
    const auto* where = std::get_if<DrawingLocation>(&origin);
    ASSERT_NE(where, nullptr);
    EXPECT_EQ(where->file, "8998.dxf");
    EXPECT_EQ(where->entity, "LINE");
    const auto callers = path.origins().callers(path[i].origin());
    ASSERT_EQ(callers.size(), 1u);
    EXPECT_EQ(std::get<DrawingLocation>(callers[0]).file, "8999.1P.dxf");
  }
  EXPECT_EQ(cuts, 2u);  // a plunge and a line
}

TEST_F(Pathdxf, StartsAtAnUnknownPosition) {
  files_["8999.1P.dxf"] = path("8999_1P", "M1 O2 T2 I5 B0 S5", line(0, 0, 10, 0, "CONTINUOUS", "8999_1P"));
  const PathdxfRun run = compile();
  ASSERT_EQ(run.programs.size(), 1u);
  const Toolpath& path = run.programs[0].milling;
  std::vector<unsigned> unknown;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].is_motion()) unknown.push_back(path[i].unknown_axes());
  ASSERT_GE(unknown.size(), 2u);
  EXPECT_EQ(unknown[0], 3u);  // X and Y: only Z was commanded
  EXPECT_EQ(unknown[1], 0u);
  EXPECT_EQ(run.programs[0].tool_diameter, mm(2));
  EXPECT_EQ(run.programs[0].top, mm(2));
}

TEST_F(Pathdxf, HasTheSameMotionsWithAndWithoutTrace) {
  files_["8999.1P.dxf"] = path("8999_1P", "M1 O2 T2 I1 B0 S5", line(0, 0, 10, 0, "CONTINUOUS", "8999_1P"));
  const auto steps = [&](PathdxfComments comments) {
    options_.comments = comments;
    std::vector<Point3> ends;
    const PathdxfRun run = compile();
    const Toolpath& path = run.programs.at(0).milling;
    for (std::size_t i = 0; i < path.size(); ++i)
      if (path[i].is_motion()) ends.push_back(path[i].to());
    return ends;
  };
  EXPECT_EQ(steps(PathdxfComments::brief), steps(PathdxfComments::trace));
}

TEST_F(Pathdxf, StopsAtTheLimitOfSteps) {
  files_["8999.1P.dxf"] =
      path("8999_1P", "M1 O2 T2 I0.001 B0 S5", line(0, 0, 10, 0, "CONTINUOUS", "8999_1P"));
  options_.max_steps = 500;
  const PathdxfRun run = compile();
  ASSERT_TRUE(diagnostics_.has_errors());
  EXPECT_EQ(diagnostics_.list().back().code, codes::pathdxf_limit);
  ASSERT_EQ(run.programs.size(), 1u);
  EXPECT_LT(run.programs[0].milling.size(), 520u);
}

// A slot to the path's B0 where the text says B0.5mm breaks through the part.
TEST_F(Pathdxf, RefusesValuesThatAreNoNumbers) {
  for (const std::string value : {"Bfoo", "B0.5mm", "F1e", "I--1"}) {
    files_["8999.1P.dxf"] = path("8999_1P", "M1 O2 T2 I5 B0 S5",
                                 line(0, 0, 10, 0, "CONTINUOUS", "8999_1P") + text(5, 0, value, "8999_1P"));
    diagnostics_ = {};
    compile();
    ASSERT_EQ(diagnostics_.errors(), 1u) << value;
    const Diagnostic& d = diagnostics_.list().back();
    EXPECT_EQ(d.code, codes::pathdxf_value_range);
    EXPECT_EQ(d.message, fmt::format("{} value '{}' is not a number; text '{}' on layer 8999_1P",
                                     value.substr(0, 1), value.substr(1), value));
  }
}

TEST_F(Pathdxf, LimitsTheSupportBarsOfAnElement) {
  for (const std::string bars : {"P0.000001 U0.000001", "P0.0004 U0.0005"}) {
    files_["8999.1P.dxf"] =
        path("8999_1P", "M1 O2 T2 I5 B0 D1 S5 " + bars, line(0, 0, 10, 0, "BORDER", "8999_1P"));
    diagnostics_ = {};
    compile();
    ASSERT_EQ(diagnostics_.errors(), 1u) << bars;
    const auto& list = diagnostics_.list();
    EXPECT_TRUE(std::any_of(list.begin(), list.end(), [](const Diagnostic& d) {
      return d.code == codes::pathdxf_limit &&
             d.message.find("make more than 10000 support bars") != std::string::npos;
    }));
  }
}

TEST_F(Pathdxf, ChecksAreLimitedOverAllPaths) {
  std::string& file = files_["8999.1P.dxf"] = "0\nSECTION\n2\nENTITIES\n";
  constexpr int kPaths = 100;
  for (int i = 0; i < kPaths; ++i) {
    const std::string layer = fmt::format("8999_{}P", i);
    file += circle(0, 0, 1, layer) + text(0, 0, "M1 O2 T2 I0.1 B0 S5", layer) +
            line(0, 0, 10, 0, "CONTINUOUS", layer) + circle(10, 0, 2, layer);
  }
  file += "0\nENDSEC\n0\nEOF\n";
  options_.selection = PathdxfSelection::check_all;
  EXPECT_EQ(compile().programs.size(), kPaths);
  EXPECT_FALSE(diagnostics_.has_errors());
  options_.max_steps = 300;  // enough for each of them, but not for all
  const PathdxfRun run = compile();
  ASSERT_EQ(diagnostics_.list().size(), 1u);
  EXPECT_EQ(diagnostics_.list()[0].code, codes::pathdxf_limit);
  EXPECT_GT(run.programs.size(), 10u);
  EXPECT_LT(run.programs.size(), kPaths);
}

TEST_F(Pathdxf, PrintsMessagesAsTheOriginal) {
  Diagnostic d{Severity::error,
               codes::pathdxf_key,
               DrawingLocation{"in/8999.1P.dxf", "8999_1P~a", "2F", 1, 2, "LINE"},
               "message",
               {},
               {}};
  EXPECT_EQ(pathdxf_line(d), "LINE @ [1.000 2.000] # 8999.1P[8999.1P.dxf]: message");
  d.where = DrawingLocation{"in/8999.1P.dxf", "8999.1P", "", 0, 0, ""};
  EXPECT_EQ(pathdxf_line(d), "8999.1P[8999.1P.dxf]: message");
  d.where = TextLocation{"in/8999.1P.dxf", 0, 0};
  EXPECT_EQ(pathdxf_line(d), "in/8999.1P.dxf: message");
  d.where = {};
  EXPECT_EQ(pathdxf_line(d), "Options: message");
}

TEST_F(Pathdxf, ReadsNoDrawingTwice) {
  std::string elements;
  for (int i = 0; i < 20; ++i)
    elements += line(i % 2 == 0 ? 0 : 10, 0, i % 2 == 0 ? 10 : 0, 0, "DASHDOT", "8999_1P") +
                text(5, 0, ">8998.1P", "8999_1P");
  files_["8998.dxf"] = path("8998_1P", "M1 O2 T2 I5 B0", line(0, 0, 10, 0, "CONTINUOUS", "8998_1P"));
  files_["8999.1P.dxf"] = path("8999_1P", "M1 O2 T2 S5", elements + line(0, 0, 10, 0, "HIDDEN", "8999_1P"));
  std::map<std::string, int> reads;
  const auto read = options_.read_file;
  options_.read_file = [&](const std::string& name) {
    ++reads[name];
    return read(name);
  };
  compile();
  EXPECT_FALSE(diagnostics_.has_errors());
  EXPECT_EQ(reads["8998.dxf"], 1);
}

/// A random walk over a grid, each piece once: chains meet themselves at many points.
std::vector<std::pair<Point2, Point2>> walk(std::mt19937& random, int pieces) {
  constexpr double kGrid = 4.0;  // mm; the marks of start and end are circles of 1 and 2 mm
  std::vector<std::pair<Point2, Point2>> list;
  std::set<std::array<double, 4>> used;
  Point2 at{0, 0};
  while (static_cast<int>(list.size()) < pieces) {
    const auto draw = [&] { return kGrid * (static_cast<double>(random() % 4) - 1.0); };
    const Point2 to{at.x + draw(), at.y + draw()};
    if (to == at || !used.insert({at.x, at.y, to.x, to.y}).second) continue;
    if (!used.insert({to.x, to.y, at.x, at.y}).second) continue;
    list.emplace_back(at, to);
    at = to;
  }
  return list;
}

/// The cuts in the plane of a program, in their order.
std::vector<std::pair<Point3, Point3>> level_cuts(const Toolpath& path) {
  std::vector<std::pair<Point3, Point3>> cuts;
  Point3 at{};
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!path[i].is_motion()) continue;
    const Point3 to = path[i].to();
    if (path[i].is_cutting() && to.xy() != at.xy()) cuts.emplace_back(at, to);
    at = to;
  }
  return cuts;
}

/// A chain is milled in any order of its passes in which none is nearer to the tool than the next one (a
/// piece's next level at either end), here found among all of them.
TEST_F(Pathdxf, MillsTheNearestPassNext) {
  std::mt19937 random(7);
  int compared = 0;
  for (int round = 0; round < 60; ++round) {
    const auto pieces = walk(random, 2 + round % 25);
    std::string elements;
    for (const auto& [a, b] : pieces) elements += line(a.x, a.y, b.x, b.y, "CONTINUOUS", "8999_1P");
    const Point2 last = pieces.back().second;
    diagnostics_ = Diagnostics{};
    files_["8999.1P.dxf"] = "0\nSECTION\n2\nENTITIES\n" + circle(0, 0, 1, "8999_1P") +
                            text(0, 0, "M1 O2 T3 I1 B0 S5", "8999_1P") + elements +
                            circle(last.x, last.y, 2, "8999_1P") + "0\nENDSEC\n0\nEOF\n";
    const PathdxfRun run = compile();
    if (diagnostics_.has_errors() || run.programs.size() != 1) continue;  // no way over all pieces was found
    const auto cuts = level_cuts(run.programs[0].milling);
    ASSERT_EQ(cuts.size(), 3 * pieces.size());
    std::vector<double> next(pieces.size(), 2.0);  // levels 2, 1 and 0
    Point3 head{0, 0, 2.0};
    for (const auto& [from, to] : cuts) {
      double nearest = 1e9;
      std::size_t milled = pieces.size();
      for (std::size_t k = 0; k < pieces.size(); ++k) {
        if (next[k] < 0.0) continue;
        const auto [a, b] = pieces[k];
        const Point3 start{a.x, a.y, next[k]}, end{b.x, b.y, next[k]};
        nearest = std::min({nearest, distance(head, start), distance(head, end)});
        if ((from == start && to == end) || (from == end && to == start)) milled = k;
      }
      ASSERT_LT(milled, pieces.size()) << "round " << round;
      ASSERT_NEAR(distance(head, from), nearest, 1e-9) << "round " << round;
      next[milled] -= 1.0;
      head = to;
    }
    ++compared;
  }
  EXPECT_GE(compared, 15);
}

}  // namespace
}  // namespace kerf

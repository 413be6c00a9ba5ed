// The built-in table: complete, valid, consistent with the number scheme, and equal to the given exact
// profiles.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

#include "test_paths.h"

#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

const Tool& tool(int number) {
  const Tool* found = built_in_tools().find(number);
  EXPECT_NE(found, nullptr) << number;
  static const Tool none;
  return found == nullptr ? none : *found;
}

TEST(BuiltInTools, TheFileHasNoFault) {
  ToolTable table;
  Diagnostics diagnostics;
  std::ifstream file(std::filesystem::path(KERF_TEST_DATA).parent_path().parent_path() / "data" /
                     "tools.toml");
  ASSERT_TRUE(file);
  std::stringstream text;
  text << file.rdbuf();
  read_tool_file(text.str(), "data/tools.toml", table, diagnostics);
  for (const Diagnostic& diagnostic : diagnostics.list()) ADD_FAILURE() << to_string(diagnostic);
  EXPECT_EQ(table.tools().size(), built_in_tools().tools().size());
  EXPECT_GT(table.tools().size(), 80u);
}

TEST(BuiltInTools, HasEveryNumber) {
  for (const int number :
       {102,    100036, 201,    100047, 112,    100024, 122,    100012, 324,    205,   100048, 282,
        100204, 274,    278,    202,    204047, 101,    203036, 111,    202024, 121,   201012, 325,
        204048, 301,    390074, 302,    360071, 390,    390032, 327,    360098, 323,   330041, 374,
        906043, 375,    906053, 376,    907040, 378,    907050, 45981,  445981, 45982, 445982, 1370,
        401370, 1372,   401372, 501,    530131, 502,    540131, 56125,  603042, 56142, 602032, 814,
        814071, 808079, 808071, 45828,  204,    304,    312,    1568,   603032, 1570,  600002, 1572,
        604042, 1574,   600062, 13921,  648,    602,    603,    326,    251,    322,   690,    211,
        213,    214,    100058, 212,    205058, 311,    390121, 360121}) {
    EXPECT_NE(built_in_tools().find(number), nullptr) << number;
  }
}

TEST(BuiltInTools, HaveNamesFlutesAndShanks) {
  for (const auto& [number, t] : built_in_tools().tools()) {
    EXPECT_EQ(t.number, number);
    EXPECT_FALSE(t.description.empty()) << number;
    EXPECT_FALSE(t.names.empty()) << number;
    EXPECT_GT(t.silhouette.cutting.top(), 0.0) << number;
    for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank}) {
      const auto& knots = t.silhouette.part(part).knots;
      for (std::size_t i = 0; i + 1 < knots.size(); ++i) EXPECT_LE(knots[i].z, knots[i + 1].z) << number;
    }
    const bool has_shank = number == 648 || !t.silhouette.shank.empty();
    EXPECT_TRUE(has_shank) << number;
  }
}

TEST(BuiltInTools, SixDigitNumbersAreThoseOfTheScheme) {
  for (const auto& [number, t] : built_in_tools().tools()) {
    const auto generated = encode_tool_number(t);
    if (!generated) continue;
    const bool other = *generated / 10 % 100 == 9;  // "above an inch or other": needs no tool
    if (other && built_in_tools().find(*generated) == nullptr) continue;
    const Tool& plain = tool(*generated);
    EXPECT_EQ(encode_tool_number(plain), generated) << number;
    EXPECT_EQ(plain.shape.index(), t.shape.index()) << number;
    EXPECT_NEAR(plain.diameter.mm(), t.diameter.mm(), 0.02) << number;
    Diagnostics diagnostics;
    const auto decoded = decode_tool_number(*generated, {}, diagnostics);
    const bool says_size = decoded && !other && *generated / 100000 != 4;
    if (!says_size) continue;
    const auto again = make_tool(0, *decoded, {}, {}, diagnostics);
    ASSERT_TRUE(again) << number;
    EXPECT_NEAR(again->diameter.mm(), t.diameter.mm(), 0.0625) << number;
  }
}

TEST(BuiltInTools, RightValuesWhereTheOriginalIsWrong) {
  EXPECT_EQ(tool(278).silhouette.shank.max_radius(), 3.175);
  EXPECT_EQ(tool(375).silhouette.cutting.radius_at(5.0), 4.0);
  EXPECT_EQ(tool(378).silhouette.shank.max_radius(), 4.0);
  EXPECT_EQ(tool(45981).diameter, mm(12.7));
  EXPECT_EQ(tool(45982).flute, mm(15.875));
  EXPECT_EQ(tool(1370).flute, mm(7.9375));
  EXPECT_EQ(tool(1372).diameter, mm(19.05));
  EXPECT_NEAR(2 * tool(814).silhouette.cutting.radius_at(12.7), 6.367, 0.0005);
  EXPECT_NEAR(2 * tool(45828).silhouette.cutting.radius_at(20.955), 6.8099, 0.0005);
  EXPECT_NEAR(tool(327).silhouette.cutting.radius_at(21.9972), 12.7, 0.001);
  EXPECT_NEAR(tool(323).flute.mm(), 11.8493, 0.0001);
  EXPECT_NEAR(tool(502).flute.mm(), 4.1173, 0.0001);
  EXPECT_NEAR(tool(1570).diameter.mm(), 9.525, 1e-9);
  EXPECT_EQ(tool(648).diameter, mm(4.8));
  EXPECT_FALSE(tool(602).plunges);
  EXPECT_EQ(tool(311).diameter, mm(12.0));
  EXPECT_EQ(tool(212).flute, mm(26.0));
}

/// One segment of the given profiles, as two knots.
struct Segment {
  Knot from, to;
};

std::vector<Segment> segments_of(const nlohmann::json& profile) {
  std::vector<Segment> segments;
  for (const auto& part : profile) {
    Segment s;
    if (part.contains("line")) {
      s.from = {part["line"][0][0], part["line"][0][1], 0.0};
      s.to = {part["line"][1][0], part["line"][1][1], 0.0};
    } else {
      const auto& arc = part["arc"];
      s.from = {arc["from"][0], arc["from"][1], 0.0};
      s.to = {arc["to"][0], arc["to"][1], 0.0};
      const double sweep = arc["end_deg"].get<double>() - arc["start_deg"].get<double>();
      s.from.bulge = std::tan(degrees(0.25 * sweep).rad());
    }
    segments.push_back(s);
  }
  return segments;
}

/// Compares a cutting part with the given one, knot by knot.
void expect_profile(const Profile& ours, const nlohmann::json& given, double within,
                    const std::string& what) {
  const std::vector<Segment> segments = segments_of(given["profile_rz"]);
  ASSERT_EQ(ours.knots.size(), segments.size() + 1) << what;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    EXPECT_NEAR(ours.knots[i].r, segments[i].from.r, within) << what << " knot " << i;
    EXPECT_NEAR(ours.knots[i].z, segments[i].from.z, within) << what << " knot " << i;
    EXPECT_NEAR(ours.knots[i].bulge, segments[i].from.bulge, within) << what << " knot " << i;
    EXPECT_NEAR(ours.knots[i + 1].r, segments[i].to.r, within) << what << " knot " << i + 1;
    EXPECT_NEAR(ours.knots[i + 1].z, segments[i].to.z, within) << what << " knot " << i + 1;
  }
  EXPECT_NEAR(ours.top(), given["cutting_length"].get<double>(), within) << what;
}

TEST(BuiltInTools, EqualTheGivenExactProfiles) {
  const std::filesystem::path path = std::filesystem::path(KERF_CASES_DIR) / "volumes" / "expected.json";
  std::ifstream file(path);
  if (!file) GTEST_SKIP() << "the given cases are not here (KERF_CASES_DIR): exact profiles not compared";
  const nlohmann::json given = nlohmann::json::parse(file);
  for (const auto& [number, entry] : given["tools"].items()) {
    const Tool& known = tool(std::stoi(number));
    expect_profile(known.silhouette.cutting, entry, 1e-9, number);
    if (!entry["cutviewer"].is_string()) continue;
    const std::string comment = entry["cutviewer"];
    Diagnostics diagnostics;
    const auto shape = read_tool_comment(comment, 1.0, {}, diagnostics);
    ASSERT_TRUE(shape) << comment;
    const auto described = make_tool(known.number, *shape, {}, {}, diagnostics);
    ASSERT_TRUE(described) << comment;
    EXPECT_EQ(choose_tool(&known, &*described, {}, diagnostics), &known) << comment;
    EXPECT_TRUE(diagnostics.list().empty()) << comment;
    const auto again = read_tool_comment(*write_tool_comment(known.shape), 1.0, {}, diagnostics);
    ASSERT_TRUE(again) << number;
    EXPECT_EQ(again->index(), shape->index()) << number;
    for (const double fraction : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      const double z = fraction * std::min(described->flute, known.flute).mm();
      EXPECT_NEAR(described->silhouette.cutting.radius_at(z), known.silhouette.cutting.radius_at(z), 5e-5)
          << comment;
    }
  }
}

}  // namespace
}  // namespace kerf

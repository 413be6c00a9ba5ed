// Parameter texts, variables, path names, and the circles of texts.
#include "front/pathdxf/text/parameters.h"

#include <gtest/gtest.h>

#include "front/pathdxf/text/nearly.h"
#include "front/pathdxf/text/path_names.h"
#include "front/pathdxf/text/text_circle.h"

namespace kerf::pathdxf {
namespace {

class PathdxfText : public testing::Test {
 protected:
  ParameterText parse(std::string text) {
    ParameterText out;
    good_ = parse_parameters(std::move(text), {}, report_, out);
    return out;
  }
  static std::string value(const ParameterText& text, std::string_view key) {
    for (const Parameter& p : text.values)
      if (p.key == key) return p.value;
    return "none";
  }

  PathdxfOptions options_;
  Diagnostics diagnostics_;
  Report report_{options_, diagnostics_};
  bool good_ = false;
};

TEST_F(PathdxfText, SplitsParametersAtBlanksAndLineEnds) {
  const ParameterText text = parse("O2 T2\nS15  M20x2\r\nB-0,1 Q");
  EXPECT_TRUE(good_);
  EXPECT_EQ(text.values.size(), 6u);
  EXPECT_EQ(value(text, "M"), "20x2");
  EXPECT_EQ(value(text, "B"), "-0,1");
  EXPECT_EQ(value(text, "Q"), "");
}

TEST_F(PathdxfText, ContinuesValuesAfterATilde) {
  const ParameterText text = parse("O2\n:L5,10,~\n 20,25 :R0~1 Mab~ c");
  ASSERT_EQ(text.variables.size(), 2u);
  EXPECT_EQ(text.variables[0].value, "5,10,20,25");
  EXPECT_EQ(text.variables[1].value, "0~1");
  EXPECT_EQ(value(text, "M"), "abc");
}

TEST_F(PathdxfText, RefusesRepeatedKeysAndMisplacedVariables) {
  parse("O2 T1 O3 T2");
  EXPECT_FALSE(good_);
  EXPECT_EQ(diagnostics_.list().back().message,
            "The parameter(s) OT are specified more than once in 'O2 T1 O3 T2'");
  for (const char* text : {"O=A", "N=A", "@=A", ":A1 :A2", ":"}) {
    parse(text);
    EXPECT_FALSE(good_) << text;
  }
  parse("B=A T=A");
  EXPECT_TRUE(good_);
}

TEST_F(PathdxfText, ReportsAMessageOnce) {
  parse("O1 O1");
  parse("O1 O1");
  EXPECT_EQ(diagnostics_.list().size(), 1u);
  EXPECT_EQ(report_.attempts(), 2u);
}

TEST_F(PathdxfText, ReplacesVariables) {
  std::string unknown;
  const Variables variables{{"A", "1"}, {"B", "=A2"}, {"C", "=C="}};
  EXPECT_EQ(replace_variables("x=Ay=B", variables, unknown), "x1y12");
  EXPECT_EQ(unknown, "");
  EXPECT_EQ(replace_variables("=Z=A=", variables, unknown), "=Z1=");
  EXPECT_EQ(unknown, "Z");
  EXPECT_FALSE(replace_variables("=C", variables, unknown));
}

TEST_F(PathdxfText, ReadsNumbersWithPointOrComma) {
  EXPECT_EQ(parse_value("1,5"), 1.5);
  EXPECT_EQ(parse_value("-.5"), -0.5);
  EXPECT_FALSE(parse_value("1.5x"));
  EXPECT_FALSE(parse_value(""));
}

TEST_F(PathdxfText, KnowsThePermittedValuesOfVariables) {
  const auto list = VariableDefinition::parse("5, 10,?20");
  ASSERT_TRUE(list);
  EXPECT_TRUE(list->permits("10"));
  EXPECT_TRUE(list->permits("20"));
  EXPECT_FALSE(list->permits("5,10"));
  EXPECT_EQ(list->example(4), "10");
  const auto characters = VariableDefinition::parse("?PQR");
  ASSERT_TRUE(characters);
  EXPECT_TRUE(characters->permits("Q"));
  EXPECT_FALSE(characters->permits("PQ"));
  const auto range = VariableDefinition::parse("-0.5~1,2");
  ASSERT_TRUE(range);
  EXPECT_TRUE(range->permits("-0.5"));
  EXPECT_TRUE(range->permits("1,2"));
  EXPECT_FALSE(range->permits("1.21"));
  EXPECT_FALSE(range->permits("x"));
  EXPECT_EQ(range->example(0), "-0.5");
  EXPECT_EQ(range->example(3), "1,2");
  EXPECT_TRUE(VariableDefinition::parse("X"));
  EXPECT_FALSE(VariableDefinition::parse(""));
  EXPECT_FALSE(VariableDefinition::parse("?"));
  EXPECT_FALSE(VariableDefinition::parse("a~b"));
}

TEST_F(PathdxfText, FindsPathNamesInLayers) {
  const auto names = PathNames::make(options_, report_);
  ASSERT_TRUE(names);
  EXPECT_EQ(names->of_layer("8999_1P"), "8999.1P");
  EXPECT_EQ(names->of_layer("2916_2P~A"), "2916.2P");
  EXPECT_EQ(names->of_layer("8999.01p"), "8999.01p");
  for (const char* layer : {"0", "2913", "3456.9", "5678.9AB", "x8999.1P", "8999.1P~1", "4567.8\xC3\x84"})
    EXPECT_FALSE(names->of_layer(layer)) << layer;
  EXPECT_EQ(names->in_value("8998.1P"), "8998.1P");
  EXPECT_FALSE(names->in_value("5678.9AB"));
}

// The rows of the document's section 4.3 and its errata.
TEST_F(PathdxfText, MatchesFileNames) {
  const auto names = PathNames::make(options_, report_);
  ASSERT_TRUE(names);
  struct Row {
    const char *stem, *path;
    bool matches;
  };
  for (const Row& row :
       {Row{"1234", "1234.3A", true}, Row{"1234.5", "1234.5P", true}, Row{"1234.5", "1234.6P", false},
        Row{"1234-1236", "1235.99B", true}, Row{"1234-1236", "1237.1A", false},
        Row{"1234.5-1234.10", "1234.9A", true}, Row{"1234.5-1234.10", "1234.40A", false},
        Row{"1230-1239,1241", "1241.2P", true}, Row{"Parts 8990-8998,8990 x", "8998.1P", true},
        Row{"x8998y", "8998.1P", true}, Row{"18998", "8998.1P", false}, Row{"", "8998.1P", false}})
    EXPECT_EQ(names->may_contain(row.stem, row.path), row.matches) << row.stem << " " << row.path;
}

TEST_F(PathdxfText, ComparesGroups) {
  EXPECT_EQ(compare_groups({"8000", "9"}, {"8000", "10", "A"}), -1);
  EXPECT_EQ(compare_groups({"8000", "a"}, {"8000", "A"}), 0);
  EXPECT_EQ(compare_groups({"8000", "1"}, {"8000", ""}), 1);
  EXPECT_EQ(compare_groups({"08000", ""}, {"8000", "1"}), 0);
  EXPECT_EQ(compare_groups({"99999999999999999999"}, {"100000000000000000000"}), -1);
}

dxf::Text mtext(std::string text, int attachment, double height = 1.0) {
  dxf::Text t;
  t.kind = dxf::TextKind::mtext;
  t.text = std::move(text);
  t.attachment = attachment;
  t.height = height;
  return t;
}

TEST_F(PathdxfText, RemovesFormatting) {
  EXPECT_EQ(unformatted(mtext("\\W1.13;{\\fArial|b0;B1}\\PM\\{x\\}^Iy\\~z", 1)), "B1\nM{x}\ty z");
  EXPECT_EQ(unformatted(mtext("\\U+00e4\\LQ\\l", 1)), "\xC3\xA4Q");
  EXPECT_EQ(without_special_characters("M%%c5%%D%%p%%"), "M_D5_G_+%%");
}

// The document's example: B1 of 1.5 mm has a circle of 2.343 mm (TEXT); MTEXT has at most 0.7 of its height.
TEST_F(PathdxfText, DrawsCirclesAroundTexts) {
  dxf::Text t;
  t.text = "B1";
  t.height = 1.5;
  const auto circle = circle_of(t);
  ASSERT_TRUE(circle);
  EXPECT_NEAR(2.0 * circle->radius, 2.343, 5e-4);
  EXPECT_DOUBLE_EQ(circle->centre.x, 0.9);
  EXPECT_DOUBLE_EQ(circle->centre.y, 0.75);
  const auto wide = circle_of(mtext("M1 O2 T2 I1 B0 S5", 5));
  ASSERT_TRUE(wide);
  EXPECT_DOUBLE_EQ(wide->radius, 0.7);
  EXPECT_EQ(wide->centre, (Point2{0.0, 0.0}));
}

TEST_F(PathdxfText, CountsALineEndAsACharacter) {
  const auto circle = circle_of(mtext("M1 O2 T2\\PI1 B0 S5", 7));
  ASSERT_TRUE(circle);
  EXPECT_DOUBLE_EQ(circle->centre.x, 0.6 * 9 / 2);
  EXPECT_DOUBLE_EQ(circle->centre.y, 1.0);
}

TEST_F(PathdxfText, CentresTheCircleOfEveryAnchor) {
  for (int attachment = 1; attachment <= 9; ++attachment) {
    const auto circle = circle_of(mtext("B1", attachment));
    ASSERT_TRUE(circle);
    EXPECT_DOUBLE_EQ(circle->centre.x, 0.6 - 0.6 * ((attachment - 1) % 3)) << attachment;
    EXPECT_DOUBLE_EQ(circle->centre.y, -0.5 + 0.5 * ((attachment - 1) / 3)) << attachment;
  }
  EXPECT_FALSE(circle_of(mtext("B1", 0)));
}

TEST_F(PathdxfText, RefusesRotatedTextsUnlessCentred) {
  dxf::Text t = mtext("B1", 7);
  t.rotation = 360.5;
  EXPECT_TRUE(circle_of(t));
  t.rotation = 5.0;
  EXPECT_FALSE(circle_of(t));
  t.attachment = 5;
  EXPECT_TRUE(circle_of(t));
  dxf::Text upside;
  upside.text = "B1";
  upside.upside_down = true;
  EXPECT_FALSE(circle_of(upside));
}

TEST_F(PathdxfText, ComparesWithTheTolerance) {
  EXPECT_TRUE(near(100.0, 100.0001));
  EXPECT_FALSE(near(100.0, 100.001));
  EXPECT_TRUE(near(Point2{0, 0}, Point2{3e-5, 0}));
  EXPECT_FALSE(near(Point2{0, 0}, Point2{4e-5, 0}));
  EXPECT_FALSE(above(1.0 + 1e-7, 1.0));
  EXPECT_TRUE(at_least(1.0 - 1e-7, 1.0));
}

}  // namespace
}  // namespace kerf::pathdxf

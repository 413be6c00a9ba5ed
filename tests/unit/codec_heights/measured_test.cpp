// Files of measured heights.
#include "kerf/formats/measured.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

MeasuredFile read(std::string_view text, Diagnostics& diagnostics,
                  std::optional<std::array<double, 3>> offset = {}) {
  MeasuredOptions options;
  options.work_offset = offset;
  return read_measured(text, "heights", options, diagnostics);
}

TEST(Measured, AListOfProbes) {
  Diagnostics d;
  const MeasuredFile f =
      read("([57.358 242.020]/T=2.000) #51=2.1\n\n([97.06 242]/L:ZB/T=2.5) #52= 1,85 \r\n", d);
  EXPECT_FALSE(d.has_errors());
  ASSERT_EQ(f.heights.size(), 2u);
  EXPECT_EQ(f.format, HeightsFormat::probe_list);
  EXPECT_EQ(f.heights[0].variable, 51);
  EXPECT_DOUBLE_EQ((*f.heights[0].at)[1], 242.02);
  EXPECT_EQ(f.heights[1].label, "ZB");
  EXPECT_EQ(f.heights[1].expected, 2.5);
  EXPECT_EQ(f.heights[1].height, 1.85);
  EXPECT_EQ(f.heights[1].line, 3u);
}

TEST(Measured, ALogInInchesWithItsOffset) {
  Diagnostics d;
  const MeasuredFile f = read(
      "$13=1\n[G54:1.000,2.000,-1.000]\n[G92:0.0,0.0,0.5]\n[TLO:0.0]\n[PRB:9.0,9.0,9.0:1]\n"  // of the answer
      "[PRB:2.0,2.0,-0.4:1]\n[PRB:3.0,2.0,0:0]\n",
      d);
  EXPECT_FALSE(d.has_errors());
  ASSERT_EQ(f.heights.size(), 2u);
  EXPECT_NEAR((*f.heights[0].at)[0], 25.4, 1e-9);
  EXPECT_NEAR(*f.heights[0].height, 0.1 * 25.4, 1e-9);  // -0.4 - (-1 + 0.5)
  EXPECT_FALSE(f.heights[1].height.has_value());
}

TEST(Measured, AGivenOffsetPrecedesThatOfTheLog) {
  Diagnostics d;
  const MeasuredFile f = read("WCO:9,9,9\n[PRB:2,3,4:1]\n", d, std::array<double, 3>{1, 1, 1});
  ASSERT_EQ(f.heights.size(), 1u);
  EXPECT_EQ(f.heights[0].height, 3.0);
  Diagnostics without;
  read("[PRB:2,3,4:1]\n", without);
  EXPECT_TRUE(without.has_errors());
}

TEST(Measured, LimitsOfAProbeFileAreNoPoints) {
  Diagnostics d;
  EXPECT_EQ(read("0 20 2\n0 10 2\n-1 1 50\n0 0 .1\n20 0 .2\n0 10 .3\n20 10 .1\n", d).heights.size(), 4u);
  EXPECT_FALSE(d.has_errors());
  // Points are missing, are more than stated, or are elsewhere; a line of the head is damaged or missing.
  for (const char* text : {"0 20 2\n0 10 2\n-1 1 50\n0 0 .1\n20 0 .2\n", "0 20 2\n0 10 2\n-1 1 50\n",
                           "0 20 2\n0 10 2\n-1 1 50\n0 0 .1\n20 0 .2\n0 10 .3\n20 10 .1\n20 20 .1\n",
                           "0 20 2\n0 10 2\n-1 1 50\n0 0 .1\n20 0 .2\n0 10 .3\n20 11 .1\n",
                           "0 20 2\n0 10 2\n-1 1 50\n0 0 .1\n20 0 .2\n0 10 .3\n0 10 .3\n",
                           "0 20 2\n0 10 2.5\n-1 1 50\n\n\n0 0 .1\n20 0 .2\n0 10 .3\n20 10 .1\n",
                           "0 10 2\n-1 1 50\n\n\n0 0 .1\n20 0 .2\n0 10 .3\n20 10 .1\n"}) {
    Diagnostics problems;
    read(text, problems);
    EXPECT_TRUE(problems.has_errors()) << text;
  }
  // Heights above a far zero are points: their numbers are no limits and counts.
  EXPECT_EQ(read("-10 0 5\n-10 10 5\n-10 20 5\n", d).heights.size(), 3u);
  EXPECT_FALSE(d.has_errors());
}

std::vector<double> position(std::string_view line) {
  Diagnostics d;
  const MeasuredFile f = read(line, d);
  if (d.has_errors() || f.heights.size() != 1) return {};
  return {(*f.heights[0].at)[0], (*f.heights[0].at)[1], f.heights[0].height.value_or(1e9)};
}

TEST(Measured, CommasSeparateNumbersOrAreDecimal) {
  const std::vector<double> expected{1.5, 20, -0.25};
  for (const char* line :
       {"1.5 20 -0.25", "1.5,20,-0.25", "1.5, 20, -.25", "1.5\t20\t-0.25", "1,5;20;-0,25", "1,5; 20,0; -0,25",
        "1,5 20 -0,25", "1,5\t20,0\t-0,25", "1.5;20;-0.25", "1.5,20,-0.25,7,8,0", "1,5 20 -0,25 0,0 0,0 0,0"})
    EXPECT_EQ(position(line), expected) << line;
  EXPECT_EQ(position("1,20,3"), (std::vector<double>{1, 20, 3}));
  // Of these it is not known what the commas are.
  for (const char* line : {"1,5,20,0,-0,25", "5,10,2,9", "1,5 20,0", "1.5,2;20;3", "1,2,3 20 -0,25"})
    EXPECT_EQ(position(line), std::vector<double>{}) << line;
}

TEST(Measured, ColumnsAreTakenByTheirNames) {
  for (const char* text :
       {"N;X;Y;Z\n1;1,5;2;3\n", "Y;X;Z\n2;1.5;3\n", "x,y,z,comment\n1.5,2,3,a, b\n", "z\ty\tx\n3\t2\t1.5\n",
        "# y x z\n2 1.5 3\n", "x y z\n1.5, 2, 3\n", "y,x,z\n2;1,5;3\n", "X [mm], Y [mm], Z [mm]\n1.5,2,3\n",
        "; measured today\n\nheight,x,y\n3,1.5,2\n", "# a map of y x z\n1.5 2 3\n"})
    EXPECT_EQ(position(text), (std::vector<double>{1.5, 2, 3})) << text;
  EXPECT_EQ(position("x (inch),y (inch),z (inch)\n1,2,3\n"), (std::vector<double>{25.4, 50.8, 3 * 25.4}));
  for (const char* text : {"x,y,z1\n1,2,3\n", "x,y\n1,2\n", "a,b,c\n1,2,3\n", "x,y,z,x\n1,2,3,4\n",
                           "x,y,z\n1,5,2,0\n", "x;y;z\n1;;3\n", "x [mm],y [inch],z\n1,2,3\n", "1,5,2,0\n"})
    EXPECT_EQ(position(text), std::vector<double>{}) << text;
}

TEST(Measured, LinesHaveTheSameColumnsAndNumbersAlone) {
  for (const char* text : {"1 2 3\n4 5\n", "1 2 3\n4 5 6 7\n", "1 2 3 4\n1 2 3 4\n", "1 2 nan\n", "1,2,inf\n",
                           "1;2;\n", "1;;2;3\n", "1,,2\n", "1 2 3x\n", "1 2 1e999\n"}) {
    Diagnostics d;
    read(text, d);
    ASSERT_TRUE(d.has_errors()) << text;
    EXPECT_NE(std::get_if<TextLocation>(&d.list()[0].where), nullptr);
    EXPECT_GT(std::get<TextLocation>(d.list()[0].where).line, 0u) << text;
  }
}

TEST(Measured, TwoHeightsAtOnePositionAreAWarning) {
  Diagnostics d;
  EXPECT_EQ(read("0 0 .1\n10 0 .2\n0.02 0 .4\n", d).heights.size(), 3u);
  ASSERT_EQ(d.list().size(), 1u);
  const std::string text = to_string(d.list()[0]);
  for (const char* part : {"heights:3", "line 1", "0.400", "0.100", "0.300 mm"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  Diagnostics same;
  read("0 0 .1\n10 0 .2\n0 0 .1005\n", same);
  EXPECT_TRUE(same.list().empty());
}

TEST(Measured, FilesThatAreNoText) {
  for (const std::string_view text : {std::string_view("\x89PNG\r\n\x1a\n\0\0\0", 11),
                                      std::string_view("%PDF-1.4\n"), std::string_view("1 2 3\0", 6)}) {
    Diagnostics d;
    EXPECT_TRUE(read(text, d).heights.empty());
    EXPECT_EQ(d.list().size(), 1u);
    EXPECT_TRUE(d.has_errors());
  }
  Diagnostics d;
  read("<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>\n", d);
  EXPECT_EQ(d.list().size(), 1u);
}

TEST(Measured, AnOffsetOfALogThatIsDamagedIsAnError) {
  for (const char* text : {"WCO:1,2,x\n[PRB:2,3,4:1]\n", "WCO:1,2,3\n[PRB:2,3,4:1]\n<Idle|WCO:1,2>\n",
                           "[G54:1,2,3]\n[TLO:?]\n[PRB:2,3,4:1]\n", "WCO:1,2,3\n[PRB:2,3,4:x]\n"}) {
    Diagnostics d;
    read(text, d);
    EXPECT_TRUE(d.has_errors()) << text;
  }
}

TEST(Measured, HeightsBelongToTheNearestTarget) {
  Diagnostics d;
  const MeasuredFile f = read("0.1 0 1\n10 0.1 2\n10 0 3\n", d);
  const std::vector<HeightTarget> targets{{51, {0, 0}, 1.5}, {52, {10, 0}, {}}};
  const auto values = heights_of(f, targets, mm(0.2), mm(1), Language::english, d);
  EXPECT_FALSE(d.has_errors());
  EXPECT_EQ(d.warnings(), 1u);  // two heights of one target
  EXPECT_EQ(values.at(51), 1.0);
  EXPECT_EQ(values.at(52), 3.0);  // the last one
  Diagnostics strict;
  heights_of(f, targets, mm(0.05), mm(1), Language::english, strict);
  EXPECT_TRUE(strict.has_errors());
}

}  // namespace
}  // namespace kerf

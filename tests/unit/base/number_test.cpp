// Numbers as text: rounding, no "-0", and reading back.
#include "kerf/number.h"

#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <random>

namespace kerf {
namespace {

TEST(Number, DropsTrailingZerosAndNegativeZero) {
  EXPECT_EQ(number_text(12.5, 3), "12.5");
  EXPECT_EQ(number_text(3.0, 3), "3");
  EXPECT_EQ(number_text(100.0, 0), "100");
  EXPECT_EQ(number_text(-0.0001, 3), "0");
  EXPECT_EQ(fixed_text(-0.0001, 3), "0.000");
  EXPECT_EQ(fixed_text(-0.25, 2), "-0.25");
}

TEST(Number, FixedIsRoundedAsPrintfDoes) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-12, 9);
  for (int i = 0; i < 200'000; ++i) {
    const int decimals = static_cast<int>(random() % 16);
    double v = std::pow(10.0, exponent(random)) * (random() % 2 == 0 ? 1 : -1);
    if (i % 3 == 0) v = std::round(v * 2000.0) / 2000.0;  // halves of the last place
    char expected[400];
    std::snprintf(expected, sizeof expected, "%.*f", decimals, v);
    std::string text;
    append_fixed(text, v, decimals, MinusZero::keep);
    ASSERT_EQ(text, expected) << decimals;
  }
  std::string text;
  append_fixed(text, 1e300, 2, MinusZero::keep);
  EXPECT_EQ(text.size(), 304u);
  EXPECT_EQ(fixed_text(0.0, 0), "0");
  EXPECT_EQ(fixed_text(10.0, 0), "10");
  EXPECT_EQ(fixed_text(100.5, 1), "100.5");
}

TEST(Number, ReadsOnlyWholeFiniteNumbers) {
  EXPECT_EQ(parse_number("-.5"), -0.5);
  EXPECT_EQ(parse_number("+2.50"), 2.5);
  EXPECT_EQ(parse_number("1e-3"), 0.001);
  EXPECT_FALSE(parse_number(""));
  EXPECT_FALSE(parse_number("1e999"));
  EXPECT_FALSE(parse_number("nan"));
  EXPECT_FALSE(parse_number("0x10"));
  EXPECT_FALSE(parse_number("1 "));
}

TEST(Number, LengthsWithTheirUnit) {
  EXPECT_EQ(parse_length("6.35", 1.0), 6.35);
  EXPECT_EQ(parse_length("0.25in", 1.0), 6.35);
  EXPECT_EQ(parse_length("1/4 Inch", 1.0), 6.35);
  EXPECT_EQ(parse_length("6mm", 25.4), 6.0);
  EXPECT_EQ(parse_length("2", 25.4), 50.8);
  for (const char* text : {"", "in", "1/0", "6 ft", "x6mm", "1e999in"}) EXPECT_FALSE(parse_length(text, 1.0));
}

TEST(Number, ExactTextReadsBackAsTheSame) {
  for (const double v : {0.1, -1.0 / 3.0, 1e-300, 123456789.125}) EXPECT_EQ(parse_number(exact_text(v)), v);
}

TEST(DidYouMean, FindsSlipsButNotOtherWords) {
  const std::vector<std::string> known{"simulate", "info", "check", "steps"};
  EXPECT_EQ(did_you_mean("simluate", known), "simulate");
  EXPECT_EQ(did_you_mean("chek", known), "check");
  EXPECT_FALSE(did_you_mean("elephant", known));
}

}  // namespace
}  // namespace kerf

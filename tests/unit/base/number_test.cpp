// Numbers as text: rounding, no "-0", and reading back.
#include "base/number.h"

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
    if (i % 3 == 0) v = std::round(v * 2000.0) / 2000.0;  // halves of the last decimal
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

TEST(Number, DecimalsOfAnyLengthAreRoundedAsTheCLibraryRoundsThem) {
  std::uint64_t state = 1;
  const auto random = [&] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return state >> 33;
  };
  for (int i = 0; i < 200000; ++i) {
    std::string text = random() % 2 == 0 ? "-" : "";
    const auto before = random() % 20, after = random() % 20;
    if (before + after == 0) continue;
    for (std::uint64_t k = 0; k < before; ++k) text += static_cast<char>('0' + random() % 10);
    if (after > 0) text += '.';
    for (std::uint64_t k = 0; k < after; ++k) text += static_cast<char>('0' + random() % 10);
    ASSERT_EQ(parse_number(text), std::strtod(text.c_str(), nullptr)) << text;
  }
  // Halfway between two doubles, and one digit beside it.
  for (const char* text :
       {"9007199254740993", "9007199254740992.5", "9007199254740993.0", "9007199254740995.",
        "4503599627370496.5", "4503599627370497.5", "4503599627370497.501", "0.5", "-0",
        "1152921504606846977.", "0000000000000000001", "0.0000000000000000001", "1."})
    EXPECT_EQ(parse_number(text), std::strtod(text, nullptr)) << text;
  EXPECT_TRUE(std::signbit(*parse_number("-0.0")));
  for (const char* text : {".", "-", "+", "-.", "1.2.3", "1-2", "--1"})
    EXPECT_FALSE(parse_number(text)) << text;
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
  // The shortest digits that have the same value, as Python's repr gives them.
  EXPECT_EQ(exact_text(0.1), "0.1");
  EXPECT_EQ(exact_text(-1.0 / 3.0), "-0.3333333333333333");
  EXPECT_EQ(exact_text(123456789.125), "123456789.125");
}

TEST(DidYouMean, FindsSlipsButNotOtherWords) {
  const std::vector<std::string> known{"simulate", "info", "check", "steps"};
  EXPECT_EQ(did_you_mean("simluate", known), "simulate");
  EXPECT_EQ(did_you_mean("chek", known), "check");
  EXPECT_FALSE(did_you_mean("elephant", known));
}

}  // namespace
}  // namespace kerf

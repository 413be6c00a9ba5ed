// Formulas of corrected heights.
#include "base/formula.h"

#include <gtest/gtest.h>
#include <string>

namespace kerf {
namespace {

std::optional<double> value(std::string_view text, FormulaFault& fault) {
  return evaluate_formula(
      text, [](int variable) { return variable == 51 ? std::optional(2.1) : std::nullopt; }, fault);
}

TEST(Formula, Values) {
  FormulaFault fault;
  const std::pair<const char*, double> cases[] = {
      {"1", 1},          {"8-4-2", 2}, {"16/4/2", 2}, {"2+3*4", 14},
      {"[2+3]*(4)", 20}, {"-2*-3", 6}, {"--1", 1},    {" 0.800 + 0.794*[#51-2.000]", 0.8794},
      {".5+1.", 1.5}};
  for (const auto& [text, expected] : cases) {
    const auto result = value(text, fault);
    ASSERT_TRUE(result.has_value()) << text;
    EXPECT_NEAR(*result, expected, 1e-12) << text;
  }
}

TEST(Formula, Faults) {
  using Kind = FormulaFault::Kind;
  const std::tuple<std::string, Kind, std::size_t> cases[] = {
      {"", Kind::unexpected, 0},        {"1+", Kind::unexpected, 2},
      {"1 2", Kind::rest, 2},           {"(1]", Kind::bracket_missing, 2},
      {"[1", Kind::bracket_missing, 2}, {"1+#52", Kind::unknown_variable, 2},
      {"#", Kind::unexpected, 0},       {"#-1", Kind::unexpected, 0},
      {"1/0", Kind::not_finite, 3},     {"1.2.3", Kind::unexpected, 0}};
  for (const auto& [text, kind, offset] : cases) {
    FormulaFault fault;
    EXPECT_FALSE(value(text, fault).has_value()) << text;
    EXPECT_EQ(fault.kind, kind) << text;
    EXPECT_EQ(fault.offset, offset) << text;
  }
  FormulaFault fault;
  EXPECT_FALSE(value(std::string(100'000, '('), fault).has_value());
  EXPECT_EQ(fault.kind, Kind::too_deep);
}

}  // namespace
}  // namespace kerf

// Numbers with units and formulas.
#include "base/quantity.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

std::optional<double> value(std::string_view text, std::string_view unit, std::string& fault) {
  const auto name = [](std::string_view word) {
    return word == "stock.z" ? std::optional(12.0) : std::nullopt;
  };
  return read_quantity(text, unit, name, fault);
}

TEST(Quantity, Values) {
  const std::tuple<const char*, const char*, double> cases[] = {{"6", "mm", 6},
                                                                {"1/4in", "mm", 6.35},
                                                                {"1-1/2 in", "mm", 38.1},
                                                                {"3 - 1/2", "mm", 2.5},
                                                                {"2.5cm", "mm", 25},
                                                                {"60ipm", "mm/min", 1524},
                                                                {"60 in/min", "mm/min", 1524},
                                                                {"10mm/s", "mm/min", 600},
                                                                {"40%", "", 0.4},
                                                                {"stock.z + 0.2", "mm", 12.2},
                                                                {"stock.z/2 + 1/4in", "mm", 12.35},
                                                                {"-(1in - 5.4)", "mm", -20},
                                                                {"1e-3", "mm", 0.001},
                                                                {"16krpm", "rpm", 16000},
                                                                {"500ms", "s", 0.5},
                                                                {"1/4", "inch", 0.25},
                                                                {"6.35mm + 1/4", "inch", 0.5},
                                                                {"254mm/min", "inch/min", 10},
                                                                {"60ipm", "inch/min", 60}};
  for (const auto& [text, unit, expected] : cases) {
    std::string fault;
    const auto given = value(text, unit, fault);
    ASSERT_TRUE(given.has_value()) << text << ": " << fault;
    EXPECT_NEAR(*given, expected, 1e-9) << text;
  }
}

TEST(Quantity, FaultsNameThePosition) {
  const std::tuple<const char*, const char*, const char*> cases[] = {
      {"6 furlong", "mm", "unknown unit furlong at character 3"},
      {"6in", "rpm", "unknown unit in"},
      {"6ipm", "inch", "units are mm, cm"},
      {"stock.q", "mm", "unknown name stock.q"},
      {"", "mm", "expected a number"},
      {"(1", "mm", ") is missing"},
      {"1/0", "mm", "not finite"},
      {"nan", "mm", "unknown name nan"}};
  for (const auto& [text, unit, part] : cases) {
    std::string fault;
    EXPECT_FALSE(value(text, unit, fault).has_value()) << text;
    EXPECT_NE(fault.find(part), std::string::npos) << text << ": " << fault;
  }
}

}  // namespace
}  // namespace kerf

// Values of OpenSCAD programs: their text, equality and deletion.
#include "front/scad/value/value.h"

#include <cmath>
#include <gtest/gtest.h>

namespace kerf::scad {
namespace {

/// Expected texts are those of OpenSCAD 2021.01.
TEST(ScadValue, PrintsNumbersWithSixDigits) {
  EXPECT_EQ(to_string(0.1), "0.1");
  EXPECT_EQ(to_string(1e6), "1e+6");
  EXPECT_EQ(to_string(100000.0), "100000");
  EXPECT_EQ(to_string(1234567.0), "1.23457e+6");
  EXPECT_EQ(to_string(1.0 / 3), "0.333333");
  EXPECT_EQ(to_string(-0.0), "0");
  EXPECT_EQ(to_string(999999.5), "1e+6");
  EXPECT_EQ(to_string(HUGE_VAL), "inf");
  EXPECT_EQ(to_string(1e-20), "1e-20");
}

TEST(ScadValue, PrintsStringsWithMarksInVectorsOnly) {
  const Value list = Value::vector({Value::string("a"), 2.0, Value::truth(true), {}});
  EXPECT_EQ(to_string(list), "[\"a\", 2, true, undef]");
  EXPECT_EQ(as_text(Value::string("a")), "a");
  EXPECT_EQ(to_string(Value::range(0, 1, 5)), "[0 : 1 : 5]");
}

TEST(ScadValue, ComparesByTypeAndContent) {
  EXPECT_TRUE(equal(Value::vector({1.0, Value::vector({})}), Value::vector({1.0, Value::vector({})})));
  EXPECT_FALSE(equal(Value(1.0), Value::truth(true)));
  EXPECT_FALSE(equal(Value(std::nan("")), Value(std::nan(""))));
  EXPECT_TRUE(equal({}, {}));
}

TEST(ScadValue, DeletesDeepNestingWithoutRecursion) {
  Meter meter;
  {
    Value v;
    for (int i = 0; i < 1'000'000; ++i) v = Value::vector({v}, &meter);
    EXPECT_EQ(v.nesting(), 1'000'000u);
    EXPECT_GT(meter.bytes, 16'000'000u);
  }
  EXPECT_EQ(meter.bytes, 0u);
}

TEST(ScadValue, CountsValuesOfRanges) {
  EXPECT_EQ((Range{0, 1, 5}).count(), 6);
  EXPECT_EQ((Range{5, 1, 0}).count(), 0);
  EXPECT_EQ((Range{5, -2, 0}).count(), 3);
  EXPECT_EQ((Range{0, 0.25, 1}).count(), 5);
  EXPECT_EQ((Range{0, 0.1, 0.3}).count(), 4);  // 0.3 / 0.1 is below 3
  EXPECT_EQ((Range{0, -0.1, -0.3}).count(), 4);
  EXPECT_EQ((Range{1, 0.1, 1.7}).count(), 8);
  EXPECT_EQ((Range{0, 0.1, 0.299}).count(), 3);
  EXPECT_TRUE(std::isinf((Range{0, 0, 1}).count()));
  EXPECT_TRUE(std::isinf((Range{0, 2, HUGE_VAL}).count()));
  EXPECT_EQ((Range{1, 0, 1}).count(), 0);
  EXPECT_EQ((Range{0, HUGE_VAL, 1}).count(), 1);
  EXPECT_EQ((Range{1, -HUGE_VAL, 0}).at(0), 1);
  EXPECT_EQ((Range{HUGE_VAL, 2, 0}).count(), 0);
  EXPECT_EQ((Range{std::nan(""), 1, 1}).count(), 0);
}

// As OpenSCAD's test of operators: all ranges without a value are equal, and before those with values.
TEST(ScadValue, ComparesRangesAsListsOfValues) {
  EXPECT_TRUE((Range{1, -1, 3}) == (Range{-1, -1, 1}));
  EXPECT_TRUE((Range{1, -1, 3}) < (Range{1, -1, -1}));
  EXPECT_TRUE((Range{1, -1, 3}) < (Range{0, 1, 0}));
  EXPECT_TRUE((Range{0, 1, 3}) == (Range{0, 1, 3.5}));
  EXPECT_TRUE((Range{0, 1, 3}) < (Range{0, 1, 4}));
}

}  // namespace
}  // namespace kerf::scad

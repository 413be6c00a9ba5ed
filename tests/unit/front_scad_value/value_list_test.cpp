// Vectors that are made value by value, and numbers as text.
#include <gtest/gtest.h>

#include "front/scad/value/value.h"

namespace kerf::scad {
namespace {

TEST(ItemList, GivesItsValuesToTheVector) {
  Meter meter;
  ItemList list;
  for (int i = 0; i < 1000; ++i) list.push_back(i % 2 == 0 ? Value(i) : Value::string("s", &meter));
  EXPECT_EQ(list.size(), 1000u);
  {
    const Value v = list.finish(&meter);
    EXPECT_EQ(list.size(), 0u);
    ASSERT_EQ(v.items().size(), 1000u);
    EXPECT_EQ(v.items()[998].number(), 998.0);
    EXPECT_EQ(v.items()[999].text(), "s");
    EXPECT_EQ(v.nesting(), 1u);
    EXPECT_GE(meter.bytes, 1000 * sizeof(Value));
  }
  EXPECT_EQ(meter.bytes, 0u);
}

TEST(ItemList, CountsLevelsAndMayBeEmpty) {
  ItemList none;
  ItemList outer;
  outer.push_back(1.0);
  outer.push_back(none.finish(nullptr));
  const Value v = outer.finish(nullptr);
  EXPECT_EQ(v.nesting(), 2u);
  EXPECT_EQ(to_string(v), "[1, []]");
}

TEST(ItemList, DropsValuesThatBecomeNoVector) {
  Meter meter;
  {
    ItemList list;
    list.push_back(Value::string("abc", &meter));
    ItemList other = std::move(list);
    other.push_back(2.0);
    EXPECT_EQ(other.size(), 2u);
    EXPECT_GT(meter.bytes, 0u);
  }
  EXPECT_EQ(meter.bytes, 0u);
}

// As openscad 2021.01 prints them.
TEST(NumberText, HasSixDigits) {
  EXPECT_EQ(to_string(-0.0), "0");
  EXPECT_EQ(to_string(-999999.0), "-999999");
  EXPECT_EQ(to_string(1e6), "1e+6");
  EXPECT_EQ(to_string(0.5), "0.5");
  EXPECT_EQ(to_string(1.0 / 3.0), "0.333333");
  EXPECT_EQ(to_string(2.0 / 3.0), "0.666667");
  EXPECT_EQ(to_string(0.000001), "1e-6");
  EXPECT_EQ(to_string(123456.5), "123457");  // a tie is rounded away from zero
  EXPECT_EQ(to_string(123456.4999999), "123456");
  EXPECT_EQ(to_string(999999.5), "1e+6");
  EXPECT_EQ(to_string(-1.0e300), "-1e+300");
}

}  // namespace
}  // namespace kerf::scad

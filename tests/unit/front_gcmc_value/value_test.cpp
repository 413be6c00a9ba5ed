// Values: units, copy on write, and the memory that the meter counts.
#include "front/gcmc/value/value.h"

#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "front/gcmc/value/runtime.h"

namespace kerf::gcmc {
namespace {

std::string text(const Value& v) {
  std::string out;
  append_text(out, v, 2);
  return out;
}

TEST(GcmcValue, ConvertsUnits) {
  EXPECT_DOUBLE_EQ(convert(1.0, Unit::inch, Unit::mm), 25.4);
  EXPECT_DOUBLE_EQ(convert(180.0, Unit::deg, Unit::rad), 3.14159265358979323846);
  EXPECT_EQ(convert(Scalar::integer(3, Unit::mm), Unit::mm).kind(), Kind::integer);
  EXPECT_EQ(convert(Scalar::integer(254, Unit::mm), Unit::inch).kind(), Kind::real);
}

TEST(GcmcValue, TextHasUnits) {
  EXPECT_EQ(text(Value::real(2.5, Unit::inch)), "2.50in");
  EXPECT_EQ(text(Value::integer(-3)), "-3");
}

TEST(GcmcValue, CopiesAreSharedUntilOneIsWritten) {
  Meter meter;
  Value a = Value::list({Value::real(1.0)}, meter);
  Value b = a;
  const std::size_t one = meter.used;
  EXPECT_GT(one, 0u);
  b.own_vectors(meter).push_back(Value::real(2.0));
  b.settle();
  EXPECT_EQ(a.vectors().size(), 1u);
  EXPECT_EQ(b.vectors().size(), 2u);
  EXPECT_GT(meter.used, one);
  a.clear();
  b.clear();
  EXPECT_EQ(meter.used, 0u);
}

TEST(GcmcValue, TheMeterRefuses) {
  Meter meter;
  meter.limit = 100;
  EXPECT_THROW(Value::string(std::u32string(1000, U'x'), meter), OutOfMemory);
}

TEST(GcmcValue, LongVectorsGrow) {
  Meter meter;
  Value v = Value::empty_vector();
  v.set_coordinate(5, Scalar::real(1.0, Unit::mm), meter);
  const std::vector<Scalar> all = v.coordinates();
  ASSERT_EQ(all.size(), 6u);
  EXPECT_FALSE(all[4].defined());
  EXPECT_EQ(all[5].number(), 1.0);
}

}  // namespace
}  // namespace kerf::gcmc

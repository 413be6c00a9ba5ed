// The table of threads: its numbers against the rules of their standards, and the spellings of names.
#include "op/mill/thread_table.h"

#include <gtest/gtest.h>

#include "base/codes/op.h"

namespace kerf {
namespace {

using op_detail::thread_size;

struct Expected {
  const char* name;
  double major, pitch;
};

// Coarse pitches of ISO 261, and fine ones by their names.
TEST(ThreadTable, HasMetricThreads) {
  for (const Expected& e : {Expected{"M1.6", 1.6, 0.35},
                            {"M2", 2, 0.4},
                            {"M2.5", 2.5, 0.45},
                            {"M3", 3, 0.5},
                            {"M3.5", 3.5, 0.6},
                            {"M4", 4, 0.7},
                            {"M5", 5, 0.8},
                            {"M6", 6, 1},
                            {"M7", 7, 1},
                            {"M8", 8, 1.25},
                            {"M10", 10, 1.5},
                            {"M12", 12, 1.75},
                            {"M14", 14, 2},
                            {"M16", 16, 2},
                            {"M18", 18, 2.5},
                            {"M20", 20, 2.5},
                            {"M22", 22, 2.5},
                            {"M24", 24, 3},
                            {"M27", 27, 3},
                            {"M30", 30, 3.5},
                            {"M33", 33, 3.5},
                            {"M36", 36, 4},
                            {"M6x0.75", 6, 0.75},
                            {"M8x1", 8, 1},
                            {"M10x1", 10, 1},
                            {"M10x1.25", 10, 1.25},
                            {"M12x1.25", 12, 1.25},
                            {"M12x1.5", 12, 1.5},
                            {"M14x1.5", 14, 1.5},
                            {"M16x1.5", 16, 1.5},
                            {"M18x1.5", 18, 1.5},
                            {"M20x1.5", 20, 1.5},
                            {"M22x1.5", 22, 1.5},
                            {"M24x2", 24, 2}}) {
    const auto size = thread_size(e.name);
    ASSERT_TRUE(size) << e.name;
    EXPECT_DOUBLE_EQ(size->major.mm(), e.major) << e.name;
    EXPECT_DOUBLE_EQ(size->pitch.mm(), e.pitch) << e.name;
    // The hole is within the limits of the minor diameter, tolerance 6H (ISO 965-1).
    const double p = e.pitch, low = e.major - 1.0825 * p;
    const double tolerance = p < 1 ? 433 * p - 190 * std::pow(p, 1.22) : 230 * std::pow(p, 0.7);
    EXPECT_GE(size->tap_drill.mm(), low) << e.name;
    EXPECT_LE(size->tap_drill.mm(), low + 0.001 * tolerance + 0.002) << e.name;
  }
}

// Major diameters in inches, of numbers 0.060 + 0.013 n (ASME B1.1).
TEST(ThreadTable, HasUnifiedThreads) {
  for (const Expected& e : {Expected{"2-56", 0.086, 56}, {"4-40", 0.112, 40},     {"6-32", 0.138, 32},
                            {"8-32", 0.164, 32},         {"10-24", 0.190, 24},    {"1/4-20", 0.25, 20},
                            {"5/16-18", 0.3125, 18},     {"3/8-16", 0.375, 16},   {"7/16-14", 0.4375, 14},
                            {"1/2-13", 0.5, 13},         {"9/16-12", 0.5625, 12}, {"5/8-11", 0.625, 11},
                            {"3/4-10", 0.75, 10},        {"7/8-9", 0.875, 9},     {"1-8", 1, 8},
                            {"4-48", 0.112, 48},         {"6-40", 0.138, 40},     {"8-36", 0.164, 36},
                            {"10-32", 0.190, 32},        {"1/4-28", 0.25, 28},    {"5/16-24", 0.3125, 24},
                            {"3/8-24", 0.375, 24},       {"7/16-20", 0.4375, 20}, {"1/2-20", 0.5, 20},
                            {"5/8-18", 0.625, 18},       {"3/4-16", 0.75, 16},    {"9/16-18", 0.5625, 18},
                            {"7/8-14", 0.875, 14},       {"1-12", 1, 12}}) {
    const auto size = thread_size(e.name);
    ASSERT_TRUE(size) << e.name;
    EXPECT_NEAR(size->major.mm(), 25.4 * e.major, 1e-9) << e.name;
    EXPECT_NEAR(size->pitch.mm(), 25.4 / e.pitch, 1e-9) << e.name;
    // 100% of the depth is 1.299 pitches in diameter.
    const double depth = (size->major - size->tap_drill).mm() / (1.299 * size->pitch.mm());
    EXPECT_GT(depth, 0.64) << e.name;
    EXPECT_LT(depth, 0.85) << e.name;
  }
}

TEST(ThreadTable, NamesHaveSeveralSpellings) {
  for (const char* name : {"M6", "m6", " M6 ", "M6x1", "M6 x 1", "M6X1"})
    EXPECT_TRUE(thread_size(name) && thread_size(name)->pitch == mm(1)) << name;
  for (const char* name : {"1/4-20", "1/4\"-20", "1/4-20 UNC", "UNC 1/4-20", "1/4 - 20"})
    EXPECT_TRUE(thread_size(name) && thread_size(name)->pitch == mm(1.27)) << name;
  EXPECT_TRUE(thread_size("#10-32 UNF"));
  for (const char* name : {"", "M", "M6x0.8", "6", "1/4", "M9", "x1"})
    EXPECT_FALSE(thread_size(name)) << name;
  Diagnostics diagnostics;
  EXPECT_FALSE(thread_size("M9", {}, diagnostics));
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::op_option);
}

}  // namespace
}  // namespace kerf

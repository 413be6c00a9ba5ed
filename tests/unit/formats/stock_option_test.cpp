// The option --stock: every form of the manual, and invalid texts.
#include <gtest/gtest.h>

#include "base/codes/stock.h"

#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

Box3 block(std::string_view text) {
  Diagnostics diagnostics;
  const auto stock = read_stock_option(text, {}, diagnostics);
  EXPECT_TRUE(stock) << text;
  EXPECT_FALSE(diagnostics.has_errors());
  return stock ? stock->block : Box3{};
}
Box3 box(Point3 low, Point3 high) {
  Box3 b;
  b.low = low;
  b.high = high;
  return b;
}

TEST(StockOption, ZeroIsLowerLeftOnTopByDefault) {
  const Box3 want = box({0, 0, -12}, {100, 60, 0});
  for (const char* text :
       {"100x60x12", "100 60 12", "100 x 60 x 12", "100,60,12", "100mm x60mmX12mm", "block 100 60 12",
        "100x60x12 at lower-left top", "BLOCK 100 60 12 zero Lower-Left Top", "100x60x12 top"})
    EXPECT_EQ(block(text), want) << text;
}

TEST(StockOption, ZeroElsewhere) {
  EXPECT_EQ(block("100x60x12 at lower-left bottom"), box({0, 0, 0}, {100, 60, 12}));
  EXPECT_EQ(block("100x60x12 centre"), box({-50, -30, -12}, {50, 30, 0}));
  EXPECT_EQ(block("100x60x12 at center bottom"), box({-50, -30, 0}, {50, 30, 12}));
  EXPECT_EQ(block("100x60x12 at centre left top"), box({0, -30, -12}, {100, 30, 0}));
  EXPECT_EQ(block("100x60x12 top-right"), box({-100, -60, -12}, {0, 0, 0}));
}

TEST(StockOption, InchesAreConverted) {
  EXPECT_EQ(block("4inx2inx0.5in"), box({0, 0, -12.7}, {101.6, 50.8, 0}));
  EXPECT_EQ(block("4\" 2\" 0.5\""), box({0, 0, -12.7}, {101.6, 50.8, 0}));
}

TEST(StockOption, AUnitAfterTheLastLengthAppliesToAll) {
  for (const char* text : {"4x2x0.5in", "4 x 2 x 0.5 in", "4x2x0.5\"", "4 2 0.5 inches",
                           "4in x 50.8mm x 0.5 inch", "4 in x 2 in x 0.5 in at lower-left top"})
    EXPECT_EQ(block(text), box({0, 0, -12.7}, {101.6, 50.8, 0})) << text;
  EXPECT_EQ(block("100 x 60 x 12 mm"), box({0, 0, -12}, {100, 60, 0}));
  for (const char* text : {"0,0,-0.5 to 4,2,0in", "0,0,-0.5in to 4,2,0in", "min 0 0 -0.5 in max 4in 2in 0",
                           "0,0,-12.7mm to 4in,2in,0"})
    EXPECT_EQ(block(text), box({0, 0, -12.7}, {101.6, 50.8, 0})) << text;
}

TEST(StockOption, UnitsOfSomeLengthsOnlyAreRefused) {
  for (const char* text :
       {"4inx2x0.5", "4inx2x0.5in", "4x2inx0.5", "0,0,-0.5in to 4,2,0", "0,0,-0.5 to 4in,2,0",
        "0,0,-0.5 to 4in,2in,0in", "4x2x0.5ft", "4x2x0.5inin", "4x2x0.5 in mm"}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(read_stock_option(text, {}, diagnostics)) << text;
    EXPECT_EQ(diagnostics.errors(), 1u) << text;
  }
}

TEST(StockOption, Corners) {
  const Box3 want = box({-5, -6, -12.5}, {100, 60, 1});
  for (const char* text :
       {"-5,-6,-12.5 to 100,60,1", "min -5,-6,-12.5 max 100,60,1", "min -5 -6 -12.5 max 100 60 1"})
    EXPECT_EQ(block(text), want) << text;
}

TEST(StockOption, AnythingElseIsAnErrorWithAHint) {
  for (const char* text : {"",
                           "100",
                           "100x60",
                           "100x60x12x5",
                           "axbxc",
                           "100x60x-12",
                           "100x60x0",
                           "nanx1x1",
                           "1e308x1x1",
                           "100x60x12 at",
                           "100x60x12 at edge",
                           "100x60x12 top bottom",
                           "0,0,0 to 1,1",
                           "0,0,0 to 1,1,0",
                           "min 0,0,0",
                           "100x60x12 min",
                           "min 0,0,0 max 1,1,1 max 2,2,2",
                           "xxx",
                           "-",
                           "1..2x3x4"}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(read_stock_option(text, {}, diagnostics)) << text;
    ASSERT_EQ(diagnostics.errors(), 1u) << text;
    EXPECT_EQ(diagnostics.list()[0].code, codes::stock_option);
    EXPECT_FALSE(diagnostics.list()[0].hint.empty());
  }
}

TEST(StockOption, AHugeTextIsRefusedWithAShortMessage) {
  Diagnostics diagnostics;
  EXPECT_FALSE(read_stock_option(std::string(1'000'000, '1'), {}, diagnostics));
  EXPECT_LT(diagnostics.list()[0].message.size(), 400u);
}

}  // namespace
}  // namespace kerf

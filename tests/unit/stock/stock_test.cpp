// Stock from names, cuts and comments.
#include "base/codes/stock.h"

#include <gtest/gtest.h>

#include "kerf/stock/stock.h"

namespace kerf {
namespace {

void expect_box(const std::optional<Stock>& stock, Point3 low, Point3 high) {
  ASSERT_TRUE(stock);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(stock->block.low[axis], low[axis], 1e-9) << axis;
    EXPECT_NEAR(stock->block.high[axis], high[axis], 1e-9) << axis;
  }
}

TEST(MakeBlock, ZeroAtEveryNamedPosition) {
  const Point3 size{100, 60, 12.7};
  expect_box(make_block(size, ZeroCorner::lower_left, ZeroHeight::top), {0, 0, -12.7}, {100, 60, 0});
  expect_box(make_block(size, ZeroCorner::centre_left, ZeroHeight::top), {0, -30, -12.7}, {100, 30, 0});
  expect_box(make_block(size, ZeroCorner::top_left, ZeroHeight::top), {0, -60, -12.7}, {100, 0, 0});
  expect_box(make_block(size, ZeroCorner::centre, ZeroHeight::bottom), {-50, -30, 0}, {50, 30, 12.7});
  expect_box(make_block(size, ZeroCorner::lower_right, ZeroHeight::bottom), {-100, 0, 0}, {0, 60, 12.7});
  expect_box(make_block(size, ZeroCorner::top_centre, ZeroHeight::bottom), {-50, -60, 0}, {50, 0, 12.7});
}

TEST(ParseZero, CaseSpacesAndHyphensDoNotCount) {
  EXPECT_EQ(parse_zero_corner("Lower-Left"), ZeroCorner::lower_left);
  EXPECT_EQ(parse_zero_corner("center left"), ZeroCorner::centre_left);
  EXPECT_EQ(parse_zero_corner("TOPLEFT"), ZeroCorner::top_left);
  EXPECT_EQ(parse_zero_corner("Center"), ZeroCorner::centre);
  EXPECT_FALSE(parse_zero_corner("nowhere"));
  EXPECT_EQ(parse_zero_height(" Top"), ZeroHeight::top);
  EXPECT_EQ(parse_zero_height("BOTTOM"), ZeroHeight::bottom);
  EXPECT_FALSE(parse_zero_height(""));
  EXPECT_EQ(zero_corner_names().size(), 9u);
  for (const std::string& name : zero_corner_names()) EXPECT_TRUE(parse_zero_corner(name)) << name;
  for (const std::string& name : zero_height_names()) EXPECT_TRUE(parse_zero_height(name)) << name;
}

TEST(Stock, NoVolumeIsNotSolid) { EXPECT_FALSE(is_solid(Stock{})); }

struct Comments {
  std::optional<Stock> stock;
  Diagnostics diagnostics;
};
Comments read(std::initializer_list<std::string_view> comments, double scale = 1.0) {
  StockComments reader;
  Comments result;
  for (const std::string_view comment : comments) {
    EXPECT_TRUE(reader.read(comment, scale, {}, result.diagnostics)) << comment;
  }
  result.stock = reader.stock();
  return result;
}

TEST(StockComments, AllSpacings) {
  const Point3 low{-109.5, -75, -8.35}, high{109.5, 75, 0};
  for (const auto& comments : {std::initializer_list<std::string_view>{"stockMin: -109.5, -75mm, -8.35mm",
                                                                       "stockMax:109.5mm, 75mm, 0.00mm"},
                               {"(stockMin:-109.5mm,-75mm,-8.35mm)", "(stockMax:  109.5 mm , 75 mm , 0 mm )"},
                               {"STOCK/BLOCK, 219, 150, 8.35, 109.5, 75, 8.35"},
                               {"(STOCK/BLOCK,219.00, 150.00, 8.35,109.50, 75.00, 8.35)"},
                               {" stock/block,219,150,8.35,109.5mm,75,8.35"}}) {
    const Comments found = read(comments);
    EXPECT_TRUE(found.diagnostics.list().empty());
    expect_box(found.stock, low, high);
  }
}

TEST(StockComments, InchesAndUnits) {
  expect_box(read({"STOCK/BLOCK, 4, 2, 1, 0, 0, 1"}, 25.4).stock, {0, 0, -25.4}, {101.6, 50.8, 0});
  expect_box(read({"stockMin:0mm, 0mm, -10mm", "stockMax:1in, 50mm, 0mm"}, 25.4).stock, {0, 0, -10},
             {25.4, 50, 0});
}

TEST(StockComments, OtherCommentsAreIgnored) {
  StockComments reader;
  Diagnostics diagnostics;
  for (const char* comment :
       {"", "stock is oak", "TOOL/MILL, 1, 2, 3, 4", "Stock: 3", "STOCK/CYLINDER, 1, 2, 3, 4, 5, 6"}) {
    EXPECT_FALSE(reader.read(comment, 1.0, {}, diagnostics)) << comment;
  }
  EXPECT_TRUE(diagnostics.list().empty());
  EXPECT_FALSE(reader.stock());
}

TEST(StockComments, MalformedCommentsAreErrors) {
  for (const char* comment :
       {"stockMin:", "stockMin:1,2", "stockMin:1,2,3,4", "stockMax: a, b, c", "STOCK/BLOCK, 1, 2, 3",
        "STOCK/BLOCK, 1, 2, 3, 4, 5, 6, 7", "stockMin: nan, 0, 0", "stockMin: 1e300, 0, 0"}) {
    const Comments found = read({comment});
    ASSERT_EQ(found.diagnostics.errors(), 1u) << comment;
    EXPECT_EQ(found.diagnostics.list()[0].code, codes::stock_comment_malformed) << comment;
    EXPECT_FALSE(found.stock);
  }
  const Comments flat = read({"STOCK/BLOCK, 10, 10, 0, 0, 0, 0"});
  EXPECT_EQ(flat.diagnostics.list().at(0).code, codes::stock_impossible);
}

TEST(StockComments, AStockMaxBelowStockMinIsIgnored) {
  const Comments found = read({"stockMin:0.00mm, -30.0mm, 0.00mm", "stockMax:100mm, 30.0mm, -12.7mm",
                               "STOCK/BLOCK, 100, 60, 12.7, 0.00, 30.0, 0.00mm"});
  EXPECT_EQ(found.diagnostics.errors(), 0u);
  EXPECT_EQ(found.diagnostics.list().at(0).code, codes::stock_impossible);
  expect_box(found.stock, {0, -30, 0}, {100, 30, 12.7});
}

TEST(StockComments, ContradictionsAreReported) {
  const Comments found =
      read({"stockMin:0, 0, -10", "stockMax:100, 60, 0", "STOCK/BLOCK, 100, 60, 12, 0, 0, 12"});
  EXPECT_EQ(found.diagnostics.list().at(0).code, codes::stock_comments_differ);
  expect_box(found.stock, {0, 0, -10}, {100, 60, 0});
}

TEST(WriteStockComments, ReadBack) {
  const Stock stock = make_block({100, 60.125, 12.7}, ZeroCorner::centre, ZeroHeight::top);
  const std::vector<std::string> lines = write_stock_comments(stock);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "stockMin:-50.00mm, -30.0625mm, -12.70mm");
  EXPECT_EQ(lines[1], "stockMax:50.00mm, 30.0625mm, 0.00mm");
  EXPECT_EQ(lines[2], "STOCK/BLOCK, 100.00, 60.125, 12.70, 50.00, 30.0625, 12.70");
  const Comments again = read({lines[0], lines[1], lines[2]});
  EXPECT_TRUE(again.diagnostics.list().empty());
  expect_box(again.stock, stock.block.low, stock.block.high);
}

}  // namespace
}  // namespace kerf

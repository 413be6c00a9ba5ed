// Stock from files, left-over stock written and read, options for flips, bars and shifts.
#include <gtest/gtest.h>

#include "base/codes/stock.h"

#include "kerf/formats/mesh_files.h"
#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

LeftColumns three_columns() {
  LeftColumns left;
  left.bounds = {{1, 2, -5}, {4, 3, 0}};
  left.positions = {1.5, 2.5, -5, 1, 3, 1};
  left.columns = {3, 1, {0, 1, 2, 4}, {{0, 5}, {0, 5}, {0, 1.5f}, {2.25f, 4}}};
  return left;
}

TEST(StockFile, LeftOverStockReadsBack) {
  Diagnostics diagnostics;
  const std::string bytes = write_left_file(three_columns());
  const auto stock = read_stock_file(bytes, "part.KSTOCK", diagnostics);
  ASSERT_TRUE(stock && diagnostics.list().empty());
  EXPECT_EQ(stock->block, three_columns().bounds);
  EXPECT_DOUBLE_EQ(stock->body->volume().mm3(), 5 + 5 + 1.5 + 1.75);
  EXPECT_EQ(stock->body->pitch()->mm(), 1.0);
  const auto columns = stock->body->columns(three_columns().positions, diagnostics);
  EXPECT_EQ(columns->runs, three_columns().columns.runs);
}

/// The file of these columns, byte by byte as the format has it: "KERFSTK1"; both corners of the block, the
/// position of the first column and the pitch as doubles; two counts; for each group of equal columns their
/// number, the number of runs, and each run as two floats. Written with Python's struct.
constexpr std::string_view kThreeColumns =
    "4b45524653544b31000000000000f03f000000000000004000000000000014c000000000000010400000000000000840"
    "0000000000000000000000000000f83f0000000000000440000000000000f03f03000000010000000201000000000000"
    "a0400102000000000000c03f0000104000008040";

std::string from_hex(std::string_view digits) {
  std::string bytes;
  for (std::size_t k = 0; k + 1 < digits.size(); k += 2)
    bytes += static_cast<char>(std::stoi(std::string(digits.substr(k, 2)), nullptr, 16));
  return bytes;
}

TEST(StockFile, LeftOverStockIsOfItsFormat) {
  EXPECT_EQ(write_left_file(three_columns()), from_hex(kThreeColumns));
  Diagnostics diagnostics;
  const auto stock = read_stock_file(from_hex(kThreeColumns), "part.kstock", diagnostics);
  ASSERT_TRUE(stock && diagnostics.list().empty());
  EXPECT_EQ(stock->block, (Box3{{1, 2, -5}, {4, 3, 0}}));
  EXPECT_DOUBLE_EQ(stock->body->volume().mm3(), 5 + 5 + 1.5 + 1.75);
}

TEST(StockFile, DamagedLeftOverStock) {
  const std::string good = write_left_file(three_columns());
  for (std::size_t size = 0; size < good.size(); ++size) {
    Diagnostics diagnostics;
    EXPECT_FALSE(read_stock_file(good.substr(0, size), "a.kstock", diagnostics)) << size;
    ASSERT_EQ(diagnostics.list().size(), 1u);
    EXPECT_EQ(diagnostics.list()[0].code, codes::stock_left_file);
  }
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::string bytes = good;
    bytes[at] = static_cast<char>(bytes[at] ^ 0xff);
    Diagnostics diagnostics;
    const auto stock = read_stock_file(bytes, "a.kstock", diagnostics);
    EXPECT_EQ(stock.has_value(), !diagnostics.has_errors());
    // The magic word, both counts of columns, and those of the groups.
    const bool must_fail = at < 8 || (at >= 80 && at < 90);
    EXPECT_FALSE(must_fail && stock.has_value()) << at;
  }
  Diagnostics diagnostics;
  EXPECT_FALSE(read_stock_file(good + "x", "a.kstock", diagnostics));
}

TEST(StockFile, AMeshByItsEnding) {
  const std::vector<float> positions{0, 0, 0, 8, 0, 0, 0, 4, 0, 0, 0, -2};
  const std::vector<std::uint32_t> triangles{0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0};
  const std::string bytes = write_mesh({positions, triangles, {}, {}, {}, "t"}, MeshFormat::stl);
  Diagnostics diagnostics;
  const auto stock = read_stock_file(bytes, "t.stl", diagnostics);
  ASSERT_TRUE(stock);
  EXPECT_EQ(stock->block, (Box3{{0, 0, -2}, {8, 4, 0}}));
  EXPECT_FALSE(read_stock_file(bytes, "t.step", diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::mesh_file);
  EXPECT_TRUE(is_stock_file("a/b.STL") && is_stock_file("x.kstock") && !is_stock_file("x.nc"));
}

TEST(StockFile, Flips) {
  Diagnostics diagnostics;
  auto move = read_flip_option("X", {}, diagnostics);
  ASSERT_TRUE(move);
  EXPECT_EQ(move->flip, StockMove::Flip::about_x);
  EXPECT_FALSE(move->across || move->z);
  move = read_flip_option("about y x=50 z=-6mm", {}, diagnostics);
  ASSERT_TRUE(move);
  EXPECT_EQ(move->flip, StockMove::Flip::about_y);
  EXPECT_EQ(move->across, 50.0);
  EXPECT_EQ(move->z, -6.0);
  EXPECT_TRUE(diagnostics.list().empty());
  for (const char* bad : {"", "z", "x x=3", "y y=3", "x y=", "x y=nan", "x 5", "x y=1e9"}) {
    EXPECT_FALSE(read_flip_option(bad, {}, diagnostics)) << bad;
    EXPECT_EQ(diagnostics.list().back().code, codes::stock_flip);
  }
}

TEST(StockFile, Bars) {
  Diagnostics diagnostics;
  const auto bar = read_rotary_option("D=40 length=100mm x=-5 z=1.5", {}, diagnostics);
  ASSERT_TRUE(bar);
  EXPECT_EQ(bar->diameter, 40.0);
  EXPECT_EQ(bar->x_low, -5.0);
  EXPECT_EQ(bar->x_high, 95.0);
  EXPECT_EQ(bar->axis_y, 0.0);
  EXPECT_EQ(bar->axis_z, 1.5);
  for (const char* bad :
       {"", "d=40", "length=3", "d=-1 length=3", "d=40 length=100 q=1", "d=4 length=x", "40 100"}) {
    EXPECT_FALSE(read_rotary_option(bad, {}, diagnostics)) << bad;
    EXPECT_EQ(diagnostics.list().back().code, codes::rotary_option);
  }
}

TEST(StockFile, Shifts) {
  Diagnostics diagnostics;
  EXPECT_EQ(read_shift_option("10, 0,-3.5mm", {}, diagnostics), (Point3{10, 0, -3.5}));
  for (const char* bad : {"", "1,2", "1,2,3,4", "1,2,x"})
    EXPECT_FALSE(read_shift_option(bad, {}, diagnostics)) << bad;
  EXPECT_EQ(diagnostics.errors(), 4u);
}

TEST(StockFile, AGroupEndsWithTheLastColumn) {
  std::string bytes = from_hex(kThreeColumns);
  const std::size_t second = bytes.size() - 4 * 4 - 2;  // the group of the last column
  ASSERT_EQ(bytes[second], 1);
  Diagnostics diagnostics;
  for (const char columns : {'\0', '\2', '\3'}) {
    bytes[second] = columns;
    EXPECT_FALSE(read_stock_file(bytes, "a.kstock", diagnostics)) << static_cast<int>(columns);
  }
  bytes[second] = char{1};
  EXPECT_TRUE(read_stock_file(bytes, "a.kstock", diagnostics));
}

}  // namespace
}  // namespace kerf

// The stock in the comments of CAM programs.
#include "front/gcode/comments/cam_stock_comments.h"

#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace kerf::gcode {
namespace {

std::optional<Box3> block_of(const std::vector<std::string>& comments, double scale = 1.0) {
  CamStockComments stock;
  for (const std::string& comment : comments) stock.read(comment, scale);
  const auto found = stock.stock();
  return found ? std::optional(found->block) : std::nullopt;
}

TEST(CamStockComments, OfEachProgramAreUnderstood) {
  const auto coppercam = block_of({" Workpiece dimensions: 114.627 x 29.5 x 1.6 mm "}, 25.4);
  ASSERT_TRUE(coppercam);
  EXPECT_EQ(coppercam->low, (Point3{0, 0, -1.6}));
  EXPECT_EQ(coppercam->high, (Point3{114.627, 29.5, 0}));
  const auto corners = block_of({"X MIN:-150.000  Y MIN:-115.000  Z MIN:-20.000",
                                 "X MAX: 150.000  Y MAX: 115.000  Z MAX: 0.000", "THICKNESS:20.000"});
  ASSERT_TRUE(corners);
  EXPECT_EQ(corners->low, (Point3{-150, -115, -20}));
  EXPECT_EQ(corners->high, (Point3{150, 115, 0}));
  const auto sketchucam = block_of({"Material Thickness: 3/4\"", "Material length: 7\" X width: 5\""});
  ASSERT_TRUE(sketchucam);
  EXPECT_LT(length(sketchucam->size() - Point3{177.8, 127.0, 19.05}), 1e-9);
  const auto pycam =
      block_of({"maxz = 0.0", "maxx = 90", "maxy = 60", "minx = -10", "miny = -5", "minz = -3"});
  ASSERT_TRUE(pycam);
  EXPECT_EQ(pycam->low, (Point3{-10, -5, -3}));
}

TEST(CamStockComments, InASentence) {
  const auto stock = block_of({"Stock is 3\"x3\"x1\""});
  ASSERT_TRUE(stock);
  EXPECT_LT(length(stock->size() - Point3{76.2, 76.2, 25.4}), 1e-9);
}

TEST(CamStockComments, ABlockWithoutVolumeOrWithoutACornerIsNone) {
  EXPECT_FALSE(block_of({"maxz = 0.0", "maxx = 90", "maxy = 60", "minx = -10", "miny = -5", "minz = 0"}));
  EXPECT_FALSE(block_of({"X MIN:-150 Y MIN:-115 Z MIN:-20"}));
  EXPECT_FALSE(block_of({"Workpiece dimensions: 114 mm", "Material Thickness: 3/4\"", "X MAX"}));
}

}  // namespace
}  // namespace kerf::gcode

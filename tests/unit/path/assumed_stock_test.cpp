// The assumed stock: its top for programs with Z0 on the top, on the bed, and between.
#include "path/assumed_stock.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

/// A program of rapids and feed motions to points.
class Program {
 public:
  Program& rapid(double x, double y, double z) {
    path_.add(step::Rapid{{x, y, z}}, OriginId::none);
    return *this;
  }
  Program& feed(double x, double y, double z) {
    path_.add(step::Cut{{x, y, z}, mm_per_min(300)}, OriginId::none);
    return *this;
  }
  /// A slot along X from a plunge that starts at `start`, lifted to `lift` by a feed motion.
  Program& slot(double start, double z, double lift) {
    return rapid(0, 0, start).feed(0, 0, z).feed(50, 0, z).feed(50, 0, lift);
  }
  AssumedStock assumed() const {
    const auto stock = assume_stock(path_, mm(5), mm(1));
    EXPECT_TRUE(stock);
    return stock.value_or(AssumedStock{});
  }
  double top() const { return assumed().stock.block.high.z; }
  double bottom() const { return assumed().stock.block.low.z; }

 private:
  Toolpath path_;
};

TEST(AssumedStock, ZeroIsTheTopOfWhatIsCutBelowIt) {
  const AssumedStock assumed = Program().slot(5, -2, 5).slot(5, -4, 5).assumed();
  EXPECT_EQ(assumed.top, AssumedTop::zero);
  EXPECT_EQ(assumed.stock.block.low, (Point3{-5, -5, -5}));
  EXPECT_EQ(assumed.stock.block.high, (Point3{55, 5, 0}));
}

TEST(AssumedStock, FeedsThatLiftOrTravelAboveDoNotRaiseTheTop) {
  Program program;
  program.slot(5, -2, 15).feed(-200, 0, 15).feed(-200, 0, 5).rapid(0, 0, 5).slot(5, -3, 15);
  EXPECT_EQ(program.top(), 0.0);
  EXPECT_EQ(program.assumed().stock.block.low.x, -5.0) << "travel above the stock does not enlarge it";
}

TEST(AssumedStock, RampsThatStartAboveZeroDoNotRaiseTheTop) {
  Program program;
  program.rapid(0, 0, 2);
  for (int i = 0; i < 10; ++i) program.feed(i % 2 == 0 ? 50 : 0, 0, 2 - 0.3 * (i + 1));
  program.feed(0, 0, -1).feed(50, 0, -1).rapid(50, 0, 5);
  EXPECT_EQ(program.top(), 0.0);
}

TEST(AssumedStock, APassThatLevelsTheStockDoesNotRaiseTheTop) {
  Program program;
  program.rapid(0, 0, 5).feed(0, 0, 0.2).feed(50, 0, 0.2);
  for (int i = 1; i <= 5; ++i) program.slot(5, -i, 5);
  EXPECT_EQ(program.top(), 0.0);
}

TEST(AssumedStock, WithZeroOnTheBedTheTopIsAPassAboveTheHighest) {
  const Program program = Program().slot(15, 9, 15).slot(15, 6, 15).slot(15, 3, 15).slot(15, 0, 15);
  EXPECT_EQ(program.assumed().top, AssumedTop::passes);
  EXPECT_DOUBLE_EQ(program.top(), 12.0);
  EXPECT_EQ(program.bottom(), 0.0);
}

TEST(AssumedStock, CutsIntoTheBedGoThroughTheStock) {
  const Program program = Program().slot(15, 9, 15).slot(15, 4, 15).slot(15, -0.2, 15);
  EXPECT_DOUBLE_EQ(program.top(), 14.0);
  EXPECT_DOUBLE_EQ(program.bottom(), -0.2);
}

TEST(AssumedStock, OnePassAboveTheBedStartsAtItsPlunge) {
  const Program program = Program().slot(6, 2, 15);
  EXPECT_EQ(program.assumed().top, AssumedTop::plunge);
  EXPECT_EQ(program.top(), 6.0);
  EXPECT_EQ(program.bottom(), 0.0);
}

TEST(AssumedStock, ReliefOnTheBedReachesItsHighestCut) {
  Program program;
  program.rapid(0, 0, 20).feed(0, 0, 1);
  for (int i = 0; i < 20; ++i) program.feed(5 * i, 0, 1 + (i * 7 % 5));
  EXPECT_EQ(program.top(), 5.0);
}

TEST(AssumedStock, HolesDownToTheBed) {
  Program program;
  for (int i = 0; i < 3; ++i)
    program.rapid(10 * i, 0, 20)
        .rapid(10 * i, 0, 12)
        .feed(10 * i, 0, 8)
        .rapid(10 * i, 0, 9)
        .feed(10 * i, 0, 0);
  EXPECT_EQ(program.top(), 12.0);
  EXPECT_EQ(program.bottom(), 0.0);
}

TEST(AssumedStock, HolesBelowZero) {
  const Program program = Program().rapid(0, 0, 2).feed(0, 0, -8).rapid(0, 0, 2);
  EXPECT_EQ(program.top(), 0.0);
  EXPECT_EQ(program.bottom(), -9.0);
}

TEST(AssumedStock, AProgramThatStartsWithoutAHeight) {
  Program program;
  program.feed(0, 0, -1).feed(20, 0, -1);
  EXPECT_EQ(program.top(), 0.0);
  EXPECT_EQ(program.bottom(), -2.0);
}

TEST(AssumedStock, FeedsAtOneHeightOnly) {
  EXPECT_EQ(Program().rapid(0, 0, 5).feed(20, 0, 5).top(), 5.0);
  EXPECT_EQ(Program().rapid(0, 0, 0).feed(20, 0, 0).top(), 0.0);
}

TEST(AssumedStock, WithoutACutThereIsNone) {
  Toolpath path;
  EXPECT_FALSE(assume_stock(path, mm(5), mm(1)));
  path.add(step::Rapid{{1, 2, 3}}, OriginId::none);
  EXPECT_FALSE(assume_stock(path, mm(5), mm(1)));
}

TEST(AssumedStock, RampsUpwardsCut) {
  const AssumedStock assumed =
      Program().rapid(0, 0, 5).feed(0, 0, -6).feed(60, 30, -1).rapid(60, 30, 5).assumed();
  EXPECT_EQ(assumed.stock.block.low, (Point3{-5, -5, -7}));
  EXPECT_EQ(assumed.stock.block.high, (Point3{65, 35, 0}));
}

TEST(AssumedStock, ARampOutOfTheMaterialCutsUpToTheTop) {
  Program program;
  program.rapid(0, 0, 5).feed(0, 0, -6);
  for (int i = 0; i < 20; ++i) program.feed(i % 2 == 0 ? 20 : 0, 0, -6);
  program.feed(0, 60, 6);  // half of it is below Z0
  EXPECT_EQ(program.top(), 0.0);
  EXPECT_NEAR(program.assumed().stock.block.high.y, 30 + 5, 1e-2);
}

}  // namespace
}  // namespace kerf

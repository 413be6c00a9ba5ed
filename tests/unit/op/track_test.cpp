// Tracks: positions along lines and arcs, and pieces of them.
#include "op/base/track.h"

#include <gtest/gtest.h>
#include <numbers>

#include "swept.h"

#include "kerf/op/operation.h"

namespace kerf {
namespace {

using namespace test;
using op_detail::Track;

TEST(Track, ACircleIsWalkedAroundMoreThanOnce) {
  const Track track(as_outline({{5, 5}, mm(2)}), 1e-6);
  const double round = 4 * std::numbers::pi;
  EXPECT_TRUE(track.closed());
  EXPECT_NEAR(track.length(), round, 1e-9);
  EXPECT_NEAR(track.nearest({5, 9}), round / 4, 1e-9);
  EXPECT_NEAR(track.direction(round / 4).x, -1, 1e-9);
  double sum = 0.0;
  Point2 last = track.at(1.0);
  for (const LineArc& piece : track.pieces(1.0, 1.0 + 2.5 * round)) {
    EXPECT_NEAR(distance(piece.from, last), 0, 1e-9);
    EXPECT_EQ(piece.turn, 1.0);
    sum += op_detail::length_of(piece);
    last = piece.to;
  }
  EXPECT_NEAR(sum, 2.5 * round, 1e-9);
  EXPECT_NEAR(distance(last, track.at(1.0 + round / 2)), 0, 1e-9);
}

TEST(Track, BackwardsIsTheSameWayReversed) {
  const Track track(
      Outline{{0, 0},
              {{{10, 0}, {}}, {{20, 10}, Point2{20 - 10 * (1 - std::sqrt(0.5)), 10 * (1 - std::sqrt(0.5))}}}},
      1e-6);
  const auto pieces = track.pieces(track.length(), 5.0);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0].from, (Point2{20, 10}));
  EXPECT_EQ(pieces[0].turn, -1.0);
  EXPECT_NEAR(distance(pieces[1].to, {5, 0}), 0, 1e-9);
}

TEST(Operation, AppendedPiecesRiseWhereThePathEnds) {
  Toolpath piece;
  piece.set_unknown_axes(piece.add(step::Rapid{{0, 0, 5}}, OriginId::none), 3);
  piece.add(step::Rapid{{10, 10, 5}}, OriginId::none);
  Toolpath path;
  append(path, piece);
  EXPECT_EQ(path[0].unknown_axes(), 3u);
  path.add(step::Rapid{{3, 4, 2}}, OriginId::none);
  append(path, piece);
  ASSERT_EQ(path.size(), 5u);
  EXPECT_EQ(path[3].unknown_axes(), 0u);
  EXPECT_EQ(path[3].to(), (Point3{3, 4, 5}));
}

TEST(Operation, TheCuttingRadiusIsThatOfTheDepth) {
  Diagnostics diagnostics;
  const auto vee = make_tool(1, shape::Vee{mm(12), mm(6), degrees(90), {}, {}}, {}, {}, diagnostics);
  ASSERT_TRUE(vee);
  EXPECT_NEAR(cutting_radius(*vee, mm(2)).mm(), 2, 1e-9);
  const auto ball = make_tool(1, shape::Ball{mm(6), mm(20)}, {}, {}, diagnostics);
  EXPECT_NEAR(cutting_radius(*ball, mm(1)).mm(), std::sqrt(9.0 - 4.0), 1e-9);
  EXPECT_NEAR(cutting_radius(*ball, mm(5)).mm(), 3, 1e-9);
}

}  // namespace
}  // namespace kerf

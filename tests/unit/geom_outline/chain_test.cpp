// Chaining: order, directions, gaps, junctions, repeated pieces, open ends.
#include <chrono>
#include <gtest/gtest.h>

#include "kerf/geom/outline.h"

namespace kerf {
namespace {

Outline line(Point2 from, Point2 to) { return {from, {{to, {}}}}; }
Outline arc(Point2 from, Point2 via, Point2 to) { return {from, {{to, via}}}; }

TEST(Chain, PiecesInAnyOrderAndDirectionBecomeOneOutline) {
  const Chained made = chain({line({10, 0}, {0, 0}), line({0, 5}, {10, 5}),
                              arc({10, 5}, {12.5, 2.5}, {10, 0}), line({0, 0}, {0, 5})},
                             {});
  ASSERT_EQ(made.outlines.size(), 1u);
  const Outline& outline = made.outlines[0].outline;
  EXPECT_TRUE(outline.closed());
  EXPECT_EQ(outline.start, (Point2{10, 0}));  // in the direction of the first piece
  ASSERT_EQ(outline.segments.size(), 4u);
  EXPECT_EQ(outline.segments[0].to, (Point2{0, 0}));
  EXPECT_EQ(outline.segments[3].via, (Point2{12.5, 2.5}));
  EXPECT_NEAR(std::abs(area(outline)), 50.0 + 0.5 * std::numbers::pi * 6.25, 1e-9);
  ASSERT_EQ(made.outlines[0].parts.size(), 4u);
  EXPECT_EQ(made.outlines[0].parts[1].piece, 3u);
  EXPECT_FALSE(made.outlines[0].parts[1].reversed);
  EXPECT_TRUE(made.open_ends.empty() && made.junctions.empty() && made.repeated.empty());
}

TEST(Chain, AnOpenChainHasTheDirectionOfItsFirstPiece) {
  const Chained made = chain({line({10, 0}, {20, 0}), line({10, 0}, {0, 0}), line({30, 0}, {20, 0})}, {});
  ASSERT_EQ(made.outlines.size(), 1u);
  EXPECT_EQ(made.outlines[0].outline.start, (Point2{0, 0}));
  EXPECT_EQ(made.outlines[0].outline.segments.back().to, (Point2{30, 0}));
  ASSERT_EQ(made.open_ends.size(), 2u);
  EXPECT_EQ(made.open_ends[0].at, (Point2{0, 0}));
  EXPECT_EQ(made.open_ends[0].piece, 1u);
  EXPECT_DOUBLE_EQ(made.open_ends[0].distance.mm(), 30.0);
  EXPECT_EQ(made.open_ends[0].nearest_piece, 2u);
}

TEST(Chain, SmallGapsAreClosedAtTheirMidpoint) {
  const std::vector<Outline> pieces{line({0, 0}, {10, 0}), line({10, 0.004}, {10, 10}),
                                    line({10, 10}, {0, 0.002})};
  const Chained made = chain(pieces, {});
  ASSERT_EQ(made.outlines.size(), 1u);
  EXPECT_TRUE(made.outlines[0].outline.closed());
  EXPECT_EQ(made.outlines[0].outline.segments[0].to, (Point2{10, 0.002}));
  EXPECT_EQ(made.outlines[0].outline.start, (Point2{0, 0.001}));
  ChainOptions strict;
  strict.join = mm(0.003);
  const Chained open = chain(pieces, strict);
  ASSERT_EQ(open.open_ends.size(), 2u);
  EXPECT_NEAR(open.open_ends[0].distance.mm(), 0.004, 1e-12);
}

TEST(Chain, GapsBesideShortSegmentsGetALine) {
  const Chained made = chain({arc({0, 0}, {0.01, 0.01}, {0.02, 0}), line({0.029, 0}, {5, 0})}, {});
  ASSERT_EQ(made.outlines.size(), 1u);
  const auto& segments = made.outlines[0].outline.segments;
  ASSERT_EQ(segments.size(), 3u);
  EXPECT_EQ(segments[0].to, (Point2{0.02, 0}));
  EXPECT_EQ(segments[1].to, (Point2{0.029, 0}));
}

TEST(Chain, FineTessellationsKeepTheirShape) {
  std::vector<Outline> pieces;
  for (int i = 0; i < 1000; ++i)
    pieces.push_back(line({0.005 * i, 0.001 * (i % 2)}, {0.005 * (i + 1), 0.001 * ((i + 1) % 2)}));
  const Chained made = chain(pieces, {});
  ASSERT_EQ(made.outlines.size(), 1u);
  EXPECT_EQ(made.outlines[0].outline.segments.size(), 1000u);
  EXPECT_EQ(made.open_ends.size(), 2u);
}

TEST(Chain, WhereMoreThanTwoEndsMeetNothingIsJoined) {
  const Chained made =
      chain({line({0, 0}, {5, 5}), line({5, 5}, {10, 0}), line({5, 5}, {5, 10}), line({20, 0}, {30, 0})}, {});
  EXPECT_EQ(made.outlines.size(), 4u);
  ASSERT_EQ(made.junctions.size(), 1u);
  EXPECT_EQ(made.junctions[0].at, (Point2{5, 5}));
  EXPECT_EQ(made.junctions[0].count, 3u);
  EXPECT_EQ(made.junctions[0].pieces, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(made.open_ends.size(), 5u);  // not those at the junction
  // The same across a gap.
  EXPECT_EQ(chain({line({0, 0}, {5, 5}), line({5, 5.002}, {10, 0}), line({5.002, 5}, {5, 10})}, {})
                .junctions.size(),
            1u);
}

TEST(Chain, AnEndOnAnotherPieceIsAJunction) {
  for (const Outline& other :
       {line({0, 5}, {10, 5}), arc({0, 0}, {5, 5}, {10, 0}), as_outline(Circle{{5, 10}, mm(5)})}) {
    const Chained made = chain({line({5, 0}, {5, 4.995}), other}, {});
    ASSERT_EQ(made.junctions.size(), 1u);
    EXPECT_EQ(made.junctions[0].pieces, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(made.outlines.size(), 2u);
  }
}

TEST(Chain, RepeatedPiecesAreIgnored) {
  const Chained made =
      chain({line({0, 0}, {10, 0}), line({10, 0}, {10, 10}), line({10, 0}, {0, 0}),
             arc({10, 10}, {0, 10}, {0, 0}), arc({10, 10}, {0, 10}, {0, 0}),
             arc({0, 0}, {10 / std::numbers::sqrt2 - 2.0710678118654755, 12.071067811865476}, {10, 10})},
            {});
  ASSERT_EQ(made.repeated.size(), 3u);
  for (const auto& [piece, earlier] : {std::pair{0u, 2u}, {3u, 4u}, {3u, 5u}}) {
    const bool found = std::any_of(made.repeated.begin(), made.repeated.end(), [&](const RepeatedPiece& r) {
      return r.piece == earlier && r.earlier == piece;
    });
    EXPECT_TRUE(found) << piece << ' ' << earlier;
  }
  ASSERT_EQ(made.outlines.size(), 1u);
  EXPECT_TRUE(made.outlines[0].outline.closed());
  // A line and an arc between the same points are two pieces.
  EXPECT_TRUE(chain({line({0, 0}, {10, 0}), arc({0, 0}, {5, 5}, {10, 0})}, {}).outlines[0].outline.closed());
}

TEST(Chain, RepeatedClosedOutlinesAreIgnored) {
  const Outline circle = as_outline(Circle{{5, 5}, mm(3)});
  const Outline square{{0, 0}, {{{9, 0}, {}}, {{9, 9}, {}}, {{0, 9}, {}}, {{0, 0}, {}}}};
  Outline turned{{9, 9}, {{{9, 0}, {}}, {{0, 0}, {}}, {{0, 9}, {}}, {{9, 9}, {}}}};
  const Chained made =
      chain({circle, square, circle, turned, as_outline(Circle{{5, 5.1}, mm(3)}), circle}, {});
  ASSERT_EQ(made.outlines.size(), 3u);
  EXPECT_EQ(made.outlines[0].outline, circle);
  EXPECT_EQ(made.outlines[1].outline, square);
  ASSERT_EQ(made.repeated.size(), 3u);
}

TEST(Chain, ClosedAndEmptyPieces) {
  Outline nearly{{0, 0}, {{{10, 0}, {}}, {{10, 10}, {}}, {{0, 0.008}, {}}}};
  const Chained made =
      chain({as_outline(Circle{{0, 0}, mm(5)}), nearly, line({3, 3}, {3, 3}), Outline{}}, {});
  ASSERT_EQ(made.outlines.size(), 2u);
  EXPECT_TRUE(made.outlines[0].outline.closed() && made.outlines[1].outline.closed());
  EXPECT_EQ(made.empty_pieces, 2u);
  EXPECT_TRUE(made.open_ends.empty());
}

TEST(Chain, TimeIsBoundedForManyEndsAndLargeDrawings) {
  std::vector<Outline> star, crowd, grid;
  for (int i = 0; i < 100'000; ++i) {
    const double a = 1e-3 * i;
    star.push_back(line({0, 0}, {std::cos(a) * (1 + a), std::sin(a) * (1 + a)}));
    crowd.push_back(line({1e-8 * i, 1e-8 * (i % 317)}, {5.0 + i, 3}));
    grid.push_back(line({0.0 + i % 317, 0.0 + i / 317}, {0.7 + i % 317, 0.4 + i / 317}));
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(chain(star, {}).junctions.front().count, 100'000u);
  EXPECT_GE(chain(crowd, {}).junctions.size(), 1u);
  EXPECT_EQ(chain(grid, {}).open_ends.size(), 200'000u);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  EXPECT_LT(taken.count(), 60.0);
}

}  // namespace
}  // namespace kerf

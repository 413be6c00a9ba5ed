// Chains of motions of a ball, as in reliefs, against the exact sweeps: each motion starts at the end of the
// previous one, which the kernels use.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>

#include "cut_jobs.h"

namespace kerf::test {
namespace {

constexpr double kMicron = 0.001;
constexpr double kRadius = 3.0;

/// Minimum height of a ball of kRadius above a point while its tip goes from a to b; infinity if it does not
/// reach the point. Above its centre the tool is a cylinder.
double swept_low(Point3 a, Point3 b, double x, double y) {
  if (x < std::min(a.x, b.x) - kRadius || x > std::max(a.x, b.x) + kRadius) return 1e6;
  if (y < std::min(a.y, b.y) - kRadius || y > std::max(a.y, b.y) + kRadius) return 1e6;
  const auto low_at = [&](double t) {
    const double dx = a.x + t * (b.x - a.x) - x, dy = a.y + t * (b.y - a.y) - y;
    const double down2 = kRadius * kRadius - dx * dx - dy * dy;
    return down2 < 0.0 ? 1e6 - down2 : a.z + t * (b.z - a.z) + kRadius - std::sqrt(down2);
  };
  // Convex where the ball is over the point, and increasing away from there.
  double low = 0.0, high = 1.0;
  for (int n = 0; n < 100; ++n) {
    const double left = low + (high - low) / 3, right = high - (high - low) / 3;
    (low_at(left) < low_at(right) ? high : low) = low_at(left) < low_at(right) ? right : left;
  }
  return std::min({low_at(low), low_at(0.0), low_at(1.0)});
}

class Chain {
 public:
  explicit Chain(std::uint32_t seed) : state_(seed) {}
  /// Moves of all kinds in a block from 0 to 26 x 18 x 8.
  std::vector<Point3> moves(int count) {
    std::vector<Point3> all{{5, 5, 9}};
    for (int k = 0; k < count; ++k) all.push_back(next(all.back(), k));
    return all;
  }

 private:
  double fraction() {
    state_ = state_ * 1664525u + 1013904223u;
    return (state_ >> 8) / 16777216.0;
  }
  Point3 next(Point3 at, int k) {
    const double kind = fraction();
    const auto across = [&](double reach) {
      at.x = std::clamp(at.x + reach * (2 * fraction() - 1), 0.0, 26.0);
      at.y = std::clamp(at.y + reach * (2 * fraction() - 1), 0.0, 18.0);
    };
    if (kind < 0.1) {
      at.z = 9 * fraction() - 0.5;  // vertical, sometimes through the floor
    } else if (kind < 0.2) {
      across(20.0);  // level and long
    } else if (kind < 0.3) {
      across(0.1);  // steep
      at.z = std::max(0.5, at.z + 4 * fraction() - 2);
    } else {
      across(k % 2 == 0 ? 0.3 : 3.0);
      at.z = std::clamp(at.z + 0.4 * fraction() - 0.2, 0.2, 8.5);
    }
    return at;
  }
  std::uint32_t state_;
};

class Balls : public testing::TestWithParam<double> {};

TEST_P(Balls, ChainsOfMovesMatchTheExactSweeps) {
  const std::vector<Point3> moves = Chain(12).moves(60);
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, kQuarter}, {kRadius, kRadius, 0}, {kRadius, 40, 0}})));
  Path path;
  path.tool(1).rapid(moves[0]);
  for (std::size_t k = 1; k < moves.size(); ++k) path.cut(moves[k]);
  Diagnostics diagnostics;
  const auto result = run(path.path(), tools, block({0, 0, 0}, {26, 18, 8}), GetParam(), diagnostics);
  ASSERT_TRUE(result);
  const ColumnGrid grid = result->workpiece.grid();
  double largest = 0.0;
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      double expected = 8.0;
      for (std::size_t k = 1; k < moves.size(); ++k)
        expected = std::min(expected, swept_low(moves[k - 1], moves[k], grid.column_x(i), grid.column_y(j)));
      const std::size_t n = static_cast<std::size_t>(j * grid.nx + i);
      const bool is_empty = grid.first[n] == grid.first[n + 1];
      const double height = is_empty ? 0.0 : static_cast<double>(grid.intervals[grid.first[n]].high);
      largest = std::max(largest, std::abs(height - std::max(expected, 0.0)));
    }
  }
  EXPECT_LT(largest, kMicron);
  RecordProperty("largest_um", std::to_string(largest / kMicron));
}

// Whole tiles, and tiles whose last columns are narrower.
INSTANTIATE_TEST_SUITE_P(Pitches, Balls, testing::Values(0.1, 0.11),
                         [](const auto& pitch) { return pitch.param == 0.1 ? "whole" : "narrow"; });

}  // namespace
}  // namespace kerf::test

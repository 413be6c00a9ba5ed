// Single sweeps of every tool and every kind of motion against an independent reference: the ends of the
// columns' intervals.
#include <cstdio>
#include <gtest/gtest.h>

#include "sweep_reference.h"

namespace kerf::test {
namespace {

/// The deviation of the interval ends of a column. On a steep surface a micron sideways counts like a micron
/// in height: an end may be anywhere between the heights of the reference within a micron of the column.
/// `left(x, y)` is the reference.
template <class Left>
double surface_error(double x, double y, const std::vector<Interval>& have, const Left& left) {
  std::vector<Silhouette2::Run> low, high;
  const auto allow = [&](const std::vector<Silhouette2::Run>& want) {
    if (want.size() != have.size()) return;
    if (low.empty()) low = high = want;
    for (std::size_t k = 0; k < want.size(); ++k) {
      low[k] = {std::min(low[k].low, want[k].low), std::min(low[k].high, want[k].high), 0};
      high[k] = {std::max(high[k].low, want[k].low), std::max(high[k].high, want[k].high), 0};
    }
  };
  const auto error = [&] {
    if (low.size() != have.size()) return 1e9;
    double worst = 0.0;
    for (std::size_t k = 0; k < have.size(); ++k) {
      const double bottom = static_cast<double>(have[k].low), top = static_cast<double>(have[k].high);
      worst =
          std::max({worst, low[k].low - bottom, bottom - high[k].low, low[k].high - top, top - high[k].high});
    }
    return worst;
  };
  allow(left(x, y));
  for (int k = 0; k < 8 && error() > kMicron; ++k) {
    const double angle = k * std::numbers::pi / 4;
    allow(left(x + kMicron * std::cos(angle), y + kMicron * std::sin(angle)));
  }
  return error();
}

template <class Runs>
std::string text_of(const Runs& runs) {
  std::string text;
  for (const auto& run : runs) text += std::to_string(run.low) + " to " + std::to_string(run.high) + "\n";
  return text;
}

/// Errors of the columns that the job cuts; reports the first above a micron.
Errors errors_of(const NamedProfile& tool, const Motion& motion, const Workpiece& workpiece) {
  const Remainder left(tool, motion);
  const double pitch = workpiece.pitch().mm();
  double worst = 0.0;
  std::vector<double> errors;
  for (int j = 0; j < workpiece.columns_y(); ++j) {
    for (int i = (3 * j) % 11; i < workpiece.columns_x(); i += 11) {
      const double x = (i + 0.5) * pitch, y = (j + 0.5) * pitch;
      const double error = surface_error(x, y, workpiece.column(i, j), left);
      if (error > kMicron && worst <= kMicron)
        ADD_FAILURE() << tool.name << " " << motion.name << " at " << x << ", " << y << ": " << error
                      << " mm\n"
                      << text_of(workpiece.column(i, j)) << "reference\n"
                      << text_of(left(x, y));
      worst = std::max(worst, error);
      const std::vector<Interval> column = workpiece.column(i, j);
      if (column.size() != 1 || static_cast<double>(column[0].high - column[0].low) < kTop)
        errors.push_back(error);
    }
  }
  return summary_of(std::move(errors));
}

class Sweeps : public testing::TestWithParam<std::size_t> {};

TEST_P(Sweeps, MatchTheReferenceWithinAMicron) {
  const NamedProfile tool = all_profiles()[GetParam()];
  for (const Motion& motion : motions()) {
    const auto result = cut(tool, motion, 0.25);
    ASSERT_TRUE(result);
    const Errors errors = errors_of(tool, motion, result->workpiece);
    EXPECT_LE(errors.largest, kMicron) << tool.name << " " << motion.name;
    std::printf("sweep error, um  %-14s %-14s largest %6.3f  99th percentile %6.3f\n", tool.name.c_str(),
                motion.name.c_str(), errors.largest * 1000, errors.percentile_99 * 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(AllTools, Sweeps, testing::Range<std::size_t>(0, all_profiles().size()),
                         [](const auto& tool) { return all_profiles()[tool.param].name; });

}  // namespace
}  // namespace kerf::test

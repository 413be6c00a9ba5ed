// Gaps below intervals, joined with gaps of neighbouring columns that they touch. The gaps of the grid's
// columns state what is enclosed; those of the samples, which lie at all distances from the beads, are the
// volumes: beside a bead, a gap is narrower than a column.
#include "sim/print/print_hollow.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kerf::printing {
namespace {

/// Disjoint sets of numbers (union-find).
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  std::uint32_t find(std::uint32_t a) {
    while (parent_[a] != a) {
      parent_[a] = parent_[parent_[a]];
      a = parent_[a];
    }
    return a;
  }
  /// The lower number represents both, so that the result does not depend on the order.
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Adds up lengths of vertical lines by layer; each takes the time of two searches.
class ByLayer {
 public:
  ByLayer(const std::vector<double>& tops)
      : tops_(tops), part_(tops.size(), 0.0), whole_(tops.size() + 1, 0) {}

  void add(double low, double high) {
    const std::size_t a = layer_at(low), b = layer_at(high);
    if (a == b) {
      part_[a] += high - low;
      return;
    }
    part_[a] += tops_[a] - low;
    part_[b] += high - tops_[b - 1];
    ++whole_[a + 1];  // all layers between
    --whole_[b];
  }
  /// The length in each layer.
  std::vector<double> lengths() const {
    std::vector<double> sums = part_;
    long long open = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      open += whole_[i];
      if (i > 0) sums[i] += static_cast<double>(open) * (tops_[i] - tops_[i - 1]);
    }
    return sums;
  }

 private:
  /// The lowest layer whose top is not below `height`; the highest for what is above all.
  std::size_t layer_at(double height) const {
    const auto it = std::lower_bound(tops_.begin(), tops_.end(), height);
    return std::min(static_cast<std::size_t>(it - tops_.begin()), tops_.size() - 1);
  }

  const std::vector<double>& tops_;  // above the bed
  std::vector<double> part_;
  std::vector<long long> whole_;  // number of lines that fill this layer, minus that of the layer below
};

/// Gap number k is below interval k. The number after the last gap is the space outside.
class Gaps {
 public:
  Gaps(const ColumnGrid& grid, float touch)
      : grid_(grid),
        touch_(touch),
        outside_(static_cast<std::uint32_t>(grid.intervals.size())),
        sets_(grid.intervals.size() + 1) {}

  float low(std::uint32_t column, std::uint32_t k) const {
    return k == grid_.first[column] ? 0.0f : grid_.intervals[k - 1].high;
  }
  float high(std::uint32_t k) const { return grid_.intervals[k].low; }
  bool is_gap(std::uint32_t column, std::uint32_t k) const { return high(k) - low(column, k) > touch_; }
  bool is_open(std::uint32_t k) { return sets_.find(k) == sets_.find(outside_); }

  /// Joins the gaps of two neighbouring columns with each other and with the space above them.
  void join(std::uint32_t a, std::uint32_t b) {
    std::uint32_t i = grid_.first[a], j = grid_.first[b];
    const std::uint32_t i_end = grid_.first[a + 1], j_end = grid_.first[b + 1];
    while (i < i_end && j < j_end) {
      if (is_gap(a, i) && is_gap(b, j) && reaches(low(a, i), high(i), low(b, j), high(j))) sets_.join(i, j);
      if (high(i) < high(j))
        ++i;
      else
        ++j;
    }
    open_above(a, i, b);
    open_above(b, j, a);
  }
  /// What of a column a gap beside it meets: none of its gaps, or one, or the space above it.
  enum class Meets : std::uint8_t { nothing, outside, enclosed };
  Meets meets(std::uint32_t column, float from, float to) {
    for (std::uint32_t k = grid_.first[column]; k < grid_.first[column + 1]; ++k)
      if (is_gap(column, k) && reaches(from, to, low(column, k), high(k)))
        return is_open(k) ? Meets::outside : Meets::enclosed;
    const std::uint32_t end = grid_.first[column + 1];
    const float top = end == grid_.first[column] ? 0.0f : grid_.intervals[end - 1].high;
    return to - std::max(top, from) > touch_ ? Meets::outside : Meets::nothing;
  }
  void open_all(std::uint32_t column) {
    for (std::uint32_t k = grid_.first[column]; k < grid_.first[column + 1]; ++k)
      if (is_gap(column, k)) sets_.join(k, outside_);
  }

 private:
  bool reaches(float low_a, float high_a, float low_b, float high_b) const {
    return std::min(high_a, high_b) - std::max(low_a, low_b) > touch_;
  }
  /// Joins the gaps of a column from number `from` on with the space above the other column.
  void open_above(std::uint32_t column, std::uint32_t from, std::uint32_t other) {
    const std::uint32_t end = grid_.first[other + 1];
    const float top = end == grid_.first[other] ? 0.0f : grid_.intervals[end - 1].high;
    for (std::uint32_t k = from; k < grid_.first[column + 1]; ++k)
      if (is_gap(column, k) && high(k) - std::max(top, low(column, k)) > touch_) sets_.join(k, outside_);
  }

  const ColumnGrid& grid_;
  float touch_;
  std::uint32_t outside_;
  Sets sets_;
};

bool join_neighbours(const ColumnGrid& grid, Gaps& gaps, Progress* progress) {
  const auto nx = static_cast<std::uint32_t>(grid.nx), ny = static_cast<std::uint32_t>(grid.ny);
  for (std::uint32_t j = 0; j < ny; ++j) {
    if (stop_requested(progress)) return false;
    for (std::uint32_t i = 0; i < nx; ++i) {
      const std::uint32_t column = j * nx + i;
      if (i + 1 < nx) gaps.join(column, column + 1);
      if (j + 1 < ny) gaps.join(column, column + nx);
      if (i == 0 || j == 0 || i + 1 == nx || j + 1 == ny) gaps.open_all(column);
    }
  }
  return true;
}

/// Whether a gap of a sample is enclosed: by the gap that it meets in the nearest column, else by those
/// around it. What meets none is a groove narrower than the columns.
bool is_enclosed(const ColumnGrid& grid, Gaps& gaps, Point2 at, float low, float high) {
  const auto nearest = [&grid](double v, int count) {
    return std::clamp(static_cast<int>(std::lround(v / grid.pitch)), 0, count - 1);
  };
  const int i = nearest(at.x, grid.nx), j = nearest(at.y, grid.ny);
  const auto meets = [&](int x, int y) {
    return gaps.meets(static_cast<std::uint32_t>(y * grid.nx + x), low, high);
  };
  const Gaps::Meets here = meets(i, j);
  if (here != Gaps::Meets::nothing) return here == Gaps::Meets::enclosed;
  bool enclosed = false;
  for (int y = std::max(j - 1, 0); y <= std::min(j + 1, grid.ny - 1); ++y) {
    for (int x = std::max(i - 1, 0); x <= std::min(i + 1, grid.nx - 1); ++x) {
      const Gaps::Meets beside = meets(x, y);
      if (beside == Gaps::Meets::outside) return false;
      enclosed = enclosed || beside == Gaps::Meets::enclosed;
    }
  }
  return enclosed;
}

}  // namespace

bool measure_hollow(const ColumnGrid& grid, double touch, const HollowSamples& samples,
                    std::vector<PrintLayer>& layers, PrintVolumes& total, Progress* progress) {
  if (layers.empty()) return true;
  Gaps gaps(grid, static_cast<float>(touch));
  if (!join_neighbours(grid, gaps, progress)) return false;
  std::vector<double> tops;
  for (const PrintLayer& layer : layers) tops.push_back(layer.z.mm() - grid.bounds.low.z);
  ByLayer hollow(tops), enclosed(tops);
  const auto narrowest = static_cast<float>(touch);
  samples.each([&](Point2 at, std::span<const Interval> runs) {
    float low = 0.0f;
    for (const Interval& run : runs) {
      if (run.low - low > narrowest) {
        hollow.add(low, run.low);
        if (is_enclosed(grid, gaps, at, low, run.low)) enclosed.add(low, run.low);
      }
      low = run.high;
    }
  });
  if (stop_requested(progress)) return false;
  const double area = samples.area;
  const std::vector<double> all = hollow.lengths(), shut = enclosed.lengths();
  for (std::size_t i = 0; i < layers.size(); ++i) {
    layers[i].volumes.hollow = mm3(area * all[i]);
    layers[i].volumes.enclosed = mm3(area * shut[i]);
    total.hollow = total.hollow + layers[i].volumes.hollow;
    total.enclosed = total.enclosed + layers[i].volumes.enclosed;
  }
  return true;
}

}  // namespace kerf::printing

// What the roads of a print are like as a whole, and how the columns stand that hold them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/print/print_tile.h"

#include "kerf/progress.h"

namespace kerf::printing {

struct Survey final : RoadSink {
  explicit Survey(Progress* asked) : progress(asked) {}

  void road(const Road& r) override;
  bool goes_on() override;
  /// Leaves each level once, lowest first; those that rounding alone tells apart become the lowest of them.
  void sort_levels();
  /// The number of the layer with this level; levels must be sorted.
  std::uint32_t layer_of(double level) const;
  double usual_width() const { return area / length; }

  Progress* progress;
  Box3 box;
  std::size_t roads = 0, motions = 0, sorted = 1024;
  double length = 0.0, area = 0.0;  // mm, mm2 of all roads in the plan
  std::vector<double> levels;
  bool stopped = false;
};

/// Where the columns stand. Nothing, and said, where there are too many.
std::optional<Frame> make_frame(const Survey& survey, const PrintOptions& options, Diagnostics& diagnostics);

}  // namespace kerf::printing

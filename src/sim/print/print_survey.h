// The survey of the beads of a print, and its columns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/print/print_tile.h"

#include "kerf/base/progress.h"

namespace kerf::printing {

struct PrintSurvey final : BeadSink {
  explicit PrintSurvey(Progress* asked) : progress(asked) {}

  void bead(const Bead& r) override;
  bool wants_more() override;
  /// Sorts the levels and removes duplicates; of levels that differ only by rounding the lowest stays.
  void sort_levels();
  /// The number of the layer at this level; levels must be sorted.
  std::uint32_t layer_of(double level) const;
  double usual_width() const { return area / length; }

  Progress* progress;
  Box3 box;
  std::size_t beads = 0, motions = 0, sorted = 1024;
  double length = 0.0, area = 0.0;  // mm, mm2 of all beads in plan
  std::vector<double> levels;
  bool stopped = false;
};

/// The columns for volumes: spread evenly over the same area, about two million in all beads, whatever the
/// pitch.
Frame make_sample_frame(const Frame& columns, const PrintSurvey& survey);

/// The grid of columns. Nothing, with an error appended, if there are too many.
std::optional<Frame> make_frame(const PrintSurvey& survey, const PrintOptions& options,
                                Diagnostics& diagnostics);

}  // namespace kerf::printing

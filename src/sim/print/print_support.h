// Unsupported beads: bridges, overhangs, beads in the air.
#pragma once

#include <utility>
#include <vector>

#include "sim/print/print_tile.h"

namespace kerf::printing {

/// Collects consecutive unsupported beads in time order and reports them.
class UnsupportedBeads {
 public:
  explicit UnsupportedBeads(std::vector<PrintHazard>& hazards) : hazards_(hazards) {}

  /// Returns the length of the bead with nothing below it.
  double add(const Bead& bead, const PieceSums& sums) {
    if (!bead.continues) {
      close();
      supported_ = false;
      bare_fraction_ = 0.0;
    }
    // A bead so short that it covers no column counts like the previous one.
    if (sums.centre > 0) bare_fraction_ = static_cast<double>(sums.bare) / sums.centre;
    supported_ = supported_ || sums.supported || sums.full == 0.0;
    const double bare = bare_fraction_ * bead.length;
    const PrintHazardKind kind = supported_ ? PrintHazardKind::unsupported : PrintHazardKind::in_air;
    if (open_ && (bare == 0.0 || kind != entry_.kind)) close();
    if (bare == 0.0) return 0.0;
    if (!open_) {
      open_ = true;
      width_ = bead.section.width;
      entry_ = {kind, bead.step, 0, bead.from, {}, {}, {}, mm(width_)};
    }
    ++entry_.steps;
    entry_.length = entry_.length + mm(bare);
    return bare;
  }
  void close() {
    if (!std::exchange(open_, false)) return;
    if (entry_.kind == PrintHazardKind::in_air || entry_.length.mm() > width_) hazards_.push_back(entry_);
  }

 private:
  std::vector<PrintHazard>& hazards_;
  PrintHazard entry_;
  bool open_ = false, supported_ = false;
  double width_ = 0.0, bare_fraction_ = 0.0;
};

}  // namespace kerf::printing

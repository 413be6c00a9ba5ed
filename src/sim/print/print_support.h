// Roads that nothing holds: bridges, overhangs, roads in the air.
#pragma once

#include <utility>
#include <vector>

#include "sim/print/print_tile.h"

namespace kerf::printing {

/// Follows roads in time order and tells stretches without support.
class Stretches {
 public:
  explicit Stretches(std::vector<PrintHazard>& hazards) : hazards_(hazards) {}

  /// Returns the length of the road that has nothing below.
  double add(const Road& road, const Sums& sums) {
    if (!road.goes_on) {
      close();
      held_ = false;
      share_ = 0.0;
    }
    // A road so short that no column stands under it is as the one before.
    if (sums.middle > 0) share_ = static_cast<double>(sums.bare) / sums.middle;
    held_ = held_ || sums.held || sums.full == 0.0;
    const double bare = share_ * road.length;
    const PrintHazardKind kind = held_ ? PrintHazardKind::unsupported : PrintHazardKind::in_air;
    if (open_ && (bare == 0.0 || kind != stretch_.kind)) close();
    if (bare == 0.0) return 0.0;
    if (!open_) {
      open_ = true;
      width_ = road.section.width;
      stretch_ = {kind, road.step, 0, road.from, {}, {}, {}};
    }
    ++stretch_.steps;
    stretch_.length = stretch_.length + mm(bare);
    return bare;
  }
  void close() {
    if (!std::exchange(open_, false)) return;
    if (stretch_.kind == PrintHazardKind::in_air || stretch_.length.mm() > width_)
      hazards_.push_back(stretch_);
  }

 private:
  std::vector<PrintHazard>& hazards_;
  PrintHazard stretch_;
  bool open_ = false, held_ = false;
  double width_ = 0.0, share_ = 0.0;
};

}  // namespace kerf::printing

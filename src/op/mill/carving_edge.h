// The cutting edge of a tool that increases in diameter upwards, by its radius: how deep the tool may go for
// a width.
#pragma once

#include <optional>
#include <vector>

#include "kerf/tool/tool.h"

namespace kerf::op_detail {

class CarvingEdge {
 public:
  /// Nothing for a tool whose cutting part does not increase in diameter above its tip, or decreases below
  /// its largest one.
  static std::optional<CarvingEdge> of(const Tool& tool);

  double tip() const { return points_.front().r; }    // mm, the radius of a flat tip
  double widest() const { return points_.back().r; }  // mm, the largest radius
  double height() const { return points_.back().z; }  // mm above the tip, where it is reached
  double height_of(double radius) const;              // mm; the lowest and the highest beyond both ends
  double radius_at(double height) const;              // mm

 private:
  struct Point {
    double r, z;
  };
  std::vector<Point> points_;  // neither falls; arcs as chords
};

}  // namespace kerf::op_detail

// Paths of a tool along a mesh: heights at points of lines seen from above, close together where they are
// curved or jump, and few points where they are straight.
#pragma once

#include <vector>

#include "op/mesh/drop_cutter.h"

namespace kerf::op_detail {

/// How far apart two positions of a tool may be so that a straight way between them cuts no more than a tenth
/// of the tolerance deeper than they do; of pointed tools, no more than the tolerance.
double sample_pitch(const SurfaceTool& tool, double tolerance);

class SurfaceFollower {
 public:
  /// `tolerance`: mm, how far above the mesh the path may be. Heights are at least `floor`.
  SurfaceFollower(const DropCutter& cutter, double floor, double tolerance);

  /// The path of the tip along a line. A jump is vertical: the path is at its upper end as long as the tool
  /// may touch anything there.
  std::vector<Point3> follow(Point2 from, Point2 to) const;

 private:
  struct Sample {
    double s = 0.0, z = 0.0;  // mm along the line; height
    bool split = false;       // the interval from here to the next sample is halved
  };
  void refine(std::vector<Sample>& samples, Point2 from, Point2 along) const;
  std::vector<Sample> with_jumps(const std::vector<Sample>& samples) const;
  void thin(const std::vector<Sample>& samples, std::size_t first, std::size_t last,
            std::vector<Sample>& kept) const;

  const DropCutter& cutter_;
  double floor_, tolerance_, pitch_;
};

}  // namespace kerf::op_detail

// How far a place is from a tool that stands still: what exact meshes are computed from, in double precision.
#pragma once

#include <vector>

#include "kerf/tool.h"

namespace kerf::sim {

/// Distance to a solid of revolution, mm, negative inside, how it changes with the distance from the axis and
/// with the height, and how that changes on the way across that direction, a mm.
struct TurnedDistance {
  double value = 0.0;
  double by_r = 0.0, by_z = 0.0;
  double bend = 0.0;
};

/// A tool and what holds it (see `held`) as the outline of its half: lines and arcs, hollow ones too.
class ToolDistance {
 public:
  explicit ToolDistance(const Silhouette& tool);

  /// Of a place `rho` mm from the axis and `z` mm above the tip. Moving outwards never brings a place nearer:
  /// a level sweep is nearest where its path is nearest in plan.
  TurnedDistance at(double rho, double z) const;
  double rim() const { return rim_; }        // mm, the largest radius
  double bottom() const { return bottom_; }  // mm above the tip
  /// Whether the distance is a convex function: along a line it has one lowest place.
  bool is_convex() const { return is_convex_; }

 private:
  /// From a knot to the next, material on the left: towards the axis on the way up. A LineArc in (r, z) whose
  /// constants are computed once, as millions of distances are computed.
  struct ProfileSegment {
    double r0 = 0.0, z0 = 0.0, r1 = 0.0, z1 = 0.0;
    double per_length2 = 0.0;  // one divided by the square of its chord
    double side = 0.0;  // of an arc: 1 where it bulges away from the axis, -1 where it is hollow; else 0
    double centre_r = 0.0, centre_z = 0.0, radius = 0.0;
    double r_per_z = 0.0;  // of a line that is not level
  };
  struct Nearest;
  void add_region(const std::vector<Knot>& knots);
  static ProfileSegment segment_between(const Knot& a, const Knot& b);
  static double per_square(const ProfileSegment& segment);
  static bool goes_on(const ProfileSegment& before, const ProfileSegment& next);
  static double radius_at(const ProfileSegment& segment, double z);
  static void look_at_line(const ProfileSegment& segment, double rho, double z, Nearest& nearest);
  static void look_at_arc(const ProfileSegment& segment, double rho, double z, Nearest& nearest);
  bool turns_left() const;
  bool is_inside(double rho, double z) const;

  std::vector<ProfileSegment> segments_;
  double rim_ = 0.0, bottom_ = 0.0;
  bool is_convex_ = false;
};

}  // namespace kerf::sim

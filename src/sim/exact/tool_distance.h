// Signed distance of a point to a tool at a fixed position, in double precision.
//
// A tool is a solid of revolution, so the distance is computed in its half plane (rho, z): to the nearest
// point of the half outline, negative inside. Exact meshes are computed from these distances, not from the
// columns.
#pragma once

#include <vector>

#include "kerf/tool/tool.h"

namespace kerf::sim {

/// Signed distance to a solid of revolution, mm, negative inside, with its derivatives in the half plane.
struct ProfileDistance {
  double value = 0.0;
  double by_r = 0.0, by_z = 0.0;  // gradient, length 1
  double curvature = 0.0;         // second derivative perpendicular to the gradient, 1/mm
};

/// A tool with its holder (see `held`) as a half outline of lines and arcs, convex and concave ones.
class ToolDistance {
 public:
  explicit ToolDistance(const Silhouette& tool);

  /// For a point `rho` mm from the axis and `z` mm above the tip. The distance does not decrease with rho, so
  /// that a level sweep is nearest where its path is nearest in plan.
  ProfileDistance at(double rho, double z) const;
  double rim() const { return rim_; }        // mm, the largest radius
  double bottom() const { return bottom_; }  // mm above the tip
  /// Whether the distance is a convex function: it then has a single minimum along any line.
  bool is_convex() const { return is_convex_; }

 private:
  /// From one knot to the next, with the material on the left. A LineArc in (r, z) with precomputed
  /// constants, as millions of distances are computed.
  struct ProfileSegment {
    double r0 = 0.0, z0 = 0.0, r1 = 0.0, z1 = 0.0;
    double per_length2 = 0.0;  // 1 / chord^2
    double side = 0.0;         // 1 for a convex arc, -1 for a concave one, 0 for a line
    double centre_r = 0.0, centre_z = 0.0, radius = 0.0;
    double r_per_z = 0.0;  // of a line that is not level
  };
  struct NearestOnProfile;
  void add_outline(const std::vector<Knot>& knots);
  static ProfileSegment segment_between(const Knot& a, const Knot& b);
  static double per_square(const ProfileSegment& segment);
  static bool is_one_vertical(const ProfileSegment& before, const ProfileSegment& next);
  static double radius_at(const ProfileSegment& segment, double z);
  static void add_line(const ProfileSegment& segment, double rho, double z, NearestOnProfile& nearest);
  static void add_arc(const ProfileSegment& segment, double rho, double z, NearestOnProfile& nearest);
  bool is_outline_convex() const;
  bool is_inside(double rho, double z) const;

  std::vector<ProfileSegment> segments_;
  double rim_ = 0.0, bottom_ = 0.0;
  bool is_convex_ = false;
};

}  // namespace kerf::sim

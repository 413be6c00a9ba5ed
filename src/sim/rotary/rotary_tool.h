// A tool of the rotary simulator: frusta about the Z axis, intersected with rays of any tilt.
#pragma once

#include <vector>

#include "kerf/base/units.h"
#include "kerf/tool/tool.h"

namespace kerf::sim {

/// An interval of a ray, mm from the axis of the bar.
struct RayInterval {
  double low, high;
};

/// A ray relative to the tool tip: r mm from the axis of the bar its point is (x, y + r * sine, z + r *
/// cosine).
struct TiltedRay {
  double x, y, z;
  double sine, cosine;
};

/// A part of a tool as frusta.
class Frusta {
 public:
  Frusta() = default;
  /// Arcs become chords within `chord`; all surfaces are moved inwards by `shrink`, except the top.
  Frusta(const Profile& profile, Length chord, Length shrink);
  /// A cylinder.
  Frusta(double radius, double bottom, double top);

  bool empty() const { return bands_.empty(); }
  double rim() const { return rim_; }
  double bottom() const { return bottom_; }
  double top() const { return top_; }
  /// Appends the intervals of a ray, from 0 to `reach`, inside the part; intervals that touch are joined.
  void intersect(const TiltedRay& ray, double reach, std::vector<RayInterval>& out) const;

 private:
  struct Band {
    double low, high;      // heights above the tip
    double radius, slope;  // at `low`, and its change with height
  };
  void add_band(double r0, double z0, double r1, double z1);

  std::vector<Band> bands_;
  double rim_ = 0.0, bottom_ = 0.0, top_ = 0.0;
};

}  // namespace kerf::sim

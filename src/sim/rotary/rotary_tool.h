// A tool as the rays of the rotary simulator meet it: frusta about an upright axis, met by lines of any tilt.
#pragma once

#include <vector>

#include "kerf/tool.h"
#include "kerf/units.h"

namespace kerf::sim {

/// A stretch of a ray, mm from the bar's axis.
struct Stretch {
  double low, high;
};

/// A ray seen from the tool's tip: r mm along it, the point is (x, y + r * sine, z + r * cosine).
struct TiltedRay {
  double x, y, z;
  double sine, cosine;
};

/// A part of a tool as frusta.
class Frusta {
 public:
  Frusta() = default;
  /// Arcs become chords that stray by at most `chord`; everything is `shrink` smaller, but for its top.
  Frusta(const Profile& profile, Length chord, Length shrink);
  /// A cylinder.
  Frusta(double radius, double bottom, double top);

  bool empty() const { return bands_.empty(); }
  double rim() const { return rim_; }
  double bottom() const { return bottom_; }
  double top() const { return top_; }
  /// Appends where a ray, from its begin to `reach`, lies within the part; stretches that touch are one.
  void meet(const TiltedRay& ray, double reach, std::vector<Stretch>& out) const;

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

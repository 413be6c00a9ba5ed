// A tool of the rotary simulator: frusta about the Z axis, intersected with rays of any tilt.
#pragma once

#include <cstddef>
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

/// A part of a tool as frusta, in convex bodies: what a ray has of one is one interval.
class Frusta {
 public:
  Frusta() = default;
  /// Arcs become chords within `chord`; all surfaces are moved inwards by `shrink`, except the top.
  Frusta(const Profile& profile, Length chord, Length shrink);
  /// A cylinder.
  Frusta(double radius, double bottom, double top);

  bool empty() const { return bands_.empty(); }
  double rim() const { return rim_; }
  double bottom() const { return bands_.empty() ? 0.0 : bands_.front().low; }
  double top() const { return bands_.empty() ? 0.0 : bands_.back().high; }
  /// Whether every point below the top that is nearer to the axis, or above, than one inside is inside too.
  bool widens() const { return widens_; }

  /// The largest radius below a height.
  double rim_below(double height) const;

  std::size_t bodies() const { return bodies_.size(); }
  double rim(std::size_t body) const { return bodies_[body].rim; }
  double bottom(std::size_t body) const { return bands_[bodies_[body].first].low; }
  /// The interval of a ray, from 0 to `reach`, inside a body.
  bool intersect(std::size_t body, const TiltedRay& ray, double reach, RayInterval& out) const;
  /// How far the ray stays outside a body: the least of what its points lack in radius or height, in mm; not
  /// above zero where it touches. A convex function of straight motions.
  double shortfall(std::size_t body, const TiltedRay& ray, double reach) const;

 private:
  struct Band {
    double low, high;        // heights above the tip
    double radius, slope;    // at `low`, and its change with height
    double rim, top_square;  // square of the radius at `high`
    double rim_before;       // of the bands below
  };
  struct Body {
    std::size_t first, end;  // of the bands
    double rim;
  };
  void add_bands(const std::vector<Knot>& points, double less);
  void add_band(double r0, double z0, double r1, double z1);
  double radius_at(const Body& body, double height) const;
  std::size_t first_entered(const Body& body, const TiltedRay& ray) const;
  static bool cross(const Band& band, const TiltedRay& ray, double low, double high, RayInterval& out);

  std::vector<Band> bands_;  // lowest first
  std::vector<Body> bodies_;
  double rim_ = 0.0;
  bool widens_ = true;
};

}  // namespace kerf::sim

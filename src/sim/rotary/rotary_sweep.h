// What a tool that moves while the bar turns takes of a ray.
//
// At any moment a convex body has one interval of a ray. Along a short straight motion its lower end falls
// and rises again (exactly so without a turn), so that the interval over the motion is found by a descent
// from the moment at which the tool's axis is nearest to the ray. The number of moments that are computed
// does not depend on the distance of the rays.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "sim/rotary/rotary_motions.h"
#include "sim/rotary/rotary_tool.h"

namespace kerf::sim {

/// The angles of rays, relative to the turn of the bar, that can be below a part of a tool.
struct AngleRange {
  double low, high;
  bool is_all;
};

/// The angle of a ray on the bar at A = 0.
struct RayAngle {
  explicit RayAngle(double a) : angle(a), sine(std::sin(a)), cosine(std::cos(a)) {}
  double angle, sine, cosine;
};

/// A part of a tool along a piece of a motion.
class PartSweep {
 public:
  PartSweep(const Frusta& part, const RotaryMotion& motion, const RoundBar& bar);

  /// Whether the part comes nowhere near the bar.
  bool misses_bar() const;
  AngleRange angles() const { return angles_; }
  double low_x() const { return std::min(motion_.from.x, motion_.to.x) - rim_; }
  double high_x() const { return std::max(motion_.from.x, motion_.to.x) + rim_; }

  /// Chooses a ray by its position and its angle, with `turn` full turns added, and with material up to
  /// `reach`. False if the part does not come near it.
  bool aim(double x, const RayAngle& angle, double turn, double reach);
  std::size_t bodies() const { return part_.bodies(); }
  /// Appends what a body passes through of the ray: one interval unless a turn takes it out and in again.
  void cover(std::size_t body, std::vector<RayInterval>& out);
  /// The first moment, before one of contact, at which the part is deeper in the ray than this.
  double first_contact(double depth);
  TiltedRay seen(double t) const;

 private:
  /// The interval of a body at a moment; missing if its low end is above its high end.
  struct Moment {
    double t;
    RayInterval interval;
    bool touches() const { return interval.low <= interval.high; }
    /// What a descent lowers: the low end, or the negative high end.
    double end(bool upwards) const { return upwards ? -interval.high : interval.low; }
  };
  /// Of the intervals of all moments: their hull, and what all have.
  struct Reached {
    RayInterval hull, common;
  };
  /// What the ray lacks to touch a body at a moment, mm.
  struct Gap {
    double t, lack;
  };
  void limit_angles(double right, double left);
  void turn_to(const RayAngle& angle);
  bool is_beside(double lowest, double widest) const;
  bool is_convex(double least) const;
  bool limit_to_extremes();
  bool limit_to(double at, double rate, double low, double high);
  double nearest(double r, double t) const;
  Moment moment(std::size_t body, double t);
  double lowest_low(std::size_t body) const;
  bool find_contact(std::size_t body);
  bool approach(std::size_t body);
  bool approach(std::size_t body, Gap low, Gap at, Gap high);
  void descend(std::size_t body, bool upwards);
  void refine(std::size_t body, bool upwards, Moment low, Moment at, Moment high);
  bool stays(std::size_t body, const Moment& a, const Moment& b);
  void divide(std::size_t body, std::vector<RayInterval>& out);
  void sample(std::size_t body);
  void sort_moments();

  const Frusta& part_;
  const RotaryMotion& motion_;
  double radius_, axis_y_, axis_z_;
  double lowest_;                                             // height of the part's bottom above the axis
  double rim_;                                                // of what of the part can be in the bar
  double shortest_way_;                                       // of a descent, a fraction of the motion
  double turn_sine_, turn_cosine_, half_sine_, half_cosine_;  // of the bar at the midpoint, and from there
  AngleRange angles_{};
  double sine_ = 0.0, cosine_ = 1.0, prepared_ = 1e300;  // of the ray at the midpoint of the motion
  TiltedRay at_start_{}, at_end_{};                      // of rays of this angle; x is of no meaning
  double upright_ = 1.0;                                 // the largest cosine along the motion

  double x_ = 0.0, angle_ = 0.0, reach_ = 0.0;  // the ray
  double first_ = 0.0, last_ = 1.0;             // when the part can touch it
  double touch_start_ = 0.0;                    // of a search for the first contact
  std::vector<Moment> moments_;                 // of a body that were computed
  bool sampled_ = false;
  Reached reached_{};
  double deepest_ = 0.0;  // the moment with the lowest end
};

}  // namespace kerf::sim

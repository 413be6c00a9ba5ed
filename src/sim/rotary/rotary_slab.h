// Rays of a slab of the bar, cut by all motions in time order.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "sim/rotary/rotary_motions.h"
#include "sim/rotary/rotary_sweep.h"

#include "kerf/sim/rotary.h"

namespace kerf::sim {

inline constexpr double kTurn = 6.283185307179586;

/// The integral of r over runs, mm2: times the angle, the area of a sector.
double sector(const std::vector<Interval>& runs);

struct RotaryContact {
  double fraction = 2.0;
  Point3 at;
  double depth = 0.0, volume = 0.0;
};
using RotaryContacts = std::map<std::pair<std::uint32_t, HazardKind>, RotaryContact>;

/// A ray of a slab. `weight`: length by angle of its cell, mm by radians; negative where others replace it.
struct SlabRay {
  double x;
  RayAngle angle;
  double weight;
  std::vector<Interval>* runs;
};

/// What the motions did to a slab.
struct SlabResult {
  std::vector<std::pair<std::uint32_t, double>> removed;  // mm3 by step, in order
  RotaryContacts contacts;
};

class Slab {
 public:
  /// `rows`: the rays by their number around the bar, which is that of their angle, rounded.
  Slab(const RoundBar& bar, std::vector<std::vector<SlabRay>> rows, double hazard_depth);

  void cut(const RotaryMotion& motion, const RotaryTool& tool);
  SlabResult result;

 private:
  enum class Pass : std::uint8_t { cut, contact };
  void cut_piece(const RotaryMotion& piece, const RotaryTool& tool);
  void apply(const Frusta& part, Pass pass, HazardKind kind, const RotaryMotion& piece);
  void apply_to_ray(PartSweep& sweep, Pass pass, HazardKind kind, const RotaryMotion& piece,
                    const SlabRay& ray);
  double take(std::vector<Interval>& runs, RayInterval s, std::uint32_t step, double& longest);
  double taken_by(std::uint32_t step, HazardKind kind, const void* ray, double more);
  void note(HazardKind kind, const RotaryMotion& piece, PartSweep& sweep, const SlabRay& ray,
            const RotaryContact& contact);

  const RoundBar& bar_;
  std::vector<std::vector<SlabRay>> rows_;
  double hazard_depth_;
  double low_ = 0.0, high_ = 0.0;  // of the rays, along the bar
  struct Taken {
    std::uint32_t step = kStockSurface;
    std::unordered_map<const void*, double> of_ray;  // mm
  };
  std::array<Taken, 8> taken_;  // by HazardKind
  std::vector<RayInterval> covered_, intervals_;
  std::vector<Interval> rest_;
};

}  // namespace kerf::sim

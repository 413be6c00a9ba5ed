// The roads of a printing program: how wide and how high each is, which goes on from which, what is pushed on
// the spot. Passes over the toolpath call a sink; they can be repeated, with the same roads each time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kerf/print.h"

namespace kerf::printing {

/// Nozzle heights closer than this are one layer; less than any printer's steps, more than what rounding
/// leaves.
inline constexpr double kSameLevel = 0.01;  // mm

/// The cross-section of a road: a rectangle with half circles at its sides.
struct Section {
  double width = 0.0, height = 0.0;  // mm; never wider than high only where it is round
};
/// The section with so much area (mm2) that is so high; a round string where there is less material.
Section section_of(double area, double height);
/// The height of a section of this area and width; 0 where no such section is wider than high.
double height_of(double area, double width);

struct Road {
  std::uint32_t step = 0;
  Point3 from, to;      // mm, of the nozzle
  Point2 along;         // unit vector, in the plan
  double length = 0.0;  // mm, in the plan
  double volume = 0.0;  // mm3
  Section section;
  double level = 0.0;    // Z of its layer, mm
  bool goes_on = false;  // begins where the road before ended, with nothing in between

  /// Z of the nozzle for each mm along the plan.
  double slope() const { return (to.z - from.z) / length; }
};

/// What a pass calls, in the order of steps.
class RoadSink {
 public:
  virtual ~RoadSink() = default;
  virtual void road(const Road&) {}
  /// `next` goes on where `before` ends, or a chain's first road begins where its last one ends.
  virtual void corner(const Road& /*before*/, const Road& /*next*/) {}
  virtual void free_begin(const Road&) {}
  virtual void free_end(const Road&) {}
  virtual void travel(std::uint32_t /*step*/, Point3 /*from*/, Point3 /*to*/) {}
  virtual void blob(std::uint32_t /*step*/, Point3 /*at*/, double /*mm3*/) {}
  /// Asked before each motion; false ends the pass.
  virtual bool goes_on() { return true; }
};

/// One pass. With diagnostics (null: says nothing) it tells what cannot be laid.
void for_each_road(const Toolpath& path, const PrintOptions& options, RoadSink& sink,
                   Diagnostics* diagnostics);

}  // namespace kerf::printing

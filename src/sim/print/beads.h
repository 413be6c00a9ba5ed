// The beads of a printing program: width and height of each, which continues which, and blobs. Passes over
// the toolpath call a sink; they can be repeated and return the same beads each time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kerf/sim/print.h"

namespace kerf::printing {

/// Nozzle heights closer than this are one layer, mm: less than the step of any printer, more than rounding.
inline constexpr double kSameLevel = 0.01;  // mm

/// The cross-section of a bead: a rectangle with half circles at its sides.
struct Section {
  double width = 0.0, height = 0.0;  // mm; width >= height, equal for a round section
};
/// The section of this area (mm2) and height; a circle if there is less material.
Section section_of(double area, double height);
/// The height of a section of this area and width; 0 if there is none with width >= height.
double height_of(double area, double width);

struct Bead {
  std::uint32_t step = 0;
  Point3 from, to;      // mm, of the nozzle
  Point2 along;         // unit vector in plan
  double length = 0.0;  // mm in plan
  double volume = 0.0;  // mm3
  Section section;
  double level = 0.0;      // Z of its layer, mm
  bool continues = false;  // starts at the end of the previous bead, with nothing in between

  /// Rise of the nozzle per mm in plan.
  double slope() const { return (to.z - from.z) / length; }
};

/// Receives the beads of a pass, in the order of steps.
class BeadSink {
 public:
  virtual ~BeadSink() = default;
  virtual void bead(const Bead&) {}
  /// `next` continues `before`, or a closed chain ends at the start of its first bead.
  virtual void corner(const Bead& /*before*/, const Bead& /*next*/) {}
  virtual void free_start(const Bead&) {}
  virtual void free_end(const Bead&) {}
  virtual void travel(std::uint32_t /*step*/, Point3 /*from*/, Point3 /*to*/) {}
  virtual void blob(std::uint32_t /*step*/, Point3 /*at*/, double /*mm3*/) {}
  /// Filament extruded while moving from an unknown position.
  virtual void unplaced(double /*mm3*/) {}
  /// Called before each motion; false ends the pass.
  virtual bool wants_more() { return true; }
};

/// One pass. Diagnostics may be null; else what cannot be laid is reported.
void for_each_bead(const Toolpath& path, const PrintOptions& options, BeadSink& sink,
                   Diagnostics* diagnostics);

}  // namespace kerf::printing

// Sweeps, made by the planner from the motions of a toolpath and cut by the kernels: straight sweeps and
// level arcs in the block's frame (mm from its lowest corner), with the parts of the tool that can touch the
// block.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/sweep/solid.h"

#include "kerf/sim/simulation_options.h"
#include "kerf/tool/tool.h"

namespace kerf::sim {

/// What is tested or removed along a sweep, in this order.
enum PassBits : std::uint8_t {
  kPassCut = 1,        // the cutting part at feed
  kPassOverFlute = 2,  // contacts of the end of the cutting part above the flutes
  kPassNeck = 4,
  kPassShank = 8,
  kPassHolder = 16,
  kPassRapid = 32,       // the cutting part at rapid speed; neck, shank and holder are then the same hazard
  kPassSpindleOff = 64,  // with kPassCut: cut with the spindle stopped
};

/// A tool as solids: the exact cutting part, and all parts slightly shrunk for finding contacts.
struct ToolSolids {
  Solid cutting;
  Solid touching[4];  // cutting, neck, shank, holder, as ToolPart numbers them, see held()
  Solid over_flute;   // the radius just above the flutes, from there upwards
};

/// Members of SimulationOptions.
struct Surroundings {
  std::optional<AxisRates> rapid_rates;
  Length spoilboard;
};

/// `side_clearance`: shallower sideways contacts are ignored.
ToolSolids make_tool_solids(const Silhouette& tool, Length side_clearance);

/// The lowest point of the parts that do not cut; kAboveAll if there are none.
double bottom_of_others(const ToolSolids& tool);

/// Chord tolerance for helices, spirals and arcs in XZ and YZ, mm: a tenth of the permitted error of surfaces
/// (1 um), as a steep flank turns an error of the path into a larger one in height.
inline constexpr double kPathChord = 0.0001;
/// Chord tolerance of the frusta for a concave arc of a profile, mm.
inline constexpr double kProfileChord = 0.0005;

struct Sweep {
  double x = 0.0, y = 0.0, z = 0.0;  // start point; of an arc the centre
  double ux = 1.0, uy = 0.0;  // direction in plan; of an arc the direction from the centre to the start point
  double length = 0.0;        // in plan; 0: straight up or down
  double z_end = 0.0;
  double slope = 0.0;  // of a line: rise per mm in plan; 0 for plunges
  float ball_lead =
      0.0f;  // slope / sqrt(1 + slope^2): how far behind its centre a ball cuts deepest, in radii
  double radius = 0.0, turn = 0.0;                   // of an arc; radians, positive counter-clockwise
  float start_fraction = 0.0f, end_fraction = 1.0f;  // fractions of the step's path
  std::uint32_t step = 0;
  std::uint32_t tool = 0;  // index of its ToolSolids
  std::uint8_t passes = 0;
  bool is_arc = false;
  bool follows = false;  // the previous sweep cut with the same tool and ended at the start of this one
  /// An earlier sweep of its batch has the same tool, passes and path: nothing is left for this one to touch.
  bool is_repeat = false;
};

/// The first contact of one kind of a sweep in a tile, or merged over all tiles.
struct Contact {
  std::uint32_t step = 0;
  HazardKind kind{};
  double fraction = 2.0;  // of the step's path where the contact starts; above 1 while there is none
  Point3 at;              // block frame
  double depth = 0.0;     // mm
  double removed = 0.0;   // mm3
};

}  // namespace kerf::sim

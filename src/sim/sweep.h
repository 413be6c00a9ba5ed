// What the planner makes of the motions of a toolpath and the kernels cut: straight sweeps and level arcs, in
// the block's frame (mm from its lowest corner), with the parts of the tool that can meet the block.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/solid.h"

#include "kerf/simulate.h"
#include "kerf/tool.h"

namespace kerf::sim {

/// What is tested or taken away along a sweep, in this order.
enum PassBits : std::uint8_t {
  kPassCut = 1,        // the cutting part at feed
  kPassOverFlute = 2,  // is there material above the flutes? Takes nothing away
  kPassNeck = 4,
  kPassShank = 8,
  kPassHolder = 16,
  kPassRapid = 32,  // the cutting part at rapid speed; neck, shank and holder then count as the same hazard
  kPassSpindleOff = 64,  // with kPassCut: what is cut is cut by a spindle that stands still
};

/// A tool in pieces: the cutting part as it is, and all parts slightly shrunk for finding contacts.
struct ToolSolids {
  Solid cutting;
  Solid touching[4];  // cutting, neck, shank, holder, as ToolPart numbers them
  Solid over_flute;   // the cutting part's full width, from the flutes' end upwards
};

/// `side_clearance`: contacts that are less deep than this sideways are none.
ToolSolids make_tool_solids(const Silhouette& tool, Length side_clearance);

/// Largest error of chords that stand for helices, spirals, arcs in XZ and YZ and hollow profiles. Half of
/// the micron that columns may be off, so that a contact one micron deep is never made of chords alone.
inline constexpr double kChord = 0.0005;  // mm

struct Sweep {
  double x = 0.0, y = 0.0, z = 0.0;  // begin; of an arc the centre
  double ux = 1.0, uy = 0.0;  // direction in plan; of an arc the direction from the centre to the begin
  double length = 0.0;        // in plan; 0: straight up or down
  double z_end = 0.0;
  double radius = 0.0, turn = 0.0;             // of an arc; radians, positive counter-clockwise
  float share_begin = 0.0f, share_end = 1.0f;  // of the step's way
  std::uint32_t step = 0;
  std::uint32_t tool = 0;  // index of its ToolSolids
  std::uint8_t passes = 0;
  bool is_arc = false;
  bool follows = false;  // the sweep before it cut with the same tool and ended where this one begins

  double slope() const { return length > 0.0 ? (z_end - z) / length : 0.0; }
};

/// The first contact of one kind that a sweep makes in a tile, or of all tiles after merging.
struct Contact {
  std::uint32_t step = 0;
  HazardKind kind{};
  double share = 2.0;    // of the step's way, when the contact begins; above 1 while there is none
  Point3 at;             // block frame
  double depth = 0.0;    // mm
  double removed = 0.0;  // mm3
};

}  // namespace kerf::sim

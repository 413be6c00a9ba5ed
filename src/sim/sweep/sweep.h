// What the planner makes of the motions of a toolpath and the kernels cut: straight sweeps and level arcs, in
// the block's frame (mm from its lowest corner), with the parts of the tool that can meet the block.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/sweep/solid.h"

#include "kerf/hazard.h"
#include "kerf/tool.h"

namespace kerf::sim {

/// What is tested or taken away along a sweep, in this order.
enum PassBits : std::uint8_t {
  kPassCut = 1,        // the cutting part at feed
  kPassOverFlute = 2,  // what the cutting part's end meets above the flutes
  kPassNeck = 4,
  kPassShank = 8,
  kPassHolder = 16,
  kPassRapid = 32,       // the cutting part at rapid speed; neck, shank and holder then are the same hazard
  kPassSpindleOff = 64,  // with kPassCut: what is cut is cut by a spindle that stands still
};

/// A tool in pieces: the cutting part as it is, and all parts slightly shrunk for finding contacts.
struct ToolSolids {
  Solid cutting;
  Solid touching[4];  // cutting, neck, shank, holder, as ToolPart numbers them, see held()
  Solid over_flute;   // as wide as the tool is just above the flutes, from there upwards
};

/// `side_clearance`: contacts that are less deep than this sideways are none.
ToolSolids make_tool_solids(const Silhouette& tool, Length side_clearance);

/// How far chords stray from helices, spirals and arcs in XZ and YZ, mm: a tenth of the micron that surfaces
/// may be off, since a steep flank turns a path's error sideways into a larger one in height.
inline constexpr double kPathChord = 0.0001;
/// How far the frusta that stand for a hollow arc of a tool's profile stray from it, mm.
inline constexpr double kProfileChord = 0.0005;

struct Sweep {
  double x = 0.0, y = 0.0, z = 0.0;  // begin; of an arc the centre
  double ux = 1.0, uy = 0.0;  // direction in plan; of an arc the direction from the centre to the begin
  double length = 0.0;        // in plan; 0: straight up or down
  double z_end = 0.0;
  double slope = 0.0;  // of a line: rise a mm in plan; 0 for plunges
  float ball_lead =
      0.0f;  // slope / sqrt(1 + slope^2): how far behind its centre a ball cuts deepest, in radii
  double radius = 0.0, turn = 0.0;             // of an arc; radians, positive counter-clockwise
  float share_begin = 0.0f, share_end = 1.0f;  // of the step's way
  std::uint32_t step = 0;
  std::uint32_t tool = 0;  // index of its ToolSolids
  std::uint8_t passes = 0;
  bool is_arc = false;
  bool follows = false;  // the sweep before it cut with the same tool and ended where this one begins
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

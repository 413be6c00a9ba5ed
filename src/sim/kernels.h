// The inner loops: sweeps against the columns of one tile. Everything that is worth exchanging for speed is
// behind `cut_tile`; the planner and the bookkeeping around it know nothing of lanes.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/sweep.h"
#include "sim/tile.h"

namespace kerf::sim {

// Solids in single precision with what the kernels need squared.
struct LaneCap {
  CapCurve curve = CapCurve::flat;
  Real flat = 0, flat2 = 0, height = 0, slope = 0, centre_r = 0, centre_z = 0, radius2 = 0;
};
struct LanePiece {
  Real rim = 0, rim2 = 0;
  LaneCap lower, upper;
};
struct LaneSolid {
  explicit LaneSolid(const Solid& solid);

  std::vector<LanePiece> pieces;
  LanePiece lid;  // of one envelope: its flat top
  bool one_envelope = false;
  Real rim = 0, bottom = 0, top = 0;
  Real offset[kCullLines] = {}, slope[kCullLines] = {};
};
struct LaneTool {
  explicit LaneTool(const ToolSolids& tool);

  LaneSolid cutting;
  std::vector<LaneSolid> touching;  // cutting, neck, shank, holder
  LaneSolid over_flute;
};

/// What all tiles share.
struct Field {
  double pitch = 0.0;
  Real height = 0;       // of the block
  Real same_height = 0;  // see Workpiece::Body
  Real hazard_depth = 0;
  Real step[kTileColumns];  // i * pitch
};

/// The work on one tile: sweeps `list[0]` to `list[count - 1]` in time order.
struct TileJob {
  const Field* field = nullptr;
  Tile* tile = nullptr;
  double x = 0.0, y = 0.0;        // of the tile's first column, block frame
  const Real* share_x = nullptr;  // share of each column of the tile in the block, 64 each; null: all 1
  const Real* share_y = nullptr;
  const std::vector<LaneTool>* tools = nullptr;
  const Sweep* sweeps = nullptr;
  const std::uint32_t* list = nullptr;
  std::size_t count = 0;
  double* removed = nullptr;                 // out: length of column taken by each of the sweeps, mm
  std::vector<Contact>* contacts = nullptr;  // out, appended
};

void cut_tile(const TileJob& job);

}  // namespace kerf::sim

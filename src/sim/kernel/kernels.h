// The inner loops: sweeps against the columns of one tile. Everything that is worth exchanging for speed is
// behind `cut_tile`; the planner and the bookkeeping around it know nothing of lanes.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/dexel/tile.h"
#include "sim/sweep/sweep.h"

namespace kerf::sim {

// Solids in single precision with what the kernels need squared.
struct LaneCap {
  CapCurve curve = CapCurve::flat;
  Real flat = 0, flat2 = 0, height = 0, slope = 0, centre_r = 0, centre_z = 0, radius2 = 0;
};
struct LanePiece {
  Real rim = 0, rim2 = 0;
  LaneCap lower, upper;
  bool is_cylinder() const { return lower.curve == CapCurve::flat && upper.curve == CapCurve::flat; }
};
struct LaneSolid {
  explicit LaneSolid(const Solid& solid);

  std::vector<LanePiece> pieces;
  LanePiece lid;  // of one envelope: its flat top
  bool one_envelope = false;
  bool is_ball = false;       // of one envelope, which is half a ball and has the closed form
  bool is_cylinders = false;  // all pieces are
  bool is_flat = false;       // nothing of it is lower than its flat bottom, which reaches to its rim
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
/// Place of a column from its tile's first one where all are a pitch apart, to the bit as the kernels see it:
/// from the first column of its micro on.
inline Real even_place(const Field& field, int column) {
  return field.step[column / 4 * 4] + static_cast<Real>(column % 4) * field.step[1];
}

/// Sixteen points anywhere, which are a micro's columns then: places from the tile's first column, mm, and
/// how much what is taken of each counts.
struct PointMicro {
  Lanes x, y, weight;
};
/// A tile whose columns are points, with boxes around the micros and supers.
struct PointTile {
  struct Boxes {
    Lanes x, y, half_x, half_y;
  };
  std::vector<PointMicro> micros;  // kMicros at most; what is above is not to be cut
  Boxes around_micros[kSupers], around_supers;
};

/// The work on one tile: sweeps `list[0]` to `list[count - 1]` in time order.
struct TileJob {
  const Field* field = nullptr;
  Tile* tile = nullptr;
  double x = 0.0, y = 0.0;  // of the tile's first column, block frame
  // Of a tile with columns that are narrower, 64 each: places of the columns and their shares in the block.
  // Null in other tiles, whose columns are a pitch apart.
  const Real *place_x = nullptr, *place_y = nullptr;
  const Real *share_x = nullptr, *share_y = nullptr;
  const PointTile* points = nullptr;  // instead of places and shares: the columns are points
  const std::vector<LaneTool>* tools = nullptr;
  const Sweep* sweeps = nullptr;
  const std::uint32_t* list = nullptr;
  std::size_t count = 0;
  double* removed = nullptr;                 // out: length of column taken by each of the sweeps, mm
  std::vector<Contact>* contacts = nullptr;  // out, appended
};

void cut_tile(const TileJob& job);

/// Lengths of material of the columns of a tile and of a ring of micros around it.
inline constexpr int kRing = 4;
inline constexpr int kWindow = kTileColumns + 2 * kRing;
using WindowLengths = Real[kWindow][kWindow];

/// Which steps between neighbouring columns count, see walls.cpp.
struct StepRules {
  Real explained_by_lower = 0, explained_by_higher = 0, most_explained = 0;
  Real per_least = 0, per_least_level = 0;  // one divided by the least step that counts
  Real same_height = 0;
};
/// A step from the column at (x, y) of the window to the next one along X or Y, in least steps that count.
enum class StepWay : std::uint8_t { along_x, along_y };
struct ColumnStep {
  int x, y;
  StepWay way;
  Real excess;
};
/// Finds those that count, some of them twice: from columns and rows 1 before the tile's first to those 1
/// after its last.
void find_steps(const StepRules& rules, const WindowLengths& lengths, std::vector<ColumnStep>& out);

}  // namespace kerf::sim

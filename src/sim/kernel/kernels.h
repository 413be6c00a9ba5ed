// The inner loops: sweeps against the columns of one tile. All code that is optimised for speed is called
// through `cut_tile`; planner and bookkeeping do not depend on lanes.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/dexel/tile.h"
#include "sim/sweep/sweep.h"

namespace kerf::sim {

// Solids in single precision, with precomputed squares.
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
  LanePiece lid;  // flat top of a solid with one envelope
  bool one_envelope = false;
  bool is_ball = false;       // one envelope that is half a ball and has the closed form
  bool is_cylinders = false;  // all pieces are cylinders
  bool is_flat = false;       // no point is lower than its flat bottom, which extends to the rim
  Real rim = 0, bottom = 0, top = 0;
  Real offset[kCullLines] = {}, slope[kCullLines] = {};
};
struct LaneTool {
  explicit LaneTool(const ToolSolids& tool);

  LaneSolid cutting;
  std::vector<LaneSolid> touching;  // cutting, neck, shank, holder
  LaneSolid over_flute;
};

/// Data of all tiles.
struct Field {
  double pitch = 0.0;
  Real height = 0;       // of the block
  Real same_height = 0;  // see Workpiece::Body
  Real hazard_depth = 0;
  Real step[kTileColumns];  // i * pitch
};
/// Position of a column from its tile's first one if all are one pitch apart; bit for bit that of the
/// kernels, which start at the first column of the micro.
inline Real even_position(const Field& field, int column) {
  return field.step[column / 4 * 4] + static_cast<Real>(column % 4) * field.step[1];
}

/// Sixteen arbitrary points as the columns of a micro: positions from the tile's first column, mm, and
/// weights of the removed lengths.
struct PointMicro {
  Lanes x, y, weight;
};
/// A tile whose columns are points, with boxes around its micros and supers.
struct PointTile {
  struct Boxes {
    Lanes x, y, half_x, half_y;
  };
  std::vector<PointMicro> micros;  // at most kMicros; the others are empty
  Boxes around_micros[kSupers], around_supers;
};

/// A job for one tile: sweeps `list[0]` to `list[count - 1]` in time order.
struct TileJob {
  const Field* field = nullptr;
  Tile* tile = nullptr;
  double x = 0.0, y = 0.0;  // of the tile's first column, block frame
  // Of a tile with narrower columns, 64 each: positions of the columns and their fractions inside the block.
  // Null for other tiles, whose columns are one pitch apart.
  const Real *position_x = nullptr, *position_y = nullptr;
  const Real *fraction_x = nullptr, *fraction_y = nullptr;
  const PointTile* points = nullptr;  // instead of positions and fractions: the columns are points
  const std::vector<LaneTool>* tools = nullptr;
  const Sweep* sweeps = nullptr;
  const std::uint32_t* list = nullptr;
  std::size_t count = 0;
  double* removed = nullptr;                 // out: length of column removed by each of the sweeps, mm
  std::vector<Contact>* contacts = nullptr;  // out, appended
};

void cut_tile(const TileJob& job);

/// Lengths of material in the columns of a tile and of a ring of micros around it.
inline constexpr int kRing = 4;
inline constexpr int kWindow = kTileColumns + 2 * kRing;
using WindowLengths = Real[kWindow][kWindow];

/// Thresholds for steps between neighbouring columns, see walls.cpp.
struct StepRules {
  Real explained_by_lower = 0, explained_by_higher = 0, max_explained = 0;
  Real per_min = 0, per_min_level = 0;  // 1 / minimum step
  Real same_height = 0;
};
/// A step from the column at (x, y) of the window to the next one along X or Y, in units of the minimum step.
enum class StepAxis : std::uint8_t { along_x, along_y };
struct ColumnStep {
  int x, y;
  StepAxis axis;
  Real excess;
};
/// Finds the steps above the minimum, some of them twice, from one column and row before the tile's first to
/// one after its last.
void find_steps(const StepRules& rules, const WindowLengths& lengths, std::vector<ColumnStep>& out);

}  // namespace kerf::sim

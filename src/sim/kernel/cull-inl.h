// Culling: which of sixteen square blocks of columns a sweep can touch.
#if defined(KERF_SIM_CULL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef KERF_SIM_CULL_INL_H
#undef KERF_SIM_CULL_INL_H
#else
#define KERF_SIM_CULL_INL_H
#endif

#include <cmath>

#include "sim/kernel/shapes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {

// Column and row of the lanes in a 4 x 4 block.
inline constexpr Lanes kColumn = {{0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3}};
inline constexpr Lanes kRow = {{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3}};

/// Sixteen blocks of columns: their centres from the first column of the tile, and the half extents of their
/// columns.
struct Blocks {
  Vector x, y, half_x, half_y;
};
/// 4 x 4 blocks: the centre of the first, their distance, and the half extent of their columns.
HWY_INLINE Blocks square_of_blocks(Real x, Real y, Real step, Real half) {
  return {x + load(kColumn) * step, y + load(kRow) * step, half, half};
}
HWY_INLINE Blocks blocks_of(const PointTile::Boxes& boxes) {
  return {load(boxes.x), load(boxes.y), load(boxes.half_x), load(boxes.half_y)};
}
/// Maximum offset of columns from a grid of one pitch, in pitches: a narrower last column has its centre in
/// what is left of it.
HWY_INLINE Real farthest_shift(const TileJob& job) { return job.position_x != nullptr ? 0.5f : 0.0f; }
HWY_INLINE Blocks supers_of(const TileJob& job) {
  if (job.points != nullptr) return blocks_of(job.points->around_supers);
  const Real pitch = job.field->step[1];
  return square_of_blocks(7.5f * pitch, 7.5f * pitch, 16 * pitch, (7.5f + farthest_shift(job)) * pitch);
}
HWY_INLINE Blocks micros_of(const TileJob& job, int super) {
  const Field& field = *job.field;
  const Real pitch = field.step[1];
  if (job.points != nullptr) return blocks_of(job.points->around_micros[super]);
  return square_of_blocks(field.step[(super & 3) * 16] + 1.5f * pitch,
                          field.step[(super >> 2) * 16] + 1.5f * pitch, 4 * pitch,
                          (1.5f + farthest_shift(job)) * pitch);
}

/// The minimum squared distance in plan of the path from each block, and the range of heights of the tip
/// while the tool is over it.
struct Nearness {
  Vector distance2, z_low, z_high;
  Mask ahead;  // part of the block is not behind, see behind_of
};

HWY_INLINE Nearness near_line(const LocalSweep& w, const Blocks& b, Real rim) {
  const Real along = std::abs(w.cx), across = std::abs(w.cy);
  const Vector reach = b.half_x * along + b.half_y * across;
  const Vector x = w.x + b.x, y = w.y + b.y;
  const Vector u = x * w.cx + y * w.cy, v = y * w.cx - x * w.cy;
  const Vector du = higher_of(outside(u, w.t_low, w.t_high) - reach, 0);
  const Vector dv = higher_of(absolute(v) - (b.half_x * across + b.half_y * along), 0);
  Nearness n{du * du + dv * dv, w.z_low, w.z_high, u + reach > w.behind};
  if (w.slope != 0 && w.t_high - w.t_low > rim) {
    const Vector za = w.z + w.slope * clamped(u - reach - rim, w.t_low, w.t_high);
    const Vector zb = w.z + w.slope * clamped(u + reach + rim, w.t_low, w.t_high);
    n.z_low = lower_of(za, zb);
    n.z_high = higher_of(za, zb);
  }
  return n;
}

HWY_INLINE Nearness near_arc(const LocalSweep& w, const Blocks& b) {
  constexpr Real kDiagonal = 1.4142136f;
  const Vector x = w.x + b.x, y = w.y + b.y;
  const Vector dr =
      higher_of(absolute(root(x * x + y * y) - w.radius) - kDiagonal * higher_of(b.half_x, b.half_y), 0);
  const Vector dx = higher_of(outside(x, w.box_low_x, w.box_high_x) - b.half_x, 0);
  const Vector dy = higher_of(outside(y, w.box_low_y, w.box_high_y) - b.half_y, 0);
  return {higher_of(dr * dr, dx * dx + dy * dy), w.z_low, w.z_high, every_lane()};
}

/// Maximum number of pieces of a solid that are all tested.
inline constexpr std::size_t kFewPieces = 4;

/// Of a level line that follows another: blocks in which some piece can remove what it did not remove at the
/// start of the line. A cylinder removes nothing from a block that its disc at the start covers.
HWY_INLINE Mask not_yet_cut(const LocalSweep& w, const LaneSolid& solid, const Blocks& b, Vector distance2) {
  const Vector x = w.x + b.x - w.t_low * w.cx, y = w.y + b.y - w.t_low * w.cy;
  const Vector far2 = square(absolute(x) + b.half_x) + square(absolute(y) + b.half_y);
  Mask some = no_lane();
  for (const LanePiece& piece : solid.pieces) {
    const Mask near = distance2 < piece.rim2;
    some = some | (piece.is_cylinder() ? near & (far2 >= piece.rim2) : near);
  }
  return some;
}

/// Bits of the blocks that a solid can touch, given their highest and lowest material.
HWY_INLINE unsigned cull(const LocalSweep& w, const LaneSolid& solid, const Blocks& b, const Real* top,
                         const Real* bottom) {
  const Nearness n = w.is_arc ? near_arc(w, b) : near_line(w, b, solid.rim);
  Mask meets = n.ahead;
  if (solid.is_ball) {
    const Vector over = higher_of(n.z_low + solid.pieces[0].lower.centre_z - load(top),
                                  0);  // height of the ball's centre above the material
    meets = meets & (solid.pieces[0].lower.radius2 - n.distance2 > over * over);
  } else if (solid.is_flat) {
    meets = meets & (n.distance2 < solid.rim * solid.rim) & (n.z_low + solid.bottom < load(top)) &
            (n.z_high + solid.top > load(bottom));
  } else {
    const Vector distance = root(n.distance2);
    Vector under = solid.offset[0] + solid.slope[0] * distance;
    for (int k = 1; k < kCullLines; ++k)
      under = higher_of(under, solid.offset[k] + solid.slope[k] * distance);
    meets = meets & (distance < solid.rim) & (n.z_low + under < load(top)) &
            (n.z_high + solid.top > load(bottom));
  }
  if (w.level_follow && solid.pieces.size() <= kFewPieces)
    meets = meets & not_yet_cut(w, solid, b, n.distance2);
  return bits_of(meets);
}

}  // namespace kerf::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

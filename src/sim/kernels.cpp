// Sweeps against columns, 16 at a time.
//
// A tile sees a sweep in its own frame: the origin lies on the path near the tile, so that single precision
// is good for a hundredth of a micron on a stock of any size.
#include "sim/kernels.h"

#include <algorithm>
#include <cmath>

#include "sim/vector.h"

// Where the compiler can, the kernels are made for newer processors too and chosen when the program starts.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define KERF_KERNEL __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4"), flatten))
#else
#define KERF_KERNEL
#endif

namespace kerf::sim {
namespace {

/// Steps of the safeguarded Newton search for the lowest point of a swept torus.
constexpr int kSearchSteps = 14;

// Places of the lanes in a 4 x 4 block.
constexpr Vector kColumn = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
constexpr Vector kRow = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

inline Real lower_real(Real a, Real b) { return a < b ? a : b; }
inline Real higher_real(Real a, Real b) { return a > b ? a : b; }

LaneCap lane_cap(const Cap& cap) {
  const auto real = [](double v) { return static_cast<Real>(v); };
  return {cap.curve,       real(cap.flat),     real(cap.flat * cap.flat), real(cap.height),
          real(cap.slope), real(cap.centre_r), real(cap.centre_z),        real(cap.radius * cap.radius)};
}

// ---- a sweep seen from a tile

/// A sweep in the frame of a tile's work, see the top of this file. `slope` is 0 for level sweeps and
/// plunges, which then lie between z_low and z_high; lines that are neither have z at the origin.
struct View {
  bool is_arc = false;
  Real x = 0, y = 0;           // of the tile's first column
  Real cx = 1, cy = 0;         // direction of a line in plan
  Real t_low = 0, t_high = 0;  // its extent along that direction
  Real slope = 0, z = 0;
  Real ball_lead = 0;          // slope / sqrt(1 + slope^2)
  Real z_low = 0, z_high = 0;  // of the whole sweep
  bool level_follow = false;   // a level line that begins where the sweep before has ended
  Real behind = -kFar;         // what lies before this along a line was cut by the sweep before
  Real box_low_x = 0, box_high_x = 0, box_low_y = 0, box_high_y = 0;  // of the path in plan
  Real radius = 0;                                                    // of an arc, whose centre is the origin
  Real begin_x = 0, begin_y = 0, end_x = 0, end_y = 0;                // its ends
  bool wide = false, full = false;                                    // it turns more than half, all the way
};

View view_of_line(const Sweep& s, const TileJob& job, double half_tile) {
  View w;
  const double to_x = job.x + half_tile - s.x, to_y = job.y + half_tile - s.y;
  const double t = std::clamp(to_x * s.ux + to_y * s.uy, 0.0, s.length);
  const double ox = s.x + t * s.ux, oy = s.y + t * s.uy;
  const double slope = s.slope();
  w.x = static_cast<Real>(job.x - ox);
  w.y = static_cast<Real>(job.y - oy);
  w.cx = static_cast<Real>(s.ux);
  w.cy = static_cast<Real>(s.uy);
  w.t_low = static_cast<Real>(-t);
  w.t_high = static_cast<Real>(s.length - t);
  w.slope = static_cast<Real>(slope);
  w.z = static_cast<Real>(s.z + slope * t);
  w.ball_lead = static_cast<Real>(slope / std::sqrt(1.0 + slope * slope));
  const Real ax = w.t_low * w.cx, bx = w.t_high * w.cx, ay = w.t_low * w.cy, by = w.t_high * w.cy;
  w.box_low_x = lower_real(ax, bx);
  w.box_high_x = higher_real(ax, bx);
  w.box_low_y = lower_real(ay, by);
  w.box_high_y = higher_real(ay, by);
  return w;
}

View view_of_arc(const Sweep& s, const TileJob& job) {
  View w;
  w.is_arc = true;
  w.x = static_cast<Real>(job.x - s.x);
  w.y = static_cast<Real>(job.y - s.y);
  w.radius = static_cast<Real>(s.radius);
  const double c = std::cos(s.turn), d = std::sin(s.turn);
  const double ex = s.ux * c - s.uy * d, ey = s.ux * d + s.uy * c;
  const bool ccw = s.turn > 0.0;  // a clockwise arc is the counter-clockwise one from its end to its begin
  w.begin_x = static_cast<Real>(s.radius * (ccw ? s.ux : ex));
  w.begin_y = static_cast<Real>(s.radius * (ccw ? s.uy : ey));
  w.end_x = static_cast<Real>(s.radius * (ccw ? ex : s.ux));
  w.end_y = static_cast<Real>(s.radius * (ccw ? ey : s.uy));
  constexpr double kHalfTurn = 3.14159265358979323846;
  w.wide = std::abs(s.turn) > kHalfTurn;
  w.full = std::abs(s.turn) >= 2.0 * kHalfTurn - 1e-9;
  ArcWalk walk;
  walk.start_radius = walk.end_radius = s.radius;
  walk.start_angle = std::atan2(s.uy, s.ux);
  walk.sweep = s.turn;
  const Box3 box = walk.bounds();
  w.box_low_x = static_cast<Real>(box.low.x);
  w.box_high_x = static_cast<Real>(box.high.x);
  w.box_low_y = static_cast<Real>(box.low.y);
  w.box_high_y = static_cast<Real>(box.high.y);
  return w;
}

View view_of(const Sweep& s, const TileJob& job) {
  View w = s.is_arc ? view_of_arc(s, job) : view_of_line(s, job, 31.5 * job.field->pitch);
  w.z_low = static_cast<Real>(std::min(s.z, s.z_end));
  w.z_high = static_cast<Real>(std::max(s.z, s.z_end));
  return w;
}

/// What a cut that follows another need not cut again: all that lies so far back that the lowest point above
/// it is the begin, where the sweep before has ended. For solids with undercuts that holds in level sweeps
/// only.
Real behind_of(const View& w, const Sweep& s, const LaneSolid& solid, bool open) {
  if (!s.follows || w.is_arc || s.length == 0.0) return -kFar;
  if (w.slope == 0) return w.t_low;
  if (!solid.one_envelope || !open) return -kFar;
  if (w.slope > 0) return w.t_low;
  const bool is_ball = solid.pieces.size() == 1 && solid.pieces[0].lower.curve == CapCurve::ball;
  return w.t_low + w.ball_lead * (is_ball ? std::sqrt(solid.pieces[0].lower.radius2) : kFar);
}

// ---- culling

/// Sixteen square blocks of columns: their centres, half the reach of their columns.
struct Blocks {
  Vector x, y, half;
};
/// Blocks in 4 rows of 4: the centre of the first, their distance, half the reach of their columns.
KERF_LANES Blocks square_of_blocks(Real x, Real y, Real step, Real half) {
  return {x + kColumn * step, y + kRow * step, all(half)};
}

/// How far the path is from the blocks at least, in plan, and the heights of the tip while the tool is over
/// them.
struct Nearness {
  Vector distance, z_low, z_high;
  Mask ahead;  // not all of the block is behind, see behind_of
};

KERF_LANES Vector outside(Vector v, Real low, Real high) { return higher_of(low - v, v - high); }

KERF_LANES Nearness near_line(const View& w, const Blocks& b, Real rim) {
  const Vector reach = b.half * (std::abs(w.cx) + std::abs(w.cy));
  const Vector x = b.x, y = b.y;
  const Vector u = x * w.cx + y * w.cy, v = y * w.cx - x * w.cy;
  const Vector du = higher_of(outside(u, w.t_low, w.t_high) - reach, Vector{});
  const Vector dv = higher_of(absolute(v) - reach, Vector{});
  const Vector dx = higher_of(outside(x, w.box_low_x, w.box_high_x) - b.half, Vector{});
  const Vector dy = higher_of(outside(y, w.box_low_y, w.box_high_y) - b.half, Vector{});
  Nearness n;
  n.distance = root(higher_of(du * du + dv * dv, dx * dx + dy * dy));
  n.ahead = u + reach > w.behind;
  n.z_low = all(w.z_low);
  n.z_high = all(w.z_high);
  if (w.slope != 0) {
    const Vector za = w.z + w.slope * clamped(u - reach - rim, all(w.t_low), all(w.t_high));
    const Vector zb = w.z + w.slope * clamped(u + reach + rim, all(w.t_low), all(w.t_high));
    n.z_low = lower_of(za, zb);
    n.z_high = higher_of(za, zb);
  }
  return n;
}

KERF_LANES Nearness near_arc(const View& w, const Blocks& b) {
  constexpr Real kDiagonal = 1.4142136f;
  const Vector x = b.x, y = b.y;
  const Vector dr = higher_of(absolute(root(x * x + y * y) - w.radius) - kDiagonal * b.half, Vector{});
  const Vector dx = higher_of(outside(x, w.box_low_x, w.box_high_x) - b.half, Vector{});
  const Vector dy = higher_of(outside(y, w.box_low_y, w.box_high_y) - b.half, Vector{});
  return {root(higher_of(dr * dr, dx * dx + dy * dy)), all(w.z_low), all(w.z_high), ~Mask{}};
}

/// Most pieces for which `new_ground` is worth its time.
constexpr std::size_t kFewPieces = 4;

/// Of a level line that follows another: blocks in which some piece takes what it did not take at the line's
/// begin. A cylinder takes nothing new from a block that its first disc covers.
KERF_LANES Mask new_ground(const View& w, const LaneSolid& solid, const Blocks& b, Vector distance) {
  const Vector x = b.x - w.t_low * w.cx, y = b.y - w.t_low * w.cy;
  const Vector far2 = square(absolute(x) + b.half) + square(absolute(y) + b.half);
  Mask any{};
  for (const LanePiece& piece : solid.pieces) {
    const bool cylinder = piece.lower.curve == CapCurve::flat && piece.upper.curve == CapCurve::flat;
    any |= (distance < piece.rim) & (cylinder ? far2 >= piece.rim2 : ~Mask{});
  }
  return any;
}

/// Bits of the blocks that a solid can meet, given the blocks' highest and lowest material.
KERF_LANES int cull(const View& w, const LaneSolid& solid, const Blocks& b, const Real* top,
                    const Real* bottom) {
  const Nearness n = w.is_arc ? near_arc(w, b) : near_line(w, b, solid.rim);
  Vector under = solid.offset[0] + solid.slope[0] * n.distance;
  for (int k = 1; k < kCullLines; ++k)
    under = higher_of(under, solid.offset[k] + solid.slope[k] * n.distance);
  Mask meets = (n.distance < solid.rim) & (n.z_low + under < load(top)) &
               (n.z_high + solid.top > load(bottom)) & n.ahead;
  if (w.level_follow && solid.pieces.size() <= kFewPieces) meets &= new_ground(w, solid, b, n.distance);
  return bits_of(meets);
}

// ---- a convex piece swept: the lowest point of its underside above (or below) each column

/// The columns of a micro as a sweep's frame sees them.
struct MicroView {
  Vector x, y;  // place
  Vector u,
      v2;  // along the line and squared across it; of level sweeps u is not set and v2 the squared distance
};

/// Squared distance of each column from a line's or an arc's path in plan.
KERF_LANES Vector path_distance2(const View& w, Vector x, Vector y) {
  if (!w.is_arc) {
    const Vector u = x * w.cx + y * w.cy, v = y * w.cx - x * w.cy;
    return square(higher_of(outside(u, w.t_low, w.t_high), Vector{})) + v * v;
  }
  const Mask after_begin = w.begin_x * y - w.begin_y * x >= 0;
  const Mask before_end = x * w.end_y - y * w.end_x >= 0;
  const Mask inside = w.full ? ~Mask{} : w.wide ? (after_begin | before_end) : (after_begin & before_end);
  const Vector off = root(x * x + y * y) - w.radius;
  const Vector to_begin = square(x - w.begin_x) + square(y - w.begin_y);
  const Vector to_end = square(x - w.end_x) + square(y - w.end_y);
  return inside ? off * off : lower_of(to_begin, to_end);
}

/// Underside of a piece at a squared distance from its axis; kFar beyond the rim.
KERF_LANES Vector level_cap(const LaneCap& c, Real rim2, Vector distance2) {
  Vector low = all(c.height);
  switch (c.curve) {
    case CapCurve::flat: break;
    case CapCurve::cone: low = c.height + c.slope * higher_of(root(distance2) - c.flat, Vector{}); break;
    case CapCurve::ball: low = higher_of(c.centre_z - root(c.radius2 - distance2), low); break;
    case CapCurve::torus: {
      const Vector out = higher_of(root(distance2) - c.centre_r, Vector{});
      low = higher_of(c.centre_z - root(c.radius2 - out * out), low);
      break;
    }
  }
  return distance2 < rim2 ? low : all(kFar);
}

/// A ball that is not cut short by its rim: the closed form needs nothing else.
KERF_LANES Vector sloped_ball(const LaneCap& c, const View& w, Real slope, Real lead, Vector u, Vector v2) {
  const Vector across = c.radius2 - v2;
  const Vector t = clamped(u - lead * root(across), all(w.t_low), all(w.t_high));
  const Vector rest = across - square(u - t);
  return rest > 0 ? slope * t + c.centre_z - root(rest) : all(kFar);
}

/// The part of the path from which a rim reaches a column.
struct Reach {
  Vector begin, end;
  Mask any;
};
KERF_LANES Reach reach_of(Real rim2, const View& w, Vector u, Vector v2) {
  const Vector reach = root(rim2 - v2);
  const Vector begin = higher_of(u - reach, all(w.t_low)), end = lower_of(u + reach, all(w.t_high));
  return {begin, end, (v2 < rim2) & (begin <= end)};
}

/// The lowest point, where `best` is the place along the path at which the curve beyond the flat is lowest.
template <class Curve>
KERF_LANES Vector sloped_curve(const LaneCap& c, Real rim2, const View& w, Real slope, Vector u, Vector v2,
                               Vector best, const Curve& curve) {
  const Reach reach = reach_of(rim2, w, u, v2);
  const Vector t = clamped(best, reach.begin, reach.end);
  const Vector rho2 = v2 + square(u - t);
  Vector low = slope * t + curve(rho2);
  if (c.flat2 > 0) {  // above the flat the solid is a disc, lowest where it goes furthest down the slope
    const Vector half = root(c.flat2 - v2);
    const Vector t_flat = slope > 0 ? higher_of(u - half, all(w.t_low)) : lower_of(u + half, all(w.t_high));
    low = rho2 < c.flat2 ? slope * t_flat + c.height : low;
  }
  return reach.any ? low : all(kFar);
}

KERF_LANES Vector sloped_cone(const LaneCap& c, Real rim2, const View& w, Real slope, Vector u, Vector v2) {
  // The cone is lowest where its flank falls as fast as the path rises; steeper paths go to the end of the
  // reach.
  const Real rest = c.slope * c.slope - slope * slope;
  Vector best = all(slope > 0 ? -kFar : kFar);
  if (rest > 0) best = u - slope / std::sqrt(rest) * root(v2);
  return sloped_curve(c, rim2, w, slope, u, v2, best,
                      [&](Vector rho2) { return c.height + c.slope * (root(rho2) - c.flat); });
}

/// Where a torus is lowest: the zero of the derivative, which rises along the path, by Newton's steps inside
/// a bracket.
KERF_LANES Vector torus_best(const LaneCap& c, Real rim2, const View& w, Real slope, Vector u, Vector v2) {
  const Vector tiny = all(1e-12f);
  const Reach reach = reach_of(rim2, w, u, v2);
  Vector low = reach.begin, high = higher_of(reach.end, low), best = clamped(u, low, high);
  for (int n = 0; n < kSearchSteps; ++n) {
    const Vector p = best - u;
    const Vector rho = root(higher_of(v2 + p * p, tiny));
    const Vector out = higher_of(rho - c.centre_r, Vector{});
    const Vector down = root(higher_of(c.radius2 - out * out, tiny));
    const Vector rise = out / down, along = p / rho;
    const Vector bend = out > 0 ? c.radius2 / (down * down * down) : Vector{};
    const Vector first = slope + rise * along;
    const Vector second = bend * along * along + rise * v2 / (rho * rho * rho);
    high = first > 0 ? best : high;
    low = first > 0 ? low : best;
    const Vector next = best - first / higher_of(second, tiny);
    best = ((next > low) & (next < high)) ? next : 0.5f * (low + high);
  }
  return best;
}

/// Lowest point above each column, relative to z at the frame's origin, of an underside swept along a line of
/// `slope` (the view's, or that with the sign changed for an upper side); kFar where the sweep does not pass.
KERF_LANES Vector sloped_cap(const LanePiece& piece, const LaneCap& c, const View& w, Real slope, Vector u,
                             Vector v2) {
  const Real lead = slope == w.slope ? w.ball_lead : -w.ball_lead;
  switch (c.curve) {
    case CapCurve::flat: {
      const Reach reach = reach_of(piece.rim2, w, u, v2);
      return reach.any ? slope * (slope > 0 ? reach.begin : reach.end) + c.height : all(kFar);
    }
    case CapCurve::cone: return sloped_cone(c, piece.rim2, w, slope, u, v2);
    case CapCurve::ball:
      if (c.flat == 0 && piece.rim2 >= c.radius2) return sloped_ball(c, w, slope, lead, u, v2);
      return sloped_curve(c, piece.rim2, w, slope, u, v2, u - lead * root(c.radius2 - v2),
                          [&](Vector rho2) { return c.centre_z - root(c.radius2 - rho2); });
    case CapCurve::torus: break;
  }
  return sloped_curve(
      c, piece.rim2, w, slope, u, v2, torus_best(c, piece.rim2, w, slope, u, v2), [&](Vector rho2) {
        return c.centre_z - root(c.radius2 - square(higher_of(root(rho2) - c.centre_r, Vector{})));
      });
}

/// Where the 16 points of a column stand, see PointPlaces.
KERF_LANES Vector points_along(const Real* at, Real shift, Real middle, Real size) {
  const Vector share = load(at) + shift;
  return middle + ((share >= 1 ? share - 1 : share) - 0.5f) * size;
}

KERF_LANES MicroView look_at(const View& w, const TileJob& job, int micro) {
  const Field& field = *job.field;
  const int super = micro / kSupers, inner = micro % kSupers;
  const int column = (super & 3) * 16 + (inner & 3) * 4, row = (super >> 2) * 16 + (inner >> 2) * 4;
  MicroView m;
  if (job.place_x != nullptr && job.points == nullptr) {
    for (int i = 0; i < kLanes; ++i) {
      m.x[i] = w.x + job.place_x[column + i % 4];
      m.y[i] = w.y + job.place_y[row + i / 4];
    }
  } else if (const PointPlaces* p = job.points) {
    m.x = w.x + points_along(kPointsX.v, p->shift_x[micro], p->x[micro], p->size_x[micro]);
    m.y = w.y + points_along(kPointsY.v, p->shift_y[micro], p->y[micro], p->size_y[micro]);
  } else {
    m.x = w.x + field.step[column] + kColumn * field.step[1];
    m.y = w.y + field.step[row] + kRow * field.step[1];
  }
  if (w.slope == 0) {
    m.u = Vector{};
    m.v2 = path_distance2(w, m.x, m.y);
  } else {
    m.u = m.x * w.cx + m.y * w.cy;
    m.v2 = square(m.y * w.cx - m.x * w.cy);
  }
  return m;
}

KERF_LANES Vector swept_low(const LanePiece& piece, const View& w, const MicroView& m) {
  if (w.slope == 0) return w.z_low + level_cap(piece.lower, piece.rim2, m.v2);
  return w.z + sloped_cap(piece, piece.lower, w, w.slope, m.u, m.v2);
}

KERF_LANES Vector swept_high(const LanePiece& piece, const View& w, const MicroView& m) {
  if (w.slope == 0) return w.z_high - level_cap(piece.upper, piece.rim2, m.v2);
  return w.z - sloped_cap(piece, piece.upper, w, -w.slope, m.u, m.v2);
}

/// Lower end of interval number `group` that a solid sweeps: of one envelope there is one, else one a piece.
KERF_LANES Vector group_low(const LaneSolid& solid, std::size_t group, const View& w, const MicroView& m) {
  Vector low = swept_low(solid.pieces[group], w, m);
  if (solid.one_envelope)
    for (std::size_t k = 1; k < solid.pieces.size(); ++k)
      low = lower_of(low, swept_low(solid.pieces[k], w, m));
  return low;
}

KERF_LANES Vector group_high(const LaneSolid& solid, std::size_t group, const View& w, const MicroView& m) {
  return swept_high(solid.one_envelope ? solid.lid : solid.pieces[group], w, m);
}

// ---- taking material away

/// Takes all above `low` from columns that stand on the floor. Returns the length taken, weighted.
KERF_LANES Real take_open(Tile& tile, int micro, Vector low, std::uint32_t step, Vector weight, Real same) {
  const Vector old = load(tile.top[micro]);
  const Vector left = low < same ? Vector{} : low;
  const Mask cut = left + same < old;
  const Vector now = cut ? left : old;
  store(now, tile.top[micro]);
  store_ids(cut ? Ids{} + step : load_ids(tile.top_step[micro]), tile.top_step[micro]);
  tile.micro_top[micro] = highest_of(now);
  return sum_of((old - now) * weight);
}

/// One interval of 16 columns less [low, high]; columns where that leaves two intervals are returned as bits,
/// and the caller stores what is above the gap.
KERF_LANES int take_from_slot(Slot& slot, Vector low, Vector high, std::uint32_t step, Real same,
                              Vector& taken) {
  const Vector l = load(slot.low), h = load(slot.high);
  const Vector a = higher_of(low, l), b = lower_of(high, h);
  const Mask bottom = a <= l + same, top = b + same >= h;
  const Mask meets = (b > a) & ((b - a > same) | (bottom & top));
  const Mask all_of_it = meets & bottom & top;
  const Mask from_below = meets & bottom & ~top, with_new_top = meets & ~bottom;
  store(all_of_it ? all(kFar) : from_below ? b : l, slot.low);
  store(all_of_it ? all(-kFar) : with_new_top ? a : h, slot.high);
  store_ids(from_below ? Ids{} + step : load_ids(slot.low_step), slot.low_step);
  // Of an interval that ends here too: Tile::cut_through reads it.
  store_ids((with_new_top | all_of_it) ? Ids{} + step : load_ids(slot.high_step), slot.high_step);
  taken += all_of_it ? h - l : meets ? b - a : Vector{};
  return bits_of(meets & ~bottom & ~top);
}

struct Remnant {
  int lane;
  Real low, high;
  std::uint32_t high_step;
};

[[gnu::noinline]] void store_remnant(Tile& tile, int micro, const Remnant& rest, std::uint32_t step) {
  Slot* free = nullptr;
  for (std::int32_t k = tile.chain[micro]; k >= 0 && free == nullptr;
       k = tile.slots[static_cast<std::size_t>(k)].next) {
    Slot& slot = tile.slots[static_cast<std::size_t>(k)];
    if (slot.low[rest.lane] > slot.high[rest.lane]) free = &slot;
  }
  if (free == nullptr) free = &tile.add_slot(micro);
  free->low[rest.lane] = rest.low;
  free->high[rest.lane] = rest.high;
  free->low_step[rest.lane] = step;
  free->high_step[rest.lane] = rest.high_step;
}

/// Finds the highest and lowest material of a micro with a chain again.
KERF_LANES void update_bounds(Tile& tile, int micro) {
  Vector high = all(-kFar), low = all(kFar);
  for (std::int32_t k = tile.chain[micro]; k >= 0; k = tile.slots[static_cast<std::size_t>(k)].next) {
    high = higher_of(high, load(tile.slots[static_cast<std::size_t>(k)].high));
    low = lower_of(low, load(tile.slots[static_cast<std::size_t>(k)].low));
  }
  tile.micro_top[micro] = highest_of(high);
  tile.micro_bottom[micro] = lowest_of(low);
}

/// Takes [low, high] from a micro with a chain.
KERF_LANES Real take_from_chain(Tile& tile, int micro, Vector low, Vector high, std::uint32_t step,
                                Vector weight, Real same) {
  Vector taken{};
  Remnant rests[kLanes];
  int count = 0;
  for (std::int32_t k = tile.chain[micro]; k >= 0;) {
    Slot& slot = tile.slots[static_cast<std::size_t>(k)];
    const Vector old_high = load(slot.high);
    const Ids old_step = load_ids(slot.high_step);
    // The intervals of a column do not overlap, so at most one of them is split.
    for (int split = take_from_slot(slot, low, high, step, same, taken); split != 0; split &= split - 1) {
      const int i = __builtin_ctz(static_cast<unsigned>(split));
      rests[count++] = {i, high[i], old_high[i], old_step[i]};
    }
    k = slot.next;
  }
  if (bits_of(taken > 0) == 0) return 0;
  for (int n = 0; n < count; ++n) store_remnant(tile, micro, rests[n], step);
  update_bounds(tile, micro);
  return sum_of(taken * weight);
}

KERF_LANES Real take(Tile& tile, int micro, Vector low, Vector high, std::uint32_t step, Vector weight,
                     Real same) {
  const Mask any = (low < high) & (low < tile.micro_top[micro]) & (high > tile.micro_bottom[micro]);
  if (bits_of(any) == 0) return 0;
  if (tile.chain[micro] < 0) {
    const Vector top = load(tile.top[micro]);
    const Mask meets = (low < top) & (high > same);
    if (bits_of(meets) == 0) return 0;
    if (bits_of(meets & (high + same < top)) == 0)
      return take_open(tile, micro, high > same ? low : all(kFar), step, weight, same);
    tile.make_chain(micro);
  }
  return take_from_chain(tile, micro, low, high, step, weight, same);
}

// ---- contacts

/// A pass over a tile: one solid, and what its meeting material means.
struct Pass {
  const LaneSolid* solid = nullptr;
  bool is_hazard = false;
  HazardKind kind{};
  bool takes = true;
  Real ignore = 0;        // contacts up to this length are left alone
  Real report_above = 0;  // a depth
};

/// Share of the step's way at which a contact of the column begins. In plan exact for the rim; a plunge is
/// met at the height where the contact is.
double begin_of_contact(const Sweep& s, const View& w, const MicroView& m, int lane, Real rim, Real low,
                        Real high) {
  double share = 0.0;
  if (s.is_arc) {
    const auto x = static_cast<double>(m.x[lane]), y = static_cast<double>(m.y[lane]);
    const double angle = std::atan2(s.ux * y - s.uy * x, s.ux * x + s.uy * y);
    constexpr double kTurn = 6.283185307179586;
    double ahead = s.turn > 0.0 ? angle : -angle;
    const double lead =
        std::min(3.0, static_cast<double>(rim) / s.radius);  // the rim comes before the centre
    if (ahead < 0.0 && ahead + kTurn - lead < std::abs(s.turn)) ahead += kTurn;
    share = (ahead - lead) / std::abs(s.turn);
  } else if (s.length > 0.0) {
    const Real u = m.x[lane] * w.cx + m.y[lane] * w.cy, v = m.y[lane] * w.cx - m.x[lane] * w.cy;
    share = static_cast<double>(u - std::sqrt(higher_real(rim * rim - v * v, 0)) - w.t_low) / s.length;
  } else if (s.z >
             s.z_end) {  // the tip's height above the lowest it reaches in this column is the same everywhere
    share = (s.z - (s.z_end + static_cast<double>(high - low))) / (s.z - s.z_end);
  }
  share = std::clamp(share, 0.0, 1.0);
  const auto begin = static_cast<double>(s.share_begin), end = static_cast<double>(s.share_end);
  return begin + share * (end - begin);
}

double place_of(const Real* places, int column, const TileJob& job) {
  return places == nullptr ? column * job.field->pitch : static_cast<double>(places[column]);
}

/// Notes what [low, high] meets in a column; returns whether that is more than is ignored.
bool note_contact(const TileJob& job, const Sweep& s, const View& w, const MicroView& m, const Pass& pass,
                  int micro, int lane, Real low, Real high, double weight, Contact& contact) {
  std::vector<Interval> column;
  job.tile->intervals(micro * kLanes + lane, column);
  bool any = false;
  for (const Interval& run : column) {
    const Real a = higher_real(low, run.low), b = lower_real(high, run.high);
    if (!(b - a > pass.ignore)) continue;
    any = true;
    contact.removed += static_cast<double>(b - a) * weight;
    contact.depth = std::max(contact.depth, static_cast<double>(run.high - a));
    const double share = begin_of_contact(s, w, m, lane, pass.solid->rim, low, b);
    if (share >= contact.share) continue;
    contact.share = share;
    const int super = micro / kSupers, inner = micro % kSupers;
    const int column_x = (super & 3) * 16 + (inner & 3) * 4 + lane % 4;
    const int column_y = (super >> 2) * 16 + (inner >> 2) * 4 + lane / 4;
    contact.at = {job.x + place_of(job.place_x, column_x, job), job.y + place_of(job.place_y, column_y, job),
                  static_cast<double>(a)};
  }
  return any;
}

/// Notes the contacts of a micro and leaves in `low` and `high` only the columns with one.
[[gnu::noinline]] void note_contacts(const TileJob& job, const Sweep& s, const View& w, const MicroView& m,
                                     const Pass& pass, int micro, const Vector& weight, Vector& low,
                                     Vector& high, Contact& contact) {
  for (int i = 0; i < kLanes; ++i) {
    const bool meets =
        low[i] < high[i] && low[i] < job.tile->micro_top[micro] &&
        note_contact(job, s, w, m, pass, micro, i, low[i], high[i], static_cast<double>(weight[i]), contact);
    if (meets || (pass.takes && pass.ignore == 0)) continue;
    low[i] = kFar;
    high[i] = -kFar;
  }
}

// ---- passes

/// One sweep on one tile.
struct Work {
  const TileJob& job;
  const Sweep& sweep;
  View view;
  std::uint32_t step;
  double taken = 0.0;
};

KERF_LANES Vector weights_of(const TileJob& job, int micro) {
  if (job.weights != nullptr) return load(job.weights + micro * kLanes);
  if (job.share_x == nullptr) return all(1);
  const int super = micro / kSupers, inner = micro % kSupers;
  const Real* x = job.share_x + (super & 3) * 16 + (inner & 3) * 4;
  const Real* y = job.share_y + (super >> 2) * 16 + (inner >> 2) * 4;
  Vector weight;
  for (int i = 0; i < kLanes; ++i) weight[i] = x[i % 4] * y[i / 4];
  return weight;
}

KERF_LANES void cut_micro(Work& work, const Pass& pass, bool open, int micro, Contact& contact) {
  const TileJob& job = work.job;
  const Field& field = *job.field;
  const LaneSolid& solid = *pass.solid;
  Tile& tile = *job.tile;
  const MicroView m = look_at(work.view, job, micro);
  const Vector weight = weights_of(job, micro);
  const std::size_t groups = solid.one_envelope ? 1 : solid.pieces.size();
  for (std::size_t g = 0; g < groups; ++g) {
    Vector low = group_low(solid, g, work.view, m);
    Vector high = all(field.height + 1);
    if (open && solid.one_envelope) {
      if (!pass.is_hazard && tile.chain[micro] < 0) {
        work.taken += static_cast<double>(take_open(tile, micro, low, work.step, weight, field.same_height));
        continue;
      }
    } else {
      high = group_high(solid, g, work.view, m);
    }
    if (pass.is_hazard) note_contacts(job, work.sweep, work.view, m, pass, micro, weight, low, high, contact);
    if (pass.takes)
      work.taken += static_cast<double>(take(tile, micro, low, high, work.step, weight, field.same_height));
  }
}

KERF_LANES void cut_super(Work& work, const Pass& pass, bool open, int super, Contact& contact) {
  const View& w = work.view;
  const Field& field = *work.job.field;
  Tile& tile = *work.job.tile;
  const Real pitch = field.step[1];
  Real* top = tile.micro_top + super * kSupers;
  Real* bottom = tile.micro_bottom + super * kSupers;
  const PointPlaces* points = work.job.points;
  const Blocks micros =
      points == nullptr
          ? square_of_blocks(w.x + field.step[(super & 3) * 16] + 1.5f * pitch,
                             w.y + field.step[(super >> 2) * 16] + 1.5f * pitch, 4 * pitch, 1.5f * pitch)
          : Blocks{w.x + load(points->x + super * kSupers), w.y + load(points->y + super * kSupers),
                   all(0.5f * pitch)};
  int bits = cull(w, *pass.solid, micros, top, bottom);
  if (bits == 0) return;
  for (; bits != 0; bits &= bits - 1)
    cut_micro(work, pass, open, super * kSupers + __builtin_ctz(static_cast<unsigned>(bits)), contact);
  tile.super_top[super] = highest_of(load(top));
  tile.super_bottom[super] = lowest_of(load(bottom));
}

KERF_LANES void run_pass(Work& work, const Pass& pass, Contact& contact) {
  const LaneSolid& solid = *pass.solid;
  if (solid.pieces.empty()) return;
  const Field& field = *work.job.field;
  const Tile& tile = *work.job.tile;
  View& w = work.view;
  const bool open = w.z_low + solid.top >= field.height;
  w.behind = pass.is_hazard ? -kFar : behind_of(w, work.sweep, solid, open);
  w.level_follow =
      !pass.is_hazard && work.sweep.follows && !w.is_arc && work.sweep.length > 0.0 && w.slope == 0;
  const Real pitch = field.step[1];
  const PointPlaces* points = work.job.points;
  const Blocks supers =
      points == nullptr
          ? square_of_blocks(w.x + 7.5f * pitch, w.y + 7.5f * pitch, 16 * pitch, 7.5f * pitch)
          : Blocks{w.x + load(points->super_x), w.y + load(points->super_y), load(points->super_half)};
  for (int bits = cull(w, solid, supers, tile.super_top, tile.super_bottom); bits != 0; bits &= bits - 1)
    cut_super(work, pass, open, __builtin_ctz(static_cast<unsigned>(bits)), contact);
}

/// Keeps what a pass whose meeting material is a hazard has found, if anything.
[[gnu::noinline]] void keep_contact(const TileJob& job, const Pass& pass, Contact& contact) {
  if (contact.share > 1.0 || contact.depth <= static_cast<double>(pass.report_above)) return;
  contact.removed *= job.field->pitch * job.field->pitch;
  job.contacts->push_back(contact);
}

/// The passes of a sweep, in order: at most the cutting part, the flutes' end and three parts of the body.
struct PassList {
  Pass pass[6];
  int count = 0;
  void add(const Pass& p) { pass[count++] = p; }
};

[[gnu::noinline]] void list_passes(const Sweep& sweep, const LaneTool& tool, Real ignore, PassList& list) {
  const bool rapid = (sweep.passes & kPassRapid) != 0;
  const auto touching = [&](int bit, const LaneSolid& solid, HazardKind kind) {
    if ((sweep.passes & bit) == 0) return;
    list.add({.solid = &solid,
              .is_hazard = true,
              .kind = rapid ? HazardKind::rapid_in_stock : kind,
              .ignore = ignore});
  };
  // What a standing spindle cuts, however little, is cut all the same.
  const bool off = (sweep.passes & kPassSpindleOff) != 0;
  if ((sweep.passes & kPassCut) != 0)
    list.add(
        {.solid = &tool.cutting, .is_hazard = off, .kind = HazardKind::spindle_off, .report_above = ignore});
  touching(kPassRapid, tool.touching[0], HazardKind::rapid_in_stock);
  touching(kPassOverFlute, tool.over_flute, HazardKind::over_flute);
  touching(kPassNeck, tool.touching[1], HazardKind::neck_contact);
  touching(kPassShank, tool.touching[2], HazardKind::shank_contact);
  touching(kPassHolder, tool.touching[3], HazardKind::holder_contact);
}

}  // namespace

LaneSolid::LaneSolid(const Solid& solid)
    : one_envelope(solid.one_envelope),
      rim(static_cast<Real>(solid.rim)),
      bottom(static_cast<Real>(solid.bottom)),
      top(static_cast<Real>(solid.top)) {
  for (const Piece& piece : solid.pieces) {
    const auto r = static_cast<Real>(piece.rim);
    pieces.push_back(
        {r, static_cast<Real>(piece.rim * piece.rim), lane_cap(piece.lower), lane_cap(piece.upper)});
  }
  lid.rim = rim;
  lid.rim2 = rim * rim;
  lid.upper.height = -top;
  for (int i = 0; i < kCullLines; ++i) {
    offset[i] = static_cast<Real>(solid.lines[i].offset);
    slope[i] = static_cast<Real>(solid.lines[i].slope);
  }
}

LaneTool::LaneTool(const ToolSolids& tool) : cutting(tool.cutting), over_flute(tool.over_flute) {
  for (const Solid& solid : tool.touching) touching.emplace_back(solid);
}

KERF_KERNEL void cut_tile(const TileJob& job) {
  for (std::size_t q = 0; q < job.count; ++q) {
    const Sweep& sweep = job.sweeps[job.list[q]];
    const LaneTool& tool = (*job.tools)[sweep.tool];
    Work work{job, sweep, view_of(sweep, job), sweep.step};
    PassList list;
    list_passes(sweep, tool, job.field->hazard_depth, list);
    for (int k = 0; k < list.count; ++k) {
      Contact contact;
      contact.step = sweep.step;
      contact.kind = list.pass[k].kind;
      run_pass(work, list.pass[k], contact);
      if (list.pass[k].is_hazard) keep_contact(job, list.pass[k], contact);
    }
    job.removed[q] = work.taken;
  }
}

}  // namespace kerf::sim

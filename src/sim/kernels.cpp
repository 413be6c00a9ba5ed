// Sweeps against columns, 16 at a time.
//
// All loops over lanes are plain loops that the compiler turns into vector code; there are no intrinsics and no
// fused multiply-adds, so every processor gives the same bits. A tile sees a sweep in its own frame: the origin lies
// on the path near the tile, so that single precision is good for a hundredth of a micron on a stock of any size.
#include "sim/kernels.h"

#include <algorithm>
#include <cmath>

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
constexpr int kColumn[kLanes] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
constexpr int kRow[kLanes] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
constexpr int kBit[kLanes] = {1,      1 << 1, 1 << 2,  1 << 3,  1 << 4,  1 << 5,  1 << 6,  1 << 7,
                              1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 12, 1 << 13, 1 << 14, 1 << 15};
alignas(64) constexpr Real kColumnReal[kLanes] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) constexpr Real kRowReal[kLanes] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

inline Real lower_of(Real a, Real b) { return a < b ? a : b; }
inline Real higher_of(Real a, Real b) { return a > b ? a : b; }
inline Real clamped(Real v, Real low, Real high) { return lower_of(higher_of(v, low), high); }
inline Real root(Real v) { return std::sqrt(higher_of(v, 0)); }
inline Real square(Real v) { return v * v; }

LaneCap lane_cap(const Cap& cap) {
  const auto real = [](double v) { return static_cast<Real>(v); };
  return {cap.curve,       real(cap.flat),     real(cap.flat * cap.flat), real(cap.height),
          real(cap.slope), real(cap.centre_r), real(cap.centre_z),        real(cap.radius * cap.radius)};
}

// ---- a sweep seen from a tile

/// A sweep in the frame of a tile's work, see the top of this file. `slope` is 0 for level sweeps and plunges, which
/// then lie between z_low and z_high; lines that are neither have z at the origin.
struct View {
  bool is_arc = false;
  Real x = 0, y = 0;            // of the tile's first column
  Real cx = 1, cy = 0;          // direction of a line in plan
  Real t_low = 0, t_high = 0;   // its extent along that direction
  Real slope = 0, z = 0;
  Real ball_lead = 0;           // slope / sqrt(1 + slope^2)
  Real z_low = 0, z_high = 0;   // of the whole sweep
  Real behind = -kFar;          // what lies before this along a line was cut by the sweep before
  Real box_low_x = 0, box_high_x = 0, box_low_y = 0, box_high_y = 0;  // of the path in plan
  Real radius = 0;              // of an arc, whose centre is the origin
  Real begin_x = 0, begin_y = 0, end_x = 0, end_y = 0;  // its ends
  bool wide = false, full = false;                      // it turns more than half, all the way
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
  w.box_low_x = lower_of(ax, bx);
  w.box_high_x = higher_of(ax, bx);
  w.box_low_y = lower_of(ay, by);
  w.box_high_y = higher_of(ay, by);
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

/// What a cut that follows another need not cut again: all that lies so far back that the lowest point above it is
/// the begin, where the sweep before has ended. For solids with undercuts that holds in level sweeps only.
Real behind_of(const View& w, const Sweep& s, const LaneSolid& solid, bool open) {
  if (!s.follows || w.is_arc || s.length == 0.0) return -kFar;
  if (w.slope == 0) return w.t_low;
  if (!solid.one_envelope || !open) return -kFar;
  if (w.slope > 0) return w.t_low;
  const bool is_ball = solid.pieces.size() == 1 && solid.pieces[0].lower.curve == CapCurve::ball;
  return w.t_low + w.ball_lead * (is_ball ? std::sqrt(solid.pieces[0].lower.radius2) : kFar);
}

// ---- culling

/// Sixteen square blocks of columns, 4 x 4: the centre of the first, their distance, half the reach of their columns.
struct Blocks {
  Real x, y, step, half;
};

/// Bits of the blocks that a solid can meet, given the blocks' highest and lowest material.
inline int cull_line(const View& w, const LaneSolid& solid, const Blocks& b, const Real* top, const Real* bottom) {
  const Real reach = b.half * ((w.cx < 0 ? -w.cx : w.cx) + (w.cy < 0 ? -w.cy : w.cy));
  const Real rim = solid.rim, rim2 = rim * rim, solid_top = solid.top;
  int bits = 0;
  for (int i = 0; i < kLanes; ++i) {
    const Real x = b.x + kColumnReal[i] * b.step, y = b.y + kRowReal[i] * b.step;
    const Real u = x * w.cx + y * w.cy, v = y * w.cx - x * w.cy;
    const Real du = higher_of(higher_of(w.t_low - u, u - w.t_high) - reach, 0);
    const Real dv = higher_of((v < 0 ? -v : v) - reach, 0);
    const Real dx = higher_of(higher_of(w.box_low_x - x, x - w.box_high_x) - b.half, 0);
    const Real dy = higher_of(higher_of(w.box_low_y - y, y - w.box_high_y) - b.half, 0);
    const Real distance2 = higher_of(du * du + dv * dv, dx * dx + dy * dy);
    const Real distance = std::sqrt(distance2);
    // Height of the tip while the tool is above the block.
    const Real za = w.z + w.slope * clamped(u - reach - rim, w.t_low, w.t_high);
    const Real zb = w.z + w.slope * clamped(u + reach + rim, w.t_low, w.t_high);
    const Real z_low = w.slope == 0 ? w.z_low : lower_of(za, zb);
    const Real z_high = w.slope == 0 ? w.z_high : higher_of(za, zb);
    Real under = solid.offset[0] + solid.slope[0] * distance;
    for (int k = 1; k < kCullLines; ++k) under = higher_of(under, solid.offset[k] + solid.slope[k] * distance);
    const int meets = static_cast<int>(distance2 < rim2) & static_cast<int>(z_low + under < top[i]) &
                      static_cast<int>(z_high + solid_top > bottom[i]) & static_cast<int>(u + reach > w.behind);
    bits |= meets * kBit[i];
  }
  return bits;
}

inline int cull_arc(const View& w, const LaneSolid& solid, const Blocks& b, const Real* top, const Real* bottom) {
  constexpr Real kDiagonal = 1.4142136f;
  const Real rim2 = solid.rim * solid.rim, reach = kDiagonal * b.half, solid_top = solid.top;
  int bits = 0;
  for (int i = 0; i < kLanes; ++i) {
    const Real x = b.x + kColumnReal[i] * b.step, y = b.y + kRowReal[i] * b.step;
    const Real off = std::sqrt(x * x + y * y) - w.radius;
    const Real dr = higher_of((off < 0 ? -off : off) - reach, 0);
    const Real dx = higher_of(higher_of(w.box_low_x - x, x - w.box_high_x) - b.half, 0);
    const Real dy = higher_of(higher_of(w.box_low_y - y, y - w.box_high_y) - b.half, 0);
    const Real distance2 = higher_of(dr * dr, dx * dx + dy * dy);
    const Real distance = std::sqrt(distance2);
    Real under = solid.offset[0] + solid.slope[0] * distance;
    for (int k = 1; k < kCullLines; ++k) under = higher_of(under, solid.offset[k] + solid.slope[k] * distance);
    const int meets = static_cast<int>(distance2 < rim2) & static_cast<int>(w.z_low + under < top[i]) &
                      static_cast<int>(w.z_high + solid_top > bottom[i]);
    bits |= meets * kBit[i];
  }
  return bits;
}

inline int cull(const View& w, const LaneSolid& solid, const Blocks& b, const Real* top, const Real* bottom) {
  return w.is_arc ? cull_arc(w, solid, b, top, bottom) : cull_line(w, solid, b, top, bottom);
}

// ---- a convex piece swept: the lowest point of its underside above (or below) each column

/// Squared distance of each column from a line's or an arc's path in plan.
inline void path_distance2(const View& w, const Lanes& x, const Lanes& y, Lanes& out) {
  if (!w.is_arc) {
    for (int i = 0; i < kLanes; ++i) {
      const Real u = x[i] * w.cx + y[i] * w.cy, v = y[i] * w.cx - x[i] * w.cy;
      const Real du = higher_of(higher_of(w.t_low - u, u - w.t_high), 0);
      out[i] = du * du + v * v;
    }
    return;
  }
  for (int i = 0; i < kLanes; ++i) {
    const Real from_begin = w.begin_x * y[i] - w.begin_y * x[i];  // > 0: counter-clockwise of the begin
    const Real to_end = x[i] * w.end_y - y[i] * w.end_x;          // > 0: clockwise of the end
    const int narrow = static_cast<int>(from_begin >= 0) & static_cast<int>(to_end >= 0);
    const int broad = static_cast<int>(from_begin >= 0) | static_cast<int>(to_end >= 0);
    const int inside = w.full ? 1 : w.wide ? broad : narrow;
    const Real off = std::sqrt(x[i] * x[i] + y[i] * y[i]) - w.radius;
    const Real to_b = square(x[i] - w.begin_x) + square(y[i] - w.begin_y);
    const Real to_e = square(x[i] - w.end_x) + square(y[i] - w.end_y);
    out[i] = inside != 0 ? off * off : lower_of(to_b, to_e);
  }
}

/// Underside of a piece at a squared distance from its axis; kFar beyond the rim.
inline void level_cap(const LaneCap& c, Real rim2, const Lanes& distance2, Lanes& out) {
  switch (c.curve) {
    case CapCurve::flat:
      for (int i = 0; i < kLanes; ++i) out[i] = distance2[i] < rim2 ? c.height : kFar;
      break;
    case CapCurve::cone:
      for (int i = 0; i < kLanes; ++i) {
        const Real rise = c.slope * higher_of(std::sqrt(distance2[i]) - c.flat, 0);
        out[i] = distance2[i] < rim2 ? c.height + rise : kFar;
      }
      break;
    case CapCurve::ball:
      for (int i = 0; i < kLanes; ++i) {
        const Real low = higher_of(c.centre_z - root(c.radius2 - distance2[i]), c.height);
        out[i] = distance2[i] < rim2 ? low : kFar;
      }
      break;
    case CapCurve::torus:
      for (int i = 0; i < kLanes; ++i) {
        const Real d = higher_of(std::sqrt(distance2[i]) - c.centre_r, 0);
        const Real low = higher_of(c.centre_z - root(c.radius2 - d * d), c.height);
        out[i] = distance2[i] < rim2 ? low : kFar;
      }
      break;
  }
}

/// A ball that is not cut short by its rim: the closed form needs nothing else.
inline void sloped_ball(const LaneCap& c, const View& w, Real slope, Real lead, const Lanes& u, const Lanes& v2,
                        Lanes& out) {
  for (int i = 0; i < kLanes; ++i) {
    const Real across = c.radius2 - v2[i];
    const Real t = clamped(u[i] - lead * root(across), w.t_low, w.t_high);
    const Real rest = across - square(u[i] - t);
    out[i] = rest > 0 ? slope * t + c.centre_z - root(rest) : kFar;
  }
}

/// The lowest point, where `best` holds the place along the path at which the curve beyond the flat is lowest.
template <class Curve>
inline void sloped_curve(const LaneCap& c, Real rim2, const View& w, Real slope, const Lanes& u, const Lanes& v2,
                         const Lanes& best, Lanes& out, const Curve& curve) {
  for (int i = 0; i < kLanes; ++i) {
    const Real reach = root(rim2 - v2[i]);
    const Real ta = higher_of(u[i] - reach, w.t_low), tb = lower_of(u[i] + reach, w.t_high);
    const Real t = clamped(best[i], ta, tb);
    const Real rho2 = v2[i] + square(u[i] - t);
    // Above the flat the solid is a disc, and the lowest is where the disc goes furthest down the slope.
    const Real flat_reach = root(c.flat2 - v2[i]);
    const Real t_flat = slope > 0 ? higher_of(u[i] - flat_reach, w.t_low) : lower_of(u[i] + flat_reach, w.t_high);
    const Real low = rho2 < c.flat2 ? slope * t_flat + c.height : slope * t + curve(rho2);
    const int hit = static_cast<int>(v2[i] < rim2) & static_cast<int>(ta <= tb);
    out[i] = hit != 0 ? low : kFar;
  }
}

inline void sloped_flat(const LaneCap& c, Real rim2, const View& w, Real slope, const Lanes& u, const Lanes& v2,
                        Lanes& out) {
  for (int i = 0; i < kLanes; ++i) {
    const Real reach = root(rim2 - v2[i]);
    const Real ta = higher_of(u[i] - reach, w.t_low), tb = lower_of(u[i] + reach, w.t_high);
    const int hit = static_cast<int>(v2[i] < rim2) & static_cast<int>(ta <= tb);
    out[i] = hit != 0 ? slope * (slope > 0 ? ta : tb) + c.height : kFar;
  }
}

inline void sloped_cone(const LaneCap& c, Real rim2, const View& w, Real slope, const Lanes& u, const Lanes& v2,
                        Lanes& out) {
  // The cone is lowest where its flank falls as fast as the path rises; steeper paths go to the end of the reach.
  const Real rest = c.slope * c.slope - slope * slope;
  const Real lead = rest > 0 ? slope / std::sqrt(rest) : (slope > 0 ? kFar : -kFar);
  Lanes best;
  for (int i = 0; i < kLanes; ++i) best[i] = u[i] - clamped(lead * std::sqrt(v2[i]), -kFar, kFar);
  if (!(rest > 0))
    for (int i = 0; i < kLanes; ++i) best[i] = -lead;
  sloped_curve(c, rim2, w, slope, u, v2, best, out,
               [&](Real rho2) { return c.height + c.slope * (std::sqrt(rho2) - c.flat); });
}

/// Where a torus is lowest: the zero of the derivative, which rises along the path, by Newton's steps inside a bracket.
inline void torus_best(const LaneCap& c, Real rim2, const View& w, Real slope, const Lanes& u, const Lanes& v2,
                       Lanes& best) {
  constexpr Real kTiny = 1e-12f;
  Lanes low, high;
  for (int i = 0; i < kLanes; ++i) {
    const Real reach = root(rim2 - v2[i]);
    low[i] = higher_of(u[i] - reach, w.t_low);
    high[i] = higher_of(lower_of(u[i] + reach, w.t_high), low[i]);
    best[i] = clamped(u[i], low[i], high[i]);
  }
  for (int n = 0; n < kSearchSteps; ++n) {
    for (int i = 0; i < kLanes; ++i) {
      const Real p = best[i] - u[i];
      const Real rho = std::sqrt(higher_of(v2[i] + p * p, kTiny));
      const Real out = higher_of(rho - c.centre_r, 0);
      const Real down = std::sqrt(higher_of(c.radius2 - out * out, kTiny));
      const Real rise = out / down;
      const Real along = p / rho;
      const Real d1 = slope + rise * along;
      const Real bend = c.radius2 / (down * down * down);
      const Real d2 = (out > 0 ? bend : 0) * along * along + rise * v2[i] / (rho * rho * rho);
      high[i] = d1 > 0 ? best[i] : high[i];
      low[i] = d1 > 0 ? low[i] : best[i];
      const Real next = best[i] - d1 / higher_of(d2, kTiny);
      const int sound = static_cast<int>(next > low[i]) & static_cast<int>(next < high[i]);
      best[i] = sound != 0 ? next : Real{0.5f} * (low[i] + high[i]);
    }
  }
}

/// Lowest point above each column, relative to z at the frame's origin, of an underside swept along a sloping line;
/// kFar where the sweep does not pass.
inline void sloped_cap(const LaneCap& c, Real rim, Real rim2, const View& w, Real slope, const Lanes& u,
                       const Lanes& v2, Lanes& out) {
  const Real lead = slope == w.slope ? w.ball_lead : -w.ball_lead;
  Lanes best;
  switch (c.curve) {
    case CapCurve::flat: sloped_flat(c, rim2, w, slope, u, v2, out); break;
    case CapCurve::cone: sloped_cone(c, rim2, w, slope, u, v2, out); break;
    case CapCurve::ball:
      if (c.flat == 0 && rim * rim >= c.radius2) {
        sloped_ball(c, w, slope, lead, u, v2, out);
        break;
      }
      for (int i = 0; i < kLanes; ++i) best[i] = u[i] - lead * root(c.radius2 - v2[i]);
      sloped_curve(c, rim2, w, slope, u, v2, best, out,
                   [&](Real rho2) { return c.centre_z - root(c.radius2 - rho2); });
      break;
    case CapCurve::torus:
      torus_best(c, rim2, w, slope, u, v2, best);
      sloped_curve(c, rim2, w, slope, u, v2, best, out, [&](Real rho2) {
        return c.centre_z - root(c.radius2 - square(higher_of(std::sqrt(rho2) - c.centre_r, 0)));
      });
      break;
  }
}

/// The columns of a micro as a sweep's frame sees them.
struct MicroView {
  Lanes x, y;  // place
  Lanes u, v2; // along the line and squared across it; of level sweeps u is not set and v2 the squared distance
};

inline void look_at(const View& w, const Field& field, int micro, MicroView& m) {
  const int super = micro / kSupers, inner = micro % kSupers;
  const int column = (super & 3) * 16 + (inner & 3) * 4, row = (super >> 2) * 16 + (inner >> 2) * 4;
  const Real x0 = w.x + field.step[column], y0 = w.y + field.step[row];
  const Real pitch = field.step[1];
  for (int i = 0; i < kLanes; ++i) {
    m.x[i] = x0 + kColumnReal[i] * pitch;
    m.y[i] = y0 + kRowReal[i] * pitch;
  }
  if (w.slope == 0) {
    path_distance2(w, m.x, m.y, m.v2);
    return;
  }
  for (int i = 0; i < kLanes; ++i) {
    m.u[i] = m.x[i] * w.cx + m.y[i] * w.cy;
    m.v2[i] = square(m.y[i] * w.cx - m.x[i] * w.cy);
  }
}

inline void swept_low(const LanePiece& piece, const View& w, const MicroView& m, Lanes& low) {
  const Real z = w.slope == 0 ? w.z_low : w.z;
  if (w.slope == 0) {
    level_cap(piece.lower, piece.rim2, m.v2, low);
  } else {
    sloped_cap(piece.lower, piece.rim, piece.rim2, w, w.slope, m.u, m.v2, low);
  }
  for (int i = 0; i < kLanes; ++i) low[i] += z;
}

inline void swept_high(const LanePiece& piece, const View& w, const MicroView& m, Lanes& high) {
  const Real z = w.slope == 0 ? w.z_high : w.z;
  if (w.slope == 0) {
    level_cap(piece.upper, piece.rim2, m.v2, high);
  } else {
    sloped_cap(piece.upper, piece.rim, piece.rim2, w, -w.slope, m.u, m.v2, high);
  }
  for (int i = 0; i < kLanes; ++i) high[i] = z - high[i];
}

/// Interval number `group` that a solid sweeps in each column: of one envelope there is one, else one a piece.
/// `open`: the top of the sweep is above the block, which leaves `high` alone.
inline void swept(const LaneSolid& solid, std::size_t group, bool open, const View& w, const MicroView& m, Lanes& low,
                  Lanes& high) {
  swept_low(solid.pieces[group], w, m, low);
  if (solid.one_envelope) {
    Lanes next;
    for (std::size_t k = 1; k < solid.pieces.size(); ++k) {
      swept_low(solid.pieces[k], w, m, next);
      for (int i = 0; i < kLanes; ++i) low[i] = lower_of(low[i], next[i]);
    }
  }
  if (open) return;
  if (!solid.one_envelope) {
    swept_high(solid.pieces[group], w, m, high);
    return;
  }
  LanePiece lid;
  lid.rim = solid.rim;
  lid.rim2 = solid.rim * solid.rim;
  lid.upper.height = -solid.top;
  swept_high(lid, w, m, high);
}

// ---- taking material away

/// Takes all above `low` from columns that stand on the floor. Returns the length taken, weighted.
inline Real take_open(Tile& tile, int micro, const Lanes& low, std::uint32_t step, const Lanes& weight, Real same) {
  Lanes& top = tile.top[micro];
  std::uint32_t* steps = tile.top_step[micro];
  Lanes taken;
  Real highest = 0;
  for (int i = 0; i < kLanes; ++i) {
    const Real old = top[i];
    const Real left = low[i] < same ? Real{0} : low[i];
    const bool cut = left + same < old;
    const Real now = cut ? left : old;
    top[i] = now;
    steps[i] = cut ? step : steps[i];
    taken[i] = (old - now) * weight[i];
  }
  for (int i = 0; i < kLanes; ++i) highest = higher_of(highest, top[i]);
  tile.micro_top[micro] = highest;
  Real sum = 0;
  for (int width = kLanes / 2; width > 0; width /= 2)
    for (int i = 0; i < width; ++i) taken[i] += taken[i + width];
  sum = taken[0];
  return sum;
}

/// One interval of 16 columns less [low, high]; columns where that leaves two intervals are returned as bits.
inline int take_from_slot(Slot& slot, const Lanes& low, const Lanes& high, std::uint32_t step, Real same,
                          Lanes& taken) {
  int split = 0;
  for (int i = 0; i < kLanes; ++i) {
    const Real l = slot.low[i], h = slot.high[i];
    const Real a = higher_of(low[i], l), b = lower_of(high[i], h);
    const bool bottom = a <= l + same, top = b + same >= h;
    const bool meets = (b > a) & ((b - a > same) | (bottom & top));
    const bool all = meets & bottom & top;
    const bool from_below = meets & bottom & !top, from_above = meets & top & !bottom;
    const bool both = meets & !bottom & !top;
    slot.low[i] = all ? kFar : from_below ? b : l;
    slot.high[i] = all ? -kFar : (from_above | both) ? a : h;
    slot.low_step[i] = from_below ? step : slot.low_step[i];
    taken[i] += all ? h - l : meets ? b - a : Real{0};
    split |= both ? kBit[i] : 0;
    // The upper half of a split column takes the old upper end with it; the caller stores it.
    slot.high_step[i] = (from_above | both) ? step : slot.high_step[i];
  }
  return split;
}

struct Remnant {
  int lane;
  Real low, high;
  std::uint32_t high_step;
};

[[gnu::noinline]] void store_remnant(Tile& tile, int micro, const Remnant& rest, std::uint32_t step) {
  Slot* free = nullptr;
  for (std::int32_t k = tile.chain[micro]; k >= 0 && free == nullptr; k = tile.slots[static_cast<std::size_t>(k)].next) {
    Slot& slot = tile.slots[static_cast<std::size_t>(k)];
    if (slot.low[rest.lane] > slot.high[rest.lane]) free = &slot;
  }
  if (free == nullptr) free = &tile.add_slot(micro);
  free->low[rest.lane] = rest.low;
  free->high[rest.lane] = rest.high;
  free->low_step[rest.lane] = step;
  free->high_step[rest.lane] = rest.high_step;
}

/// Takes [low, high] from a micro with a chain.
[[gnu::noinline]] Real take_from_chain(Tile& tile, int micro, const Lanes& low, const Lanes& high, std::uint32_t step,
                                       const Lanes& weight, Real same) {
  Lanes taken{};
  Remnant rests[kLanes];
  int count = 0;
  for (std::int32_t k = tile.chain[micro]; k >= 0;) {
    Slot& slot = tile.slots[static_cast<std::size_t>(k)];
    const Lanes old_high = slot.high;
    std::uint32_t old_step[kLanes];
    std::copy_n(slot.high_step, kLanes, old_step);
    const int split = take_from_slot(slot, low, high, step, same, taken);
    // The intervals of a column do not overlap, so at most one of them is split.
    for (int i = 0; split != 0 && i < kLanes; ++i)
      if ((split & kBit[i]) != 0) rests[count++] = {i, high[i], old_high[i], old_step[i]};
    k = slot.next;
  }
  for (int n = 0; n < count; ++n) store_remnant(tile, micro, rests[n], step);
  tile.update_bounds(micro);
  Real sum = 0;
  for (int i = 0; i < kLanes; ++i) sum += taken[i] * weight[i];
  return sum;
}

inline Real take(Tile& tile, int micro, const Lanes& low, const Lanes& high, std::uint32_t step, const Lanes& weight,
                 Real same) {
  if (tile.chain[micro] < 0) {
    const Lanes& top = tile.top[micro];
    int leaves_roof = 0, meets = 0;
    for (int i = 0; i < kLanes; ++i) {
      const int inside = static_cast<int>(low[i] < top[i]) & static_cast<int>(high[i] > same);
      meets |= inside;
      leaves_roof |= inside & static_cast<int>(high[i] + same < top[i]);
    }
    if (meets == 0) return 0;
    if (leaves_roof == 0) {
      Lanes above;
      for (int i = 0; i < kLanes; ++i) above[i] = high[i] > same ? low[i] : kFar;
      return take_open(tile, micro, above, step, weight, same);
    }
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
  Real ignore = 0;  // contacts up to this length are left alone
};

/// Share of the step's way at which a contact of the column begins. In plan exact for the rim; a plunge is met at the
/// height where the contact is.
double begin_of_contact(const Sweep& s, const View& w, const MicroView& m, int lane, Real rim, Real low, Real high) {
  double share = 0.0;
  if (s.is_arc) {
    const double angle = std::atan2(s.ux * static_cast<double>(m.y[lane]) - s.uy * static_cast<double>(m.x[lane]),
                                    s.ux * static_cast<double>(m.x[lane]) + s.uy * static_cast<double>(m.y[lane]));
    constexpr double kTurn = 6.283185307179586;
    double ahead = s.turn > 0.0 ? angle : -angle;
    const double lead = std::min(3.0, static_cast<double>(rim) / s.radius);  // the rim comes before the centre
    if (ahead < 0.0 && ahead + kTurn - lead < std::abs(s.turn)) ahead += kTurn;
    share = (ahead - lead) / std::abs(s.turn);
  } else if (s.length > 0.0) {
    const Real u = m.x[lane] * w.cx + m.y[lane] * w.cy, v = m.y[lane] * w.cx - m.x[lane] * w.cy;
    share = static_cast<double>(u - root(square(rim) - square(v)) - w.t_low) / s.length;
  } else if (s.z > s.z_end) {  // the tip's height above the lowest it reaches in this column is the same everywhere
    share = (s.z - (s.z_end + static_cast<double>(high - low))) / (s.z - s.z_end);
  }
  share = std::clamp(share, 0.0, 1.0);
  const auto begin = static_cast<double>(s.share_begin), end = static_cast<double>(s.share_end);
  return begin + share * (end - begin);
}

/// Notes what [low, high] meets in a column; returns whether that is more than is ignored.
bool note_contact(const TileJob& job, const Sweep& s, const View& w, const MicroView& m, const Pass& pass, int micro,
                  int lane, Real low, Real high, double weight, Contact& contact) {
  std::vector<Interval> column;
  job.tile->intervals(micro * kLanes + lane, column);
  bool any = false;
  for (const Interval& run : column) {
    const Real a = higher_of(low, run.low), b = lower_of(high, run.high);
    if (!(b - a > pass.ignore)) continue;
    any = true;
    contact.removed += static_cast<double>(b - a) * weight;
    contact.depth = std::max(contact.depth, static_cast<double>(run.high - a));
    const double share = begin_of_contact(s, w, m, lane, pass.solid->rim, low, b);
    if (share >= contact.share) continue;
    contact.share = share;
    const int super = micro / kSupers, inner = micro % kSupers;
    const int column_x = (super & 3) * 16 + (inner & 3) * 4 + kColumn[lane];
    const int column_y = (super >> 2) * 16 + (inner >> 2) * 4 + kRow[lane];
    contact.at = {job.x + column_x * job.field->pitch, job.y + column_y * job.field->pitch, static_cast<double>(a)};
  }
  return any;
}

/// Notes the contacts of a micro and leaves in `low` and `high` only the columns with one.
[[gnu::noinline]] void note_contacts(const TileJob& job, const Sweep& s, const View& w, const MicroView& m,
                                     const Pass& pass, int micro, const Lanes& weight, Lanes& low, Lanes& high,
                                     Contact& contact) {
  for (int i = 0; i < kLanes; ++i) {
    const bool meets = low[i] < high[i] && low[i] < job.tile->micro_top[micro] &&
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

inline void weights_of(const TileJob& job, int micro, Lanes& weight) {
  const int super = micro / kSupers, inner = micro % kSupers;
  const Real* x = job.share_x + (super & 3) * 16 + (inner & 3) * 4;
  const Real* y = job.share_y + (super >> 2) * 16 + (inner >> 2) * 4;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) weight[4 * j + i] = x[i] * y[j];
}

inline void cut_micro(Work& work, const Pass& pass, bool open, int micro, Contact& contact) {
  const TileJob& job = work.job;
  const Field& field = *job.field;
  const LaneSolid& solid = *pass.solid;
  Tile& tile = *job.tile;
  MicroView m;
  Lanes weight, low, high;
  look_at(work.view, field, micro, m);
  weights_of(job, micro, weight);
  const std::size_t groups = solid.one_envelope ? 1 : solid.pieces.size();
  for (std::size_t g = 0; g < groups; ++g) {
    const bool fast = open && solid.one_envelope;
    swept(solid, g, fast, work.view, m, low, high);
    if (fast && !pass.is_hazard && tile.chain[micro] < 0) {
      work.taken += static_cast<double>(take_open(tile, micro, low, work.step, weight, field.same_height));
      continue;
    }
    if (fast)
      for (int i = 0; i < kLanes; ++i) high[i] = low[i] < kFar ? field.height + 1 : -kFar;
    if (pass.is_hazard) note_contacts(job, work.sweep, work.view, m, pass, micro, weight, low, high, contact);
    if (pass.takes)
      work.taken += static_cast<double>(take(tile, micro, low, high, work.step, weight, field.same_height));
  }
}

inline void run_pass(Work& work, const Pass& pass, Contact& contact) {
  const LaneSolid& solid = *pass.solid;
  if (solid.pieces.empty()) return;
  const Field& field = *work.job.field;
  Tile& tile = *work.job.tile;
  View& w = work.view;
  const bool open = w.z_low + solid.top >= field.height;
  w.behind = pass.is_hazard ? -kFar : behind_of(w, work.sweep, solid, open);
  const Real pitch = field.step[1];
  const Blocks supers{w.x + Real{7.5f} * pitch, w.y + Real{7.5f} * pitch, 16 * pitch, Real{7.5f} * pitch};
  int super_bits = cull(w, solid, supers, tile.super_top, tile.super_bottom);
  for (; super_bits != 0; super_bits &= super_bits - 1) {
    const int super = __builtin_ctz(static_cast<unsigned>(super_bits));
    Real* top = tile.micro_top + super * kSupers;
    Real* bottom = tile.micro_bottom + super * kSupers;
    const Blocks micros{w.x + field.step[(super & 3) * 16] + Real{1.5f} * pitch,
                        w.y + field.step[(super >> 2) * 16] + Real{1.5f} * pitch, 4 * pitch, Real{1.5f} * pitch};
    int micro_bits = cull(w, solid, micros, top, bottom);
    if (micro_bits == 0) continue;
    for (; micro_bits != 0; micro_bits &= micro_bits - 1)
      cut_micro(work, pass, open, super * kSupers + __builtin_ctz(static_cast<unsigned>(micro_bits)), contact);
    Real high = -kFar, low = kFar;
    for (int i = 0; i < kSupers; ++i) high = higher_of(high, top[i]);
    for (int i = 0; i < kSupers; ++i) low = lower_of(low, bottom[i]);
    tile.super_top[super] = high;
    tile.super_bottom[super] = low;
  }
}

/// A pass whose meeting material is a hazard: its contact is kept if there is one.
[[gnu::noinline]] void keep_contact(const TileJob& job, Contact& contact) {
  if (contact.share > 1.0) return;
  contact.removed *= job.field->pitch * job.field->pitch;
  job.contacts->push_back(contact);
}

inline void run_touching(Work& work, const LaneSolid& solid, HazardKind kind, bool takes, Real ignore) {
  Contact contact;
  contact.step = work.step;
  contact.kind = kind;
  run_pass(work, {.solid = &solid, .is_hazard = true, .kind = kind, .takes = takes, .ignore = ignore}, contact);
  keep_contact(work.job, contact);
}

inline void run_parts(Work& work, const LaneTool& tool) {
  const std::uint8_t passes = work.sweep.passes;
  const Real ignore = work.job.field->hazard_depth;
  const bool rapid = (passes & kPassRapid) != 0;
  const auto kind = [&](HazardKind of_part) { return rapid ? HazardKind::rapid_in_stock : of_part; };
  if (rapid) run_touching(work, tool.touching[0], HazardKind::rapid_in_stock, true, ignore);
  if ((passes & kPassOverFlute) != 0) run_touching(work, tool.over_flute, HazardKind::over_flute, false, ignore);
  if ((passes & kPassNeck) != 0) run_touching(work, tool.touching[1], kind(HazardKind::neck_contact), true, ignore);
  if ((passes & kPassShank) != 0) run_touching(work, tool.touching[2], kind(HazardKind::shank_contact), true, ignore);
  if ((passes & kPassHolder) != 0)
    run_touching(work, tool.touching[3], kind(HazardKind::holder_contact), true, ignore);
}

}  // namespace

LaneSolid::LaneSolid(const Solid& solid)
    : one_envelope(solid.one_envelope),
      rim(static_cast<Real>(solid.rim)),
      bottom(static_cast<Real>(solid.bottom)),
      top(static_cast<Real>(solid.top)) {
  for (const Piece& piece : solid.pieces) {
    const auto r = static_cast<Real>(piece.rim);
    pieces.push_back({r, static_cast<Real>(piece.rim * piece.rim), lane_cap(piece.lower), lane_cap(piece.upper)});
  }
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
    if ((sweep.passes & kPassCut) != 0) {
      if ((sweep.passes & kPassSpindleOff) != 0) {
        // What is cut below the hazard's depth is cut all the same: noise is only kept out of the report.
        Contact contact;
        contact.step = sweep.step;
        contact.kind = HazardKind::spindle_off;
        run_pass(work, {.solid = &tool.cutting, .is_hazard = true, .kind = contact.kind}, contact);
        if (contact.depth > static_cast<double>(job.field->hazard_depth)) keep_contact(job, contact);
      } else {
        Contact none;
        run_pass(work, {.solid = &tool.cutting}, none);
      }
    }
    if ((sweep.passes & ~(kPassCut | kPassSpindleOff)) != 0) run_parts(work, tool);
    job.removed[q] = work.taken;
  }
}

}  // namespace kerf::sim

// A swept convex piece: the lowest point of its underside (or the highest of its upper side) above each of
// sixteen columns.
#if defined(KERF_SIM_SHAPES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef KERF_SIM_SHAPES_INL_H
#undef KERF_SIM_SHAPES_INL_H
#else
#define KERF_SIM_SHAPES_INL_H
#endif

#include <cmath>

#include "sim/kernel/local_sweep.h"
#include "sim/kernel/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {

/// Iterations of the safeguarded Newton search for the lowest point of a swept torus.
inline constexpr int kSearchSteps = 14;

/// The columns of a micro in the frame of a sweep.
struct MicroView {
  Vector x, y;  // position
  Vector u,
      v2;  // along the line, and squared across it; for level sweeps u is not set and v2 is the squared
           // distance
};

HWY_INLINE Vector outside(Vector v, Real low, Real high) { return higher_of(low - v, v - high); }

/// Squared distance of each column from a line's path in plan.
HWY_INLINE Vector line_distance2(const LocalSweep& w, Vector x, Vector y) {
  const Vector u = x * w.cx + y * w.cy, v = y * w.cx - x * w.cy;
  return square(higher_of(outside(u, w.t_low, w.t_high), 0)) + v * v;
}

/// The same for a line or an arc.
HWY_INLINE Vector path_distance2(const LocalSweep& w, Vector x, Vector y) {
  if (!w.is_arc) return line_distance2(w, x, y);
  const Mask after_start = w.start_x * y - w.start_y * x >= 0;
  const Mask before_end = x * w.end_y - y * w.end_x >= 0;
  const Mask inside = w.full   ? every_lane()
                      : w.wide ? (after_start | before_end)
                               : (after_start & before_end);
  const Vector off = root(x * x + y * y) - w.radius;
  const Vector to_start = square(x - w.start_x) + square(y - w.start_y);
  const Vector to_end = square(x - w.end_x) + square(y - w.end_y);
  return select(inside, off * off, lower_of(to_start, to_end));
}

/// Underside of a piece at a squared distance from its axis; kFar beyond the rim.
HWY_INLINE Vector level_cap(const LaneCap& c, Real rim2, Vector distance2) {
  Vector low = c.height;
  switch (c.curve) {
    case CapCurve::flat: break;
    case CapCurve::cone: low = c.height + c.slope * higher_of(root(distance2) - c.flat, 0); break;
    case CapCurve::ball: low = higher_of(c.centre_z - root(c.radius2 - distance2), low); break;
    case CapCurve::torus: {
      const Vector out = higher_of(root(distance2) - c.centre_r, 0);
      low = higher_of(c.centre_z - root(c.radius2 - out * out), low);
      break;
    }
  }
  return select(distance2 < rim2, low, kFar);
}

/// A ball that is not clipped by its rim: the closed form suffices.
HWY_INLINE Vector sloped_ball(const LaneCap& c, const LocalSweep& w, Real slope, Real lead, Vector u,
                              Vector v2) {
  const Vector across = c.radius2 - v2;
  const Vector t = clamped(u - lead * root(across), w.t_low, w.t_high);
  const Vector rest = across - square(u - t);
  return select(rest > 0, slope * t + c.centre_z - root(rest), kFar);
}

/// The section of the path from which a rim reaches a column.
struct Reach {
  Vector start, end;
  Mask any;
};
HWY_INLINE Reach reach_of(Real rim2, const LocalSweep& w, Vector u, Vector v2) {
  const Vector reach = root(rim2 - v2);
  const Vector start = higher_of(u - reach, w.t_low), end = lower_of(u + reach, w.t_high);
  return {start, end, (v2 < rim2) & (start <= end)};
}

/// The path position where the sweep of a disc is lowest: as far down the slope as the disc reaches.
HWY_INLINE Vector flat_best(Real flat2, const LocalSweep& w, Real slope, Vector u, Vector v2) {
  const Vector half = root(flat2 - v2);
  return slope > 0 ? higher_of(u - half, w.t_low) : lower_of(u + half, w.t_high);
}

/// The underside outside the flat, at a squared distance from the axis.
HWY_INLINE Vector curve_at(const LaneCap& c, Vector rho2) {
  if (c.curve == CapCurve::cone) return c.height + c.slope * (root(rho2) - c.flat);
  if (c.curve == CapCurve::ball) return c.centre_z - root(c.radius2 - rho2);
  return c.centre_z - root(c.radius2 - square(higher_of(root(rho2) - c.centre_r, 0)));
}

/// The lowest point; `best` is the path position at which the curve outside the flat is lowest.
HWY_INLINE Vector sloped_curve(const LaneCap& c, Real rim2, const LocalSweep& w, Real slope, Vector u,
                               Vector v2, Vector best) {
  const Reach reach = reach_of(rim2, w, u, v2);
  const Vector t = clamped(best, reach.start, reach.end);
  const Vector rho2 = v2 + square(u - t);
  Vector low = slope * t + curve_at(c, rho2);
  if (c.flat2 > 0) low = select(rho2 < c.flat2, slope * flat_best(c.flat2, w, slope, u, v2) + c.height, low);
  return select(reach.any, low, kFar);
}

/// A cone is lowest where the slope of its flank is that of the path; for steeper paths at the end of the
/// reach.
HWY_INLINE Vector cone_best(const LaneCap& c, Real slope, Vector u, Vector v2) {
  const Real rest = c.slope * c.slope - slope * slope;
  if (rest > 0) return u - slope / std::sqrt(rest) * root(v2);
  return slope > 0 ? -kFar : kFar;
}

/// The path position where a torus is lowest: the zero of the derivative, which increases along the path, by
/// Newton iterations in a bracket.
HWY_INLINE Vector torus_best(const LaneCap& c, Real rim2, const LocalSweep& w, Real slope, Vector u,
                             Vector v2) {
  const Vector tiny = 1e-12f;
  const Reach reach = reach_of(rim2, w, u, v2);
  Vector low = reach.start, high = higher_of(reach.end, low), best = clamped(u, low, high);
  for (int n = 0; n < kSearchSteps; ++n) {
    const Vector p = best - u;
    const Vector rho = root(higher_of(v2 + p * p, tiny));
    const Vector out = higher_of(rho - c.centre_r, 0);
    const Vector down = root(higher_of(c.radius2 - out * out, tiny));
    const Vector rise = out / down, along = p / rho;
    const Vector curvature = only(out > 0, c.radius2 / (down * down * down));
    const Vector first = slope + rise * along;
    const Vector second = curvature * along * along + rise * v2 / (rho * rho * rho);
    high = select(first > 0, best, high);
    low = select(first > 0, low, best);
    const Vector next = best - first / higher_of(second, tiny);
    best = select((next > low) & (next < high), next, 0.5f * (low + high));
  }
  return best;
}

/// Lowest point above each column, relative to z at the origin of the frame, of an underside swept along a
/// line of `slope` (that of the view, negated for an upper side); kFar where the sweep does not pass.
HWY_INLINE Vector sloped_cap(const LanePiece& piece, const LaneCap& c, const LocalSweep& w, Real slope,
                             Vector u, Vector v2) {
  const Real lead = slope == w.slope ? w.ball_lead : -w.ball_lead;
  switch (c.curve) {
    case CapCurve::flat: {
      const Reach reach = reach_of(piece.rim2, w, u, v2);
      return select(reach.any, slope * (slope > 0 ? reach.start : reach.end) + c.height, kFar);
    }
    case CapCurve::cone: return sloped_curve(c, piece.rim2, w, slope, u, v2, cone_best(c, slope, u, v2));
    case CapCurve::ball:
      if (c.flat == 0 && piece.rim2 >= c.radius2) return sloped_ball(c, w, slope, lead, u, v2);
      return sloped_curve(c, piece.rim2, w, slope, u, v2, u - lead * root(c.radius2 - v2));
    case CapCurve::torus: break;
  }
  return sloped_curve(c, piece.rim2, w, slope, u, v2, torus_best(c, piece.rim2, w, slope, u, v2));
}

/// A swept side of a piece (the upper side is stored upside down): heights relative to the z of the view, for
/// level sweeps to its lowest (highest) one. Not inlined: the code is long, and the most common shapes do not
/// use it.
enum class Side : std::uint8_t { lower, upper };
HWY_NOINLINE Vector swept_cap(const LanePiece& piece, Side side, const LocalSweep& w, const MicroView& m) {
  const LaneCap& cap = side == Side::lower ? piece.lower : piece.upper;
  if (w.slope == 0) return level_cap(cap, piece.rim2, m.v2);
  return sloped_cap(piece, cap, w, side == Side::lower ? w.slope : -w.slope, m.u, m.v2);
}

/// The interval that piece `group`, or all pieces of a solid with one envelope, sweeps above each column.
/// `open`: nothing is left above.
struct Swept {
  Lanes low, high;
};
HWY_NOINLINE void sweep_over(const LaneSolid& solid, std::size_t group, bool open, Real above_all,
                             const LocalSweep& w, const MicroView& m, Swept& out) {
  const std::size_t last = solid.one_envelope ? solid.pieces.size() - 1 : group;
  Vector low = kFar;
  for (std::size_t k = group; k <= last; ++k)
    low = lower_of(low, swept_cap(solid.pieces[k], Side::lower, w, m));
  store((w.slope == 0 ? w.z_low : w.z) + low, out.low);
  if (open && solid.one_envelope) return store(above_all, out.high);
  const LanePiece& highest = solid.one_envelope ? solid.lid : solid.pieces[group];
  store((w.slope == 0 ? w.z_high : w.z) - swept_cap(highest, Side::upper, w, m), out.high);
}

}  // namespace kerf::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

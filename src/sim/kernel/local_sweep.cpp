// From a sweep in the block's frame to a tile's.
#include "sim/kernel/local_sweep.h"

#include <algorithm>
#include <cmath>

namespace kerf::sim {
namespace {

void view_line(const Sweep& s, const TileJob& job, double half_tile, LocalSweep& w) {
  const double to_x = job.x + half_tile - s.x, to_y = job.y + half_tile - s.y;
  const double t = std::clamp(to_x * s.ux + to_y * s.uy, 0.0, s.length);
  w.is_arc = false;
  w.x = static_cast<Real>(job.x - (s.x + t * s.ux));
  w.y = static_cast<Real>(job.y - (s.y + t * s.uy));
  w.cx = static_cast<Real>(s.ux);
  w.cy = static_cast<Real>(s.uy);
  w.t_low = static_cast<Real>(-t);
  w.t_high = static_cast<Real>(s.length - t);
  w.slope = static_cast<Real>(s.slope);
  w.z = static_cast<Real>(s.z + s.slope * t);
  w.ball_lead = s.ball_lead;
}

void view_arc(const Sweep& s, const TileJob& job, LocalSweep& w) {
  w.is_arc = true;
  w.x = static_cast<Real>(job.x - s.x);
  w.y = static_cast<Real>(job.y - s.y);
  w.radius = static_cast<Real>(s.radius);
  const double c = std::cos(s.turn), d = std::sin(s.turn);
  const double ex = s.ux * c - s.uy * d, ey = s.ux * d + s.uy * c;
  const bool ccw = s.turn > 0.0;  // a clockwise arc is the counter-clockwise one from its end to its start
  w.start_x = static_cast<Real>(s.radius * (ccw ? s.ux : ex));
  w.start_y = static_cast<Real>(s.radius * (ccw ? s.uy : ey));
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
  w.slope = w.t_low = w.t_high = 0;
}

/// The u before which a following cut need not cut again: there the lowest point above the column is the
/// start point, where the previous sweep ended. For solids with undercuts that holds only for level sweeps.
Real behind_of(const LocalSweep& w, const Sweep& s, const LaneSolid& solid, bool open) {
  if (!s.follows || w.is_arc || s.length == 0.0) return -kFar;
  if (w.slope == 0) return w.t_low;
  if (!solid.one_envelope || !open) return -kFar;
  if (w.slope > 0) return w.t_low;
  return w.t_low + w.ball_lead * (solid.is_ball ? solid.rim : kFar);
}

}  // namespace

void set_local_sweep(const Sweep& s, const TileJob& job, LocalSweep& w) {
  if (s.is_arc) {
    view_arc(s, job, w);
  } else {
    view_line(s, job, 31.5 * job.field->pitch, w);
  }
  w.z_low = static_cast<Real>(std::min(s.z, s.z_end));
  w.z_high = static_cast<Real>(std::max(s.z, s.z_end));
  if (w.slope == 0) w.z = w.z_low;
}

void prepare_for(LocalSweep& w, const Sweep& sweep, const LaneSolid& solid, Follow follow, bool open) {
  w.behind = follow == Follow::no ? -kFar : behind_of(w, sweep, solid, open);
  w.level_follow = follow == Follow::yes && sweep.follows && !w.is_arc && sweep.length > 0.0 && w.slope == 0;
}

}  // namespace kerf::sim

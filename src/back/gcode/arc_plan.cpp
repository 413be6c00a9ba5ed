// Planning of arcs. A controller computes radius and angles from rounded numbers. The same is computed here;
// an arc that would become a different one is written as chords.
#include "back/gcode/arc_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kerf/base/tolerance.h"

namespace kerf::gcode {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kWholeTurn = kTurn - 1e-6;  // radians; a larger sweep is a full circle
// 90 % of what GRBL permits, because it computes with 24 bits.
constexpr ArcMismatch kMismatch{.absolute = mm(0.0045), .relative = 0.0009, .limit = mm(0.45)};
constexpr double kAngleOff = 0.5;  // radians by which rounding may change a sweep
constexpr double kArcOff = 4.0;    // counts of arc length likewise
// A smaller sweep, computed with 24 bits, may become 0 and then a full circle. Such an arc is within 2e-9 of
// its radius from its chord.
constexpr double kMinSweep = 1e-4;   // radians
constexpr int kMaxChords = 1 << 20;  // of one arc; a finer tolerance than double precision has

/// std::hypot for counts, whose squares neither overflow nor underflow.
double distance_of(double u, double v) { return std::sqrt(u * u + v * v); }

/// An arc as a controller computes it from its words, in counts and radians.
struct AsRead {
  double start_radius, end_radius, sweep;
};

AsRead read_back(double du, double dv, std::int64_t u, std::int64_t v, bool ccw) {
  const double cu = static_cast<double>(u), cv = static_cast<double>(v);
  const double eu = du - cu, ev = dv - cv;
  double sweep = std::atan2(-cu * ev + cv * eu, -cu * eu - cv * ev);
  if (!ccw) sweep = -sweep;
  if (sweep <= 0.0) sweep += kTurn;
  return {distance_of(cu, cv), distance_of(eu, ev), sweep};
}

/// Of the four integer centres around (cu, cv), the one with the smallest difference of radii.
void round_centre(double du, double dv, double cu, double cv, ArcSegment& segment) {
  double best = -1.0;
  for (const double u : {std::floor(cu), std::floor(cu) + 1.0}) {
    for (const double v : {std::floor(cv), std::floor(cv) + 1.0}) {
      const double off = std::abs(distance_of(u, v) - distance_of(du - u, dv - v));
      // The second term selects the nearest of equally good centres.
      const double badness = off + 0.25 * distance_of(u - cu, v - cv);
      if (best >= 0.0 && badness >= best) continue;
      best = badness;
      segment.u = static_cast<std::int64_t>(u);
      segment.v = static_cast<std::int64_t>(v);
    }
  }
}

/// Splits into `count` arcs; false if one of them would be read differently.
bool split_into_arcs(const ArcWalk& walk, const Counts& from, const Counts& to, int count, const Grid& grid,
                     std::vector<ArcSegment>& segments) {
  const PlaneAxes axes = axes_of(walk.plane);
  const auto u = static_cast<std::size_t>(axes.u), v = static_cast<std::size_t>(axes.v);
  const double sweep = std::abs(walk.sweep) / count;
  Counts start = from;
  for (int i = 1; i <= count; ++i) {
    ArcSegment segment;
    segment.to = i == count ? to : grid.counts(walk.at(static_cast<double>(i) / count));
    const auto du = static_cast<double>(segment.to[u] - start[u]);
    const auto dv = static_cast<double>(segment.to[v] - start[v]);
    const double cu = walk.u * grid.counts_per_mm - static_cast<double>(start[u]);
    const double cv = walk.v * grid.counts_per_mm - static_cast<double>(start[v]);
    round_centre(du, dv, cu, cv, segment);
    const AsRead read = read_back(du, dv, segment.u, segment.v, walk.sweep > 0.0);
    const double off = std::abs(read.sweep - sweep);
    const double radius = std::max(read.start_radius, read.end_radius);
    const bool same =
        (du != 0.0 || dv != 0.0) && radius >= 1.0 && off <= kAngleOff && off * radius <= kArcOff;
    if (!same ||
        !kMismatch.permits(read.start_radius / grid.counts_per_mm, read.end_radius / grid.counts_per_mm))
      return false;
    segments.push_back(segment);
    start = segment.to;
  }
  return true;
}

void split_into_chords(const ArcWalk& walk, const Counts& to, const Grid& grid, Length chord,
                       std::vector<ArcSegment>& segments) {
  const int count = walk.chords(chord, kMaxChords);
  for (int i = 1; i < count; ++i)
    segments.push_back({grid.counts(walk.at(static_cast<double>(i) / count)), 0, 0});
  segments.push_back({to, 0, 0});
}

bool wants_arcs(const ArcWalk& walk, const PostProfile& profile) {
  const auto& planes = profile.arc_planes;
  return profile.arcs == ArcPolicy::centre &&
         std::find(planes.begin(), planes.end(), walk.plane) != planes.end() &&
         std::max(walk.start_radius, walk.end_radius) <= profile.largest_radius.mm();
}

}  // namespace

void plan_arc(const ArcWalk& walk, const Counts& from, const Counts& to, const Grid& grid,
              const PostProfile& profile, ArcPlan& plan) {
  plan.segments.clear();
  plan.uneven = !kMismatch.permits(walk.start_radius, walk.end_radius);
  const double swept = std::abs(walk.sweep);
  const double length = swept * std::max(walk.start_radius, walk.end_radius);
  if (length < profile.shortest_arc.mm() || swept < kMinSweep) {
    plan.form = ArcForm::straight;
    plan.segments.push_back({to, 0, 0});
    return;
  }
  if (!plan.uneven && wants_arcs(walk, profile)) {
    const PlaneAxes axes = axes_of(walk.plane);
    const auto u = static_cast<std::size_t>(axes.u), v = static_cast<std::size_t>(axes.v);
    const bool closes = from[u] == to[u] && from[v] == to[v] && swept > std::numbers::pi;
    const double count = swept < kWholeTurn && !closes ? 1.0 : std::ceil(swept / std::numbers::pi - 1e-6);
    plan.form = ArcForm::arcs;
    if (count <= kMaxChords &&
        split_into_arcs(walk, from, to, std::max(static_cast<int>(count), closes ? 2 : 1), grid,
                        plan.segments))
      return;
    plan.segments.clear();
  }
  plan.form = ArcForm::chords;
  split_into_chords(walk, to, grid, profile.chord, plan.segments);
}

}  // namespace kerf::gcode

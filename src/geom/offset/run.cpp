// Directions of segments, and the curve around a corner.
#include "run.h"

#include <algorithm>
#include <cmath>

namespace kerf::region_detail {
namespace {

Run run_of(Point2 from, const Segment& segment) {
  Run run{outline_detail::make_carrier(from, segment, 0.0), {}, {}, 0.0, 0};
  run.start_tangent = start_direction(run);
  run.end_tangent = end_direction(run);
  run.reach = norm(run.chord());
  if (!run.is_arc()) return run;
  const bool beyond_half = run.turn * cross(run.chord(), run.centre) < 0.0;
  run.reach = beyond_half ? run.radius : std::min(run.radius, run.reach);
  return run;
}

}  // namespace

std::vector<Run> runs_of(const Outline& outline) {
  std::vector<Run> runs;
  runs.reserve(outline.segments.size());
  Point2 from = outline.start;
  for (std::uint32_t i = 0; i < outline.segments.size(); ++i) {
    const Segment& s = outline.segments[i];
    if (!(s.to == from)) {
      runs.push_back(run_of(from, s));
      runs.back().number = i;
    }
    from = s.to;
  }
  return runs;
}

double turn_between(const Run& run, const Run& next) {
  // At the tip of a spike or a notch the directions differ by rounding, or by displaced points: the curves
  // are compared at a distance from it.
  constexpr double kTurnsBack = 0.05;  // sine
  const double sine = cross(run.end_tangent, next.start_tangent);
  if (dot(run.end_tangent, next.start_tangent) > 0.0 || std::abs(sine) > kTurnsBack)
    return sine >= 0.0 ? 1.0 : -1.0;
  const double ahead = 0.5 * std::min(run.reach, next.reach);
  // Directions from the corner to points at that distance on both.
  const auto turned = [&](Point2 tangent, double curvature) {
    return direction_at(tangent, 0.0, curvature, ahead);
  };
  const Point2 out = turned(next.start_tangent, next.curvature());
  const Point2 back = turned(-run.end_tangent, -run.curvature());
  return cross(out, back) >= 0.0 ? 1.0 : -1.0;
}

void add_corner(EdgeSet& set, Point2 at, double by, Point2 from, Point2 to, double turn, const Corner& corner,
                const CornerSources& sources) {
  set.belongs_to(sources.corner);
  if (corner.join == Join::round) return set.arc_to(at + by * from, at + by * to, at, by, turn);
  // Half of the angle between the directions; above a right angle where they turn by more than half a turn,
  // which they do up to rounding.
  const double half_cosine = std::min(1.0, 0.5 * norm(from + to));
  const double half_sine = std::sqrt(1.0 - half_cosine * half_cosine);
  const Point2 forwards = turn * left_of(from), backwards = -turn * left_of(to);  // along the tangents
  set.belongs_to(sources.before);
  if (half_cosine * corner.limit >= 1.0) {  // the tip is within the limit
    set.line_to(at + by * (from + (half_sine / half_cosine) * forwards));
  } else {
    // The tangents up to a line across the tip, which is at `limit` from the corner.
    const double ahead = half_sine > 0.0 ? (corner.limit - half_cosine) / half_sine : 0.0;
    set.line_to(at + by * (from + ahead * forwards));
    set.belongs_to(sources.corner);
    set.line_to(at + by * (to + ahead * backwards));
  }
  set.belongs_to(sources.after);
  set.line_to(at + by * to);
}

}  // namespace kerf::region_detail

// Gouges of a compensated path.
#include "front/gcmc/run/gouges.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geom/base/box_tree.h"

namespace kerf::gcmc {
namespace {

constexpr std::size_t kMaxPairs = 50'000'000;  // of a motion and a side, some 2 s
constexpr double kRounding = 1e-6;             // a part of the width, below which a gouge is rounding

std::vector<LineArc> sides_of(const CompensatedTrace& trace) {
  std::vector<LineArc> sides;
  const std::size_t n = trace.path.size();
  for (std::size_t i = 0; i + 1 < n; ++i) sides.push_back(line_between(trace.path[i], trace.path[i + 1]));
  if (trace.closed && n > 2) sides.push_back(line_between(trace.path[n - 1], trace.path[0]));
  return sides;
}

double square_to_line(Point2 from, Point2 chord, double inverse_square, Point2 p) {
  const Point2 to_p = p - from;
  const double t = std::clamp(dot(to_p, chord) * inverse_square, 0.0, 1.0);
  const Point2 off = to_p - t * chord;
  return dot(off, off);
}

/// The square of the distance of the chords of two elements that do not intersect.
double square_between_chords(const LineArc& e, const LineArc& f) {
  const Point2 u = e.chord(), v = f.chord();
  const double uu = 1.0 / std::max(dot(u, u), 1e-300), vv = 1.0 / std::max(dot(v, v), 1e-300);
  return std::min({square_to_line(e.from, u, uu, f.from), square_to_line(e.from, u, uu, f.to),
                   square_to_line(f.from, v, vv, e.from), square_to_line(f.from, v, vv, e.to)});
}

bool chords_cross(const LineArc& e, const LineArc& f) {
  const Point2 u = e.chord(), v = f.chord();
  return cross(u, f.from - e.from) * cross(u, f.to - e.from) <= 0.0 &&
         cross(v, e.from - f.from) * cross(v, e.to - f.from) <= 0.0;
}

/// How far an arc is from its chord at most.
double rise_of(const LineArc& motion) {
  if (!motion.is_arc()) return 0.0;
  const Point2 chord = motion.chord(), to_centre = motion.centre;
  const double half = 0.5 * norm(chord);
  const bool is_long = cross(chord, to_centre) * motion.turn <= 0.0;  // half a circle or more
  const double flat = motion.radius - std::sqrt(std::max(0.0, motion.radius * motion.radius - half * half));
  return is_long ? 2.0 * motion.radius : flat;
}

/// Whether a motion is at least `width` from a side, without the closest points.
bool is_surely_clear(const LineArc& motion, double rise, const LineArc& side, double width) {
  const double needed = width + rise;
  return square_between_chords(motion, side) >= needed * needed && !chords_cross(motion, side);
}

}  // namespace

Gouges find_gouges(const CompensatedTrace& trace) {
  const std::vector<LineArc> sides = sides_of(trace);
  std::vector<Box2> boxes;
  for (const LineArc& side : sides) boxes.push_back(bounds(side));
  if (boxes.empty()) return {};
  const BoxTree tree(boxes);
  const double least = kRounding * (1.0 + trace.width);
  std::map<std::size_t, Gouge> deepest;
  std::size_t pairs = 0;
  for (const LineArc& motion : trace.motions) {
    if (pairs > kMaxPairs) break;
    const double rise = rise_of(motion);
    Box2 near = bounds(motion);
    near.low = near.low - Point2{trace.width, trace.width};
    near.high = near.high + Point2{trace.width, trace.width};
    tree.query(near, [&](std::size_t i) {
      if (++pairs > kMaxPairs) return;
      if (is_surely_clear(motion, rise, sides[i], trace.width - least)) return;
      const ClosestPoints closest = closest_points(motion, sides[i]);
      const double depth = trace.width - distance(closest.first, closest.second);
      if (depth <= least) return;
      const std::size_t next = (i + 1) % trace.path.size();
      const bool is_first_half =
          distance(closest.second, trace.path[i]) <= distance(closest.second, trace.path[next]);
      const std::size_t corner = is_first_half ? i : next;
      const auto [it, is_new] = deepest.try_emplace(corner, Gouge{corner, closest.second, depth});
      if (!is_new && depth > it->second.depth) it->second = {corner, closest.second, depth};
    });
  }
  Gouges gouges;
  for (const auto& [corner, gouge] : deepest) gouges.deepest.push_back(gouge);
  gouges.complete = pairs <= kMaxPairs;
  return gouges;
}

}  // namespace kerf::gcmc

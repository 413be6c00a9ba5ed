// Elements at a distance from those of a path, connected one after the other.
#include "op/mill/beside.h"

#include "op/base/track.h"

namespace kerf::op_detail {
namespace {

struct Parallel {
  LineArc shape;
  bool beyond_centre = false;  // on the far side of the centre of an arc that is smaller than the distance
};

Parallel parallel_to(const LineArc& element, double to_left, double weld) {
  if (const auto shape = offset(element, to_left, weld)) return {*shape};
  const Point2 from = element.from + to_left * left_of(start_direction(element));
  const Point2 to = element.to + to_left * left_of(end_direction(element));
  if (std::abs(element.radius - std::abs(to_left)) <= weld) return {line_between(from, to), true};
  return {arc_about(element.circle_centre(), from, to, element.turn > 0.0 ? Turn::ccw : Turn::cw), true};
}

bool is_on(const LineArc& element, Point2 carried) {
  if (element.is_arc()) return sweep_to(element, carried) <= sweep_to(element, element.to);
  const double along = dot(element.chord(), carried - element.from);
  return along >= 0.0 && along <= dot(element.chord(), element.chord());
}

/// Where two elements intersect, the nearest to the corner between them.
std::optional<Point2> intersection(const LineArc& last, const LineArc& next, Point2 corner) {
  std::optional<Point2> nearest;
  if (last.from == last.to) return nearest;  // shortened to nothing by the corner before
  const Crossings crossings = carriers_cross(last, next, 0.0);
  for (int i = 0; i < crossings.count; ++i) {
    const Point2 p = crossings.at[i];
    if (is_on(last, p) && is_on(next, p) && (!nearest || distance(p, corner) < distance(*nearest, corner)))
      nearest = p;
  }
  return nearest;
}

/// Whether the tool clears all up to the pass before from `tip`, the end of two elements at an inner corner.
/// In sharp corners the tips of passes are farther apart than passes are.
bool reaches_back(Point2 tip, Point2 corner, double to_left, const NextPasses& passes) {
  constexpr double kFraction = 0.95;  // of the radius
  const double longer = distance(tip, corner) / std::abs(to_left);
  return (passes.step - passes.radius) * longer <= kFraction * passes.radius;
}

}  // namespace

Outline beside(const Outline& path, double to_left, NextPasses passes, double weld) {
  const Track track(path, weld);
  std::vector<LineArc> line;
  bool beyond = false;
  Point2 direction;
  for (const LineArc& element : track.pieces(0.0, track.length())) {
    Parallel next = parallel_to(element, to_left, weld);
    const bool inner = to_left * cross(direction, start_direction(element)) > 0.0;
    if (!line.empty() && distance(line.back().to, next.shape.from) > weld) {
      LineArc& last = line.back();
      const Point2 corner = element.from;
      const auto tip =
          inner && !beyond && !next.beyond_centre ? intersection(last, next.shape, corner) : std::nullopt;
      if (tip && reaches_back(*tip, corner, to_left, passes)) {
        next.shape.centre = next.shape.circle_centre() - *tip;
        last.to = next.shape.from = *tip;
      } else if (inner) {
        line.push_back(line_between(last.to, next.shape.from));
      } else {
        line.push_back(arc_about(corner, last.to, next.shape.from, to_left > 0.0 ? Turn::cw : Turn::ccw));
      }
    }
    line.push_back(next.shape);
    beyond = next.beyond_centre;
    direction = end_direction(element);
  }
  Outline made;
  if (!line.empty()) made.start = line.front().from;
  for (const LineArc& piece : line)
    made.segments.push_back({piece.to, piece.is_arc() ? std::optional(point_at(piece, 0.5)) : std::nullopt});
  return made;
}

}  // namespace kerf::op_detail

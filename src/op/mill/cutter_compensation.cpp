// Lead-in, corners and their intersections for cutter compensation.
#include "op/mill/cutter_compensation.h"

#include <numbers>

namespace kerf {
namespace {

constexpr double kTangent = 1e-6;  // mm, distance of touching elements by rounding

enum class Corner : unsigned char { smooth, outside, inside, cusp };

Corner corner_between(Point2 before, Point2 after, double to_left) {
  const double turn = std::atan2(cross(before, after), dot(before, after));
  const double towards_tool = to_left > 0.0 ? turn : -turn;
  if (std::abs(turn) > std::numbers::pi - CutterCompensation::kSmallCorner) return Corner::cusp;
  if (towards_tool > CutterCompensation::kSmallCorner) return Corner::inside;
  return towards_tool < -CutterCompensation::kSmallCorner ? Corner::outside : Corner::smooth;
}

/// Curvature of an element of the axis, 1/mm; above 0: to the left.
double curvature(const LineArc& element) { return element.is_arc() ? element.turn / element.radius : 0.0; }

/// The line or circle that an element of the axis lies on at its end point. The radii of a program's arc at
/// its start and end point may differ by rounding.
LineArc carrier(const LineArc& element, Point2 at, Point2 direction) {
  if (!element.is_arc()) return line_between(at, at + direction);
  const Point2 centre = element.circle_centre() - element.to;
  return {element.to, element.to, centre, norm(centre), element.turn};
}

/// The corner of a path that reverses its direction: inside if the next element is on the tool's side of the
/// previous one.
Corner corner_of_cusp(const LineArc& before, const LineArc& after, double to_left) {
  return to_left * (curvature(before) + curvature(after)) < 0.0 ? Corner::inside : Corner::outside;
}

}  // namespace

std::optional<CompensatedElement> CutterCompensation::add(const LineArc& programmed) {
  CompensatedElement made;
  made.short_entry = !entered_ && distance(programmed.from, programmed.to) <= radius();
  std::optional<LineArc> axis;
  if (entered_ || !programmed.is_arc())
    axis = offset(programmed, to_left_, kTangent);
  else if (!made.short_entry)
    axis = entry_arc(programmed);
  if (!axis) return std::nullopt;
  if (entered_)
    turn_corner(programmed.from, *axis, made);
  else
    tool_ = programmed.from;
  axis->centre = axis->circle_centre() - tool_;
  axis->from = tool_;
  made.axis = last_ = *axis;
  tool_ = axis->to;
  direction_ = end_direction(programmed);
  entered_ = true;
  return made;
}

/// Connects the end point of one element with the start point of the next.
void CutterCompensation::turn_corner(Point2 corner, const LineArc& next, CompensatedElement& made) {
  Corner which = corner_between(direction_, start_direction(next), to_left_);
  if (which == Corner::cusp) which = corner_of_cusp(last_, next, to_left_);
  if (which == Corner::smooth) return;
  if (which == Corner::inside) {
    made.previous_end = intersection(next, corner);
    made.gouges = !made.previous_end;
    if (made.previous_end) last_.to = tool_ = *made.previous_end;
    return;
  }
  made.gouges = !ends_forward();
  made.corner = arc_about(corner, tool_, next.from, is_left() ? Turn::cw : Turn::ccw);
  tool_ = next.from;
}

/// The lead-in for an arc: from its start point to the end point of its offset, tangent there.
std::optional<LineArc> CutterCompensation::entry_arc(const LineArc& programmed) const {
  const std::optional<LineArc> along = offset(programmed, to_left_, kTangent);
  if (!along) return std::nullopt;
  const Point2 outwards = programmed.turn * -left_of(end_direction(programmed));
  const Point2 way = along->to - programmed.from;
  const double twice = 2.0 * dot(outwards, way);
  if (std::abs(twice) < kTangent) return std::nullopt;
  const Point2 centre = along->to - (dot(way, way) / twice) * outwards;
  return arc_about(centre, programmed.from, along->to, programmed.turn > 0.0 ? Turn::ccw : Turn::cw);
}

/// The transition between two elements of the axis at an inside corner: of their intersections that the last
/// one reaches in its direction the nearest to the corner. Nothing if the tool does not fit.
std::optional<Point2> CutterCompensation::intersection(const LineArc& next, Point2 corner) const {
  const Crossings crossings = carriers_cross(carrier(last_, last_.to, direction_),
                                             carrier(next, next.from, start_direction(next)), 0.5 * kTangent);
  std::optional<Point2> nearest;
  for (int i = 0; i < crossings.count; ++i) {
    const Point2 p = crossings.at[i];
    if (runs_forward(p) && (!nearest || distance(p, corner) < distance(*nearest, corner))) nearest = p;
  }
  const auto is_far = [&](double v) { return !(std::abs(v) <= farthest_); };
  if (nearest && (is_far(nearest->x) || is_far(nearest->y))) return std::nullopt;
  return nearest;
}

/// Whether the last element keeps its direction and does not become longer if it ends at `end`; for a line
/// the direction is that of the program.
bool CutterCompensation::runs_forward(Point2 end) const {
  if (!last_.is_arc())
    return dot(direction_, end - last_.from) >= -kTangent && dot(direction_, end - last_.to) <= kTangent;
  return sweep_to(last_, end) <= sweep_to(last_, last_.to) + kTangent / last_.radius;
}

}  // namespace kerf

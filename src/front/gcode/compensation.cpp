// Offsets, corners and crossings of lines and arcs.
#include "front/gcode/compensation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace kerf::gcode {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNoLength = 1e-12;  // mm
constexpr double kTangent = 1e-6;    // mm that rounding may keep touching pieces apart

Point2 left_of(Point2 d) { return {-d.y, d.x}; }
Point2 unit(Point2 d) {
  const double size = length(d);
  return size > kNoLength ? (1.0 / size) * d : Point2{};
}

/// The direction in which an arc runs at one of its points.
Point2 along_arc(const Piece& arc, Point2 at) {
  const Point2 out = unit(at - *arc.centre);
  return arc.turn == Turn::ccw ? left_of(out) : -1.0 * left_of(out);
}

/// The angle from one point of an arc to another in its sense, above 0 and at most a whole turn.
double sweep(const Piece& arc, Point2 end) {
  const Point2 a = arc.from - *arc.centre, b = end - *arc.centre;
  const double angle = std::atan2(cross(a, b), dot(a, b)) * (arc.turn == Turn::ccw ? 1.0 : -1.0);
  return angle > 0.0 ? angle : angle + 2.0 * kPi;
}

/// How much a piece of the axis bends towards the tool's side: 1/mm, below 0 away from it.
double bend_to_tool(const Piece& piece, Side side) {
  if (!piece.centre) return 0.0;
  return (is_inside(piece, side) ? 1.0 : -1.0) / piece.radius();
}

/// Where two pieces cross, endlessly prolonged.
using Crossings = std::vector<Point2>;

Crossings cross_lines(Point2 a, Point2 da, Point2 b, Point2 db) {
  const double turn = cross(da, db);
  if (std::abs(turn) < kNoLength) return {};
  return {a + (cross(b - a, db) / turn) * da};
}

/// Both points at `foot` +- `reach` along `d`; none where the square of `reach` is below 0.
Crossings both(Point2 foot, Point2 d, double reach_squared, double size) {
  if (reach_squared < -kTangent * size) return {};
  const double reach = std::sqrt(std::max(0.0, reach_squared));
  return {foot - reach * d, foot + reach * d};
}

Crossings cross_line_arc(Point2 on_line, Point2 d, const Piece& arc) {
  const double r = arc.radius();
  const Point2 foot = on_line + dot(*arc.centre - on_line, d) * d;
  const double away = distance(foot, *arc.centre);
  return both(foot, d, r * r - away * away, r);
}

Crossings cross_arcs(const Piece& a, const Piece& b) {
  const double ra = a.radius(), rb = b.radius(), apart = distance(*a.centre, *b.centre);
  if (!(apart > kNoLength)) return {};
  const Point2 d = unit(*b.centre - *a.centre);
  const double share = (apart * apart + ra * ra - rb * rb) / (2.0 * apart);
  return both(*a.centre + share * d, left_of(d), ra * ra - share * share, ra);
}

}  // namespace

Side other(Side side) { return static_cast<Side>(-static_cast<signed char>(side)); }

Point2 Piece::direction_at_begin() const { return centre ? along_arc(*this, from) : unit(to - from); }
Point2 Piece::direction_at_end() const { return centre ? along_arc(*this, to) : unit(to - from); }

Point2 normal(Point2 direction, Side side) {
  return static_cast<double>(static_cast<signed char>(side)) * left_of(direction);
}

bool is_inside(const Piece& arc, Side side) { return (side == Side::left) == (arc.turn == Turn::ccw); }

std::optional<Piece> offset(const Piece& piece, Side side, double radius) {
  if (piece.centre && is_inside(piece, side) && piece.radius() - radius <= kTangent) return std::nullopt;
  Piece out = piece;
  out.from = piece.from + radius * normal(piece.direction_at_begin(), side);
  out.to = piece.to + radius * normal(piece.direction_at_end(), side);
  return out;
}

Corner corner_between(Point2 before, Point2 after, Side side) {
  const double turn = std::atan2(cross(before, after), dot(before, after));
  const double towards_tool = turn * static_cast<double>(static_cast<signed char>(side));
  if (std::abs(turn) > kPi - kSmallCorner) return Corner::cusp;
  if (towards_tool > kSmallCorner) return Corner::inside;
  return towards_tool < -kSmallCorner ? Corner::outside : Corner::smooth;
}

Corner corner_of_cusp(const Piece& before, const Piece& after, Side side) {
  return bend_to_tool(before, side) + bend_to_tool(after, side) < 0.0 ? Corner::inside : Corner::outside;
}

std::optional<Point2> meeting(const Piece& before, Point2 direction, const Piece& after, Point2 corner) {
  const Point2 next = after.direction_at_begin();
  const Crossings crossings = before.centre && after.centre ? cross_arcs(before, after)
                              : before.centre               ? cross_line_arc(after.from, next, before)
                              : after.centre                ? cross_line_arc(before.to, direction, after)
                                             : cross_lines(before.to, direction, after.from, next);
  std::optional<Point2> nearest;
  for (const Point2 p : crossings)
    if (runs_forward(before, direction, p) && (!nearest || distance(p, corner) < distance(*nearest, corner)))
      nearest = p;
  return nearest;
}

bool runs_forward(const Piece& piece, Point2 direction, Point2 end) {
  if (!piece.centre)
    return dot(direction, end - piece.from) >= -kTangent && dot(direction, end - piece.to) <= kTangent;
  return sweep(piece, end) <= sweep(piece, piece.to) + kTangent / piece.radius();
}

std::optional<Piece> entry_arc(const Piece& entry, Side side, double radius) {
  const std::optional<Piece> along = offset(entry, side, radius);
  if (!along) return std::nullopt;
  const Point2 out = unit(entry.to - *entry.centre), way = along->to - entry.from;
  const double share = 2.0 * dot(out, way);
  if (std::abs(share) < kTangent) return std::nullopt;
  Piece arc{entry.from, along->to, along->to - (dot(way, way) / share) * out, entry.turn};
  return arc;
}

}  // namespace kerf::gcode

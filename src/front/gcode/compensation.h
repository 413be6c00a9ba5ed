// Cutter compensation in its plane: where the tool's axis goes so that its edge follows the program.
//
// All here is plane geometry in the right-handed frame of the plane (axes_of): positive normals lie on the
// left of a direction. Outside corners are rounded by an arc about the corner; at inside corners the two
// offset pieces end where they cross; corners of less than kSmallCorner are passed as if they were smooth.
// Source: LinuxCNC's page "Tool Compensation", and what its interpreter does with small programs.
#pragma once

#include <optional>

#include "kerf/geometry.h"

namespace kerf::gcode {

/// LinuxCNC's limit, in radians: smaller corners come from curves cut into chords.
inline constexpr double kSmallCorner = 0.05;

enum class Side : signed char { right = -1, none = 0, left = 1 };
Side other(Side side);

/// A line or an arc of a program, or of the tool's axis.
struct Piece {
  Point2 from, to;
  std::optional<Point2> centre;  // of an arc
  Turn turn = Turn::ccw;

  double radius() const { return distance(*centre, to); }
  /// Directions of length 1; a piece of length 0 has none.
  Point2 direction_at_begin() const;
  Point2 direction_at_end() const;
};

/// The normal towards the tool of a direction of length 1.
Point2 normal(Point2 direction, Side side);
/// Whether the tool runs inside the arc.
bool is_inside(const Piece& arc, Side side);
/// The piece that the tool's axis follows, corners left aside. Nothing if the tool is too thick for the arc.
std::optional<Piece> offset(const Piece& piece, Side side, double radius);

enum class Corner : unsigned char { smooth, outside, inside, cusp };
Corner corner_between(Point2 before, Point2 after, Side side);
/// A path that goes back the way it came has an inside corner where it comes to lie on the tool's side of
/// itself.
Corner corner_of_cusp(const Piece& before, const Piece& after, Side side);
/// Where the tool goes from one piece of its axis to the next at an inside corner: the place nearest to the
/// corner where they cross and to which `before` runs forward. Nothing if the tool does not fit.
std::optional<Point2> meeting(const Piece& before, Point2 direction, const Piece& after, Point2 corner);
/// Whether a piece of the axis runs forward when it ends at `end`, no farther than it did; a line as the
/// program's `direction`.
bool runs_forward(const Piece& piece, Point2 direction, Point2 end);

/// The arc by which the tool comes from `from` onto the offset of the arc `entry`, tangent at its end.
std::optional<Piece> entry_arc(const Piece& entry, Side side, double radius);

}  // namespace kerf::gcode

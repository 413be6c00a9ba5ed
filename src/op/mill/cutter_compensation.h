// Cutter compensation in its plane: from the elements of a program to those of the tool's axis, so that the
// tool's edge follows the program.
//
// Elements are lines and arcs in the right-handed frame of the plane (axes_of), mm. Outside corners are
// rounded by an arc about the corner; at inside corners the two offset elements end where they intersect;
// corners of less than kSmallCorner are treated as tangent. The first element is the lead-in: for a line a
// line to the offset of its end point, for an arc another arc that is tangent there. Source: LinuxCNC's page
// "Tool Compensation", and the behaviour of its interpreter with small programs.
#pragma once

#include <optional>

#include "geom/base/line_arc.h"

namespace kerf {

/// The result for one element of the program.
struct CompensatedElement {
  /// After an inside corner: the new end point of the axis' previous element, which is shorter than before.
  std::optional<Point2> previous_end;
  /// After an outside corner: the arc from the end point of the previous element to this one.
  std::optional<LineArc> corner;
  LineArc axis;
  bool gouges = false;       // the tool is too large for the inside corner before this element
  bool short_entry = false;  // the first element is not longer than the tool's radius
};

class CutterCompensation {
 public:
  /// LinuxCNC's limit, in radians: smaller corners are those between chords of curves.
  static constexpr double kSmallCorner = 0.05;

  /// `to_left`: the tool's radius in mm, positive to the left of the path (G41), negative to the right (G42).
  /// Inside corners whose offsets intersect farther than `farthest` from zero are too narrow.
  CutterCompensation(double to_left, double farthest) : to_left_(to_left), farthest_(farthest) {}

  /// Another radius or side from the next element on.
  void change(double to_left) { to_left_ = to_left; }
  double radius() const { return std::abs(to_left_); }
  bool is_left() const { return to_left_ > 0.0; }
  /// True after the first element: the tool is beside the path.
  bool entered() const { return entered_; }
  /// Position of the tool's axis, once it is beside the path.
  Point2 tool() const { return tool_; }

  /// The axis of an element with a length above 0. Nothing for an arc that the tool cannot follow: an inside
  /// arc with a radius not larger than the tool's, or a first element that is too short.
  std::optional<CompensatedElement> add(const LineArc& programmed);
  /// False if the last element was shortened beyond its start: the tool has cut into the part.
  bool ends_forward() const { return runs_forward(last_.to); }

 private:
  void turn_corner(Point2 corner, const LineArc& next, CompensatedElement& made);
  std::optional<LineArc> entry_arc(const LineArc& programmed) const;
  std::optional<Point2> intersection(const LineArc& next, Point2 corner) const;
  bool runs_forward(Point2 end) const;

  double to_left_;
  double farthest_;
  bool entered_ = false;
  Point2 tool_;
  LineArc last_;      // element of the axis
  Point2 direction_;  // of the program at the end of its last element
};

}  // namespace kerf

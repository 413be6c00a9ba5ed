// Cutter compensation in its plane: from the elements that a program gives to those of the tool's axis,
// beside which the tool's edge follows the program.
//
// Elements are lines and arcs in the right-handed frame of the plane (axes_of), mm. Outside corners are
// rounded by an arc about the corner; at inside corners the two offset elements end where they intersect;
// corners of less than kSmallCorner are passed as if they were smooth. The first element leads in: a line
// straight to the offset of its end, an arc by another arc that is tangent there.
// Source: LinuxCNC's page "Tool Compensation", and what its interpreter does with small programs.
#pragma once

#include <optional>

#include "geom/line_arc.h"

namespace kerf {

/// What becomes of one element of the program.
struct CompensatedElement {
  /// After an inside corner: the end of the axis' previous element, which is nearer than before.
  std::optional<Point2> previous_end;
  /// After an outside corner: the arc that leads there from the end of the previous element.
  std::optional<LineArc> corner;
  LineArc axis;
  bool gouges = false;       // the tool does not fit into the inside corner before this element
  bool short_entry = false;  // the first element is not longer than the tool's radius
};

class CutterCompensation {
 public:
  /// LinuxCNC's limit, in radians: smaller corners come from curves cut into chords.
  static constexpr double kSmallCorner = 0.05;

  /// `to_left`: the tool's radius in mm where it runs left of the path (G41), its negative on the right
  /// (G42). Inside corners whose offsets intersect farther than `farthest` from zero count as too narrow.
  CutterCompensation(double to_left, double farthest) : to_left_(to_left), farthest_(farthest) {}

  /// Another radius or side from the next element on.
  void change(double to_left) { to_left_ = to_left; }
  double radius() const { return std::abs(to_left_); }
  bool is_left() const { return to_left_ > 0.0; }
  /// An element was added: the tool is beside the path.
  bool entered() const { return entered_; }
  /// Position of the tool's axis, once it is beside the path.
  Point2 tool() const { return tool_; }

  /// The axis of an element of some length. Nothing for an arc that the tool cannot follow: from inside with
  /// a radius that is not more than the tool's, or as a first element that is too short.
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

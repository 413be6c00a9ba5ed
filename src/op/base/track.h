// A path in the plane by its length: what entries, leads, tabs and passes walk along.
#pragma once

#include <vector>

#include "geom/base/line_arc.h"

#include "kerf/geom/outline.h"

namespace kerf::op_detail {

class Track {
 public:
  /// Segments shorter than `weld` are left out.
  Track(const Outline& outline, double weld);

  bool closed() const { return closed_; }
  double length() const { return length_; }  // mm
  bool empty() const { return elements_.empty(); }
  /// The point at a length from the start; of a closed path also beyond its length, and below 0.
  Point2 at(double s) const;
  /// The unit vector of the direction of travel there.
  Point2 direction(double s) const;
  /// The length at which the path is nearest to a point.
  double nearest(Point2 p) const;
  /// Calls visit(piece) for the lines and arcs from length `from` to `to`, which is the smaller one where the
  /// path is walked backwards. Pieces shorter than `weld` are part of their neighbours.
  template <class Visit>
  void walk(double from, double to, Visit&& visit) const {
    for (const LineArc& piece : pieces(from, to)) visit(piece);
  }
  std::vector<LineArc> pieces(double from, double to) const;

 private:
  struct Element {
    LineArc shape;
    double start = 0.0, length = 0.0;  // mm
    double sweep = 0.0;                // of an arc: radians, > 0
  };
  const Element& element_at(double s) const;
  static Point2 point_of(const Element& e, double along);
  static LineArc cut_out(const Element& e, double from, double to);

  std::vector<Element> elements_;
  double length_ = 0.0, weld_;
  bool closed_ = false;
};

/// The length of a piece, mm.
double length_of(const LineArc& piece);
/// The angle that an arc covers, above 0 and at most a full turn.
double sweep_of(const LineArc& arc);

}  // namespace kerf::op_detail

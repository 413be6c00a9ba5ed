// Where two edges meet.
#pragma once

#include "edge.h"

namespace kerf::region_detail {

/// Points that two edges have in common.
struct Meeting {
  /// Ends of one edge that lie on the other, up to the tolerance, without being an end of it.
  bool first_has_from = false, first_has_to = false;    // the ends of the second lie on the first
  bool second_has_from = false, second_has_to = false;  // the ends of the first lie on the second
  double off = 0.0;                                     // how far these ends lie from the other edge, at most
  int crossings = 0;  // points away from all ends where the edges cross or touch
  Point2 at[2];
  bool any() const {
    return first_has_from || first_has_to || second_has_from || second_has_to || crossings > 0;
  }
};

Meeting meet(const Edge& first, const Edge& second, double weld);

/// How far a point is from an edge where that is at most `weld`, else anything below 0.
double touches(const Edge& edge, Point2 p, double weld);

/// How far along an edge a point of it lies: 0 at its begin, the square of its chord at its end.
inline double along(const Edge& edge, Point2 p) { return dot(p - edge.from, edge.chord()); }

}  // namespace kerf::region_detail

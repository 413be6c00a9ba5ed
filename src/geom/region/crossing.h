// Contacts of two edges: intersections, and ends that touch the other edge.
#pragma once

#include "edge.h"

namespace kerf::region_detail {

/// Points that two edges have in common.
struct Contacts {
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

Contacts contacts_of(const Edge& first, const Edge& second, double weld);

/// The distance of a point from an edge where it is at most `weld`, else a number below 0.
double touches(const Edge& edge, Point2 p, double weld);

/// The position of a point along an edge: 0 at its start, the square of its chord at its end.
inline double along(const Edge& edge, Point2 p) { return dot(p - edge.from, edge.chord()); }

}  // namespace kerf::region_detail

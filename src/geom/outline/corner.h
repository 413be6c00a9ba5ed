// One corner: the arc that smooths it or the slot that enlarges it, from its two neighbours alone.
//
// All coordinates are relative to the corner. Both neighbours are directed away from the corner (a `Side`),
// the incoming one reversed, so that the same formulas apply to both.
#pragma once

#include <limits>

#include "segment.h"

namespace kerf::outline_detail {

/// What is left of one of the two segments of a corner: a LineArc relative to the corner, which keeps small
/// corners far from the origin accurate.
struct Side {
  Point2 away;          // unit, leaving the corner
  Point2 end;           // far end
  double length = 0.0;  // of a line
  Point2 centre;        // of an arc
  double radius = 0.0;  // of an arc
  double turn = 0.0;    // of an arc leaving the corner: +1 counter-clockwise, -1 clockwise; 0: a line
  double side = 0.0;    // +1: the inside of the corner is left of `away`, -1: right
  bool is_arc() const { return turn != 0.0; }
};

/// The side of the segment that arrives at the corner; `start` is the start of what is left of it.
inline Side arriving(const Carrier& carrier, Point2 start) {
  Side side;
  side.end = start - carrier.to;
  if (!carrier.is_arc()) {
    side.away = -carrier.direction;
    side.length = dot(side.end, side.away);
    return side;
  }
  side.centre = carrier.centre - (carrier.to - carrier.from);
  side.radius = carrier.radius;
  side.turn = -carrier.turn;
  side.away = (side.turn / side.radius) * left_of(-side.centre);
  return side;
}
/// The side of the segment that leaves the corner; `end` is the end of what is left of it.
inline Side leaving(const Carrier& carrier, Point2 end) {
  Side side;
  side.end = end - carrier.from;
  if (!carrier.is_arc()) {
    side.away = carrier.direction;
    side.length = dot(side.end, side.away);
    return side;
  }
  side.centre = carrier.centre;
  side.radius = carrier.radius;
  side.turn = carrier.turn;
  side.away = (side.turn / side.radius) * left_of(-side.centre);
  return side;
}

struct CornerLimits {
  double weld = 0.0;      // mm
  double straight = 0.0;  // sine of CornerOptions::straight
};

/// What replaces a corner: `count` pieces after the point `first` on the arriving segment. The last ends on
/// the leaving segment.
struct Replacement {
  SharpReason reason = SharpReason::none;  // other than none: there is no replacement
  Point2 first;
  int count = 0;
  Segment pieces[3];  // relative to the corner, without requests
};

/// Solves a corner. `request` as in Segment::corner, not 0. Sets which side of each neighbour is the inside.
Replacement solve_corner(Side& in, Side& out, double request, const CornerLimits& limits);
/// How much of its two neighbours a corner may take, measured along them.
struct Room {
  double in = std::numeric_limits<double>::infinity(), out = std::numeric_limits<double>::infinity();
};
/// The largest radius with the sign of `request` and below it that can be cut and takes no more than `room`;
/// 0 where none can. A round number where one lies within the error of the search.
double largest_radius(Side in, Side out, double request, const CornerLimits& limits, const Room& room);
/// How much of a side, measured along it, a replacement takes that reaches it at `point`.
double taken(const Side& side, Point2 point);

}  // namespace kerf::outline_detail

// Rectangles, circles and slots as exact sets, by formulas independent of the region kernel: on
// which side of a boolean expression of them a point lies, what of their boundaries bounds the expression,
// and how far a point is from that. Random regions are checked against them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "kerf/geom/region.h"

namespace kerf::exact_pieces {

/// A convex piece about `centre`: a rectangle of half sizes `a` and `b`, or all points within `b` of a line
/// of half length `a` (a circle where `a` is 0). Its own x axis has the direction `axis`.
struct Piece {
  bool is_rectangle = true;
  Point2 centre;
  double a = 1.0, b = 1.0;
  Point2 axis{1.0, 0.0};

  Point2 world(Point2 own) const {
    return centre + Point2{own.x * axis.x - own.y * axis.y, own.x * axis.y + own.y * axis.x};
  }
  Point2 own(Point2 world) const {
    const Point2 d = world - centre;
    return {d.x * axis.x + d.y * axis.y, d.y * axis.x - d.x * axis.y};
  }
  /// Distance from the boundary, below 0 inside.
  double distance_to(Point2 p) const;
  Outline outline() const;
};

/// A line or arc of a piece's boundary, counter-clockwise, over a parameter from 0 to 1.
struct Side {
  std::uint32_t piece = 0;
  bool is_arc = false;
  Point2 from, to;  // of a line
  Point2 centre;    // of an arc
  double radius = 0.0, first = 0.0, sweep = 0.0;
  Point2 at(double t) const;
  Point2 outwards(double t) const;
};
std::vector<Side> sides_of(const Piece& piece, std::uint32_t number);

/// What bounds an expression: a stretch of a side.
struct Stretch {
  Side side;
  double first = 0.0, last = 1.0;
  bool inside_on_left = true;  // the expression lies where the piece does
  Point2 at(double fraction) const { return side.at(first + fraction * (last - first)); }
  /// Out of the expression.
  Point2 outwards(double fraction) const {
    const Point2 out = side.outwards(first + fraction * (last - first));
    return inside_on_left ? out : Point2{-out.x, -out.y};
  }
  /// The distance of a point, or any number of at least `limit` where it is that far away.
  double distance_to(Point2 p, double limit) const;
};

/// The union of the first `first_count` pieces, combined with the union of the others.
class Expression {
 public:
  std::vector<Piece> pieces;
  std::size_t first_count = 0;
  Boolean what = Boolean::unite;

  static bool combined(Boolean what, bool first, bool second);
  bool has(Point2 p) const;
  /// Whether every point within `margin` lies on the same side of each piece.
  bool is_clear(Point2 p, double margin) const;
  /// With the points inside these pieces.
  bool has(const std::vector<bool>& inside) const;
  /// What has the expression on one side only whatever becomes of gaps and walls narrower than `kept`, but
  /// for stretches shorter than `least`.
  std::vector<Stretch> certain_boundary(double kept, double least) const;
  /// What may have it on one side only: sides less than `closed` apart are one, and those less than `kept`
  /// apart may lie either way.
  std::vector<Stretch> possible_boundary(double closed, double kept) const;

 private:
  template <class Selects>
  std::vector<Stretch> stretches(double grown, Selects selects) const;
};

double distance_to(const std::vector<Stretch>& boundary, Point2 p);

/// How often the loops of a region wind around points, by angles.
class WindingCounter {
 public:
  explicit WindingCounter(const Region& region);
  long around(Point2 p) const;

 private:
  struct Chord {
    Point2 from, to;
    Point2 centre;  // of an arc
    double radius = 0.0;
    int turn = 0;  // 1: counter-clockwise, -1: clockwise, 0: a line
  };
  std::vector<Chord> chords_;
};

/// Disjoint intervals along a line, in order.
using Intervals = std::vector<std::pair<double, double>>;
struct Line {
  Point2 from, direction;  // unit
  Point2 at(double t) const { return from + t * direction; }
};
/// What a line has of the expression, at least (each piece smaller by `margin` where that counts) and at
/// most.
struct Bracket {
  Intervals least, max;
};
Bracket bracket(const Expression& expression, const Line& line, double margin);
/// What a line has of a region.
Intervals stretches(const Region& region, const Line& line);
/// The longest stretch of `inner` that is outside of `outer`.
double longest_outside(const Intervals& inner, const Intervals& outer);

}  // namespace kerf::exact_pieces

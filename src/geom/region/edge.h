// Edges: what the plane is divided by. Lines, and arcs of at most a quarter turn that run one way in x and in
// y.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/box_tree.h"
#include "geom/outline/segment.h"

namespace kerf::region_detail {

/// How often chains wind around a point, or what that changes by, by group.
struct Winding {
  std::int32_t of[2] = {0, 0};
  bool operator==(const Winding&) const = default;
};

/// An arc is given by its ends, its radius and its turn, so that both ends lie on it; the centre follows from
/// them.
struct Edge : LineArc {
  std::uint32_t from_point = 0, to_point = 0;  // its ends by number
  std::uint32_t source = 0;                    // the segment that it is a piece of, by the caller's numbers
  Winding step;                                // the winding number on the left less that on the right

  Box2 box(double margin) const {
    return {{std::min(from.x, to.x) - margin, std::min(from.y, to.y) - margin},
            {std::max(from.x, to.x) + margin, std::max(from.y, to.y) + margin}};
  }
};

/// Sets the shape of an edge: a line where `turn` is 0 or the arc is flatter than rounding can show, else an
/// arc of at most a quarter turn, of a larger radius where the ends are further apart than one of `radius`
/// allows.
void set_shape(Edge& edge, Point2 from, Point2 to, double radius, double turn, double weld);

/// Chains of edges in the making. Points closer than `weld` to the one before are not made.
class EdgeSet {
 public:
  explicit EdgeSet(double weld) : weld_(weld) {}

  /// What the edges that follow belong to.
  void belongs_to(std::uint32_t source, std::uint32_t group = 0) {
    source_ = source;
    group_ = group;
  }
  void begin(Point2 at);
  void line_to(Point2 to);
  /// An arc of less than a turn with `radius` > 0 about `centre`. `from` is the last point, before it was
  /// joined to one nearby.
  void arc_to(Point2 from, Point2 to, Point2 centre, double radius, double turn);
  /// Joins the last point to the first; what is between them is a line.
  void close();
  /// A whole circle, as a chain of its own.
  void circle(Point2 centre, double radius, double turn);

  double weld() const { return weld_; }
  Point2 here() const { return points.back(); }

  std::vector<Edge> edges;
  std::vector<Point2> points;  // ends of edges, by number

 private:
  void piece_to(Point2 to, double radius, double turn);
  void push(Point2 to, std::uint32_t number, double radius, double turn);
  double weld_;
  std::uint32_t source_ = 0, group_ = 0;
  std::uint32_t first_ = 0;     // point where the chain begins
  std::size_t first_edge_ = 0;  // edge where the chain begins
};

/// Appends the segments of an outline, each a source of its own from `source` on; returns the next number.
std::uint32_t add_outline(EdgeSet& set, const Outline& outline, std::uint32_t source, std::uint32_t group);

/// Appends the segments of an outline, each with a source of its own.
void add_outline(EdgeSet& set, const Outline& outline, const std::vector<std::uint32_t>& sources,
                 std::uint32_t group);

/// Which way a curve runs at the distance `ahead` from its begin: its chord's direction `unit`, turned by
/// what a circle of this curvature (above 0: to the left) turns between there and the chord's end.
Point2 direction_at(Point2 unit, double chord, double curvature, double ahead);

/// The tree of the boxes of edges, each larger by `margin` on all sides.
BoxTree tree_of(const std::vector<Edge>& edges, double margin);

}  // namespace kerf::region_detail

// Edges: lines, and arcs of at most a quarter turn that are monotone in x and in y.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/box_tree.h"
#include "geom/outline/segment.h"

namespace kerf::region_detail {

/// The winding numbers of a point, or their change, for two groups of chains.
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

/// Builds closed chains of edges. Points closer than `weld` to the one before are left out.
class EdgeSet {
 public:
  explicit EdgeSet(double weld) : weld_(weld) {}

  /// The source and the group of the edges that follow.
  void belongs_to(std::uint32_t source, std::uint32_t group = 0) {
    source_ = source;
    group_ = group;
  }
  void start_chain(Point2 at);
  void line_to(Point2 to);
  /// An arc of less than a turn with `radius` > 0 about `centre`. `from` is the last point, before it was
  /// joined to one nearby.
  void arc_to(Point2 from, Point2 to, Point2 centre, double radius, double turn);
  /// Joins the last point to the first, by a line where they are apart.
  void close();
  /// A whole circle as a chain.
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
  std::uint32_t first_ = 0;     // point of the start of the chain
  std::size_t first_edge_ = 0;  // its first edge
};

/// Appends the segments of an outline, each a source of its own from `source` on; returns the next number.
std::uint32_t add_outline(EdgeSet& set, const Outline& outline, std::uint32_t source, std::uint32_t group);

/// Appends the segments of an outline, each with a source of its own.
void add_outline(EdgeSet& set, const Outline& outline, const std::vector<std::uint32_t>& sources,
                 std::uint32_t group);

/// The direction from the start of a curve to its point at the distance `ahead`: the direction `unit` of its
/// chord, turned by the angle between both chords of a circle of this curvature (above 0: to the left).
Point2 direction_at(Point2 unit, double chord, double curvature, double ahead);

/// The tree of the boxes of edges, each larger by `margin` on all sides.
BoxTree tree_of(const std::vector<Edge>& edges, double margin);

}  // namespace kerf::region_detail

// The plane divided by closed chains of edges: the winding numbers of each face, and the outline of the faces
// that a rule selects.
//
// Edges are split where they intersect or touch, and points within the tolerance of each other become one. If
// that displaces points by more than rounding does, the parts are the edges of another round, until no point
// is displaced: then parts have nothing in common but their ends and are a tolerance apart elsewhere. Only
// these parts determine winding numbers and outlines: winding numbers follow from the order of parts around
// points, and a ray through the parts gives those of each connected component. Winding numbers that
// contradict each other, or a second ray, are detected; the computation is then repeated with more rounds and
// other tolerances.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "edge.h"

#include "kerf/base/progress.h"

namespace kerf::region_detail {

/// Winding numbers of points that are on no edge.
class WindingSearch {
 public:
  WindingSearch(const std::vector<Edge>& edges, const BoxTree& tree) : edges_(edges), tree_(tree) {}
  Winding around(Point2 at) const;

 private:
  const std::vector<Edge>& edges_;
  const BoxTree& tree_;
};

/// The change of the winding number, +1 or -1, where a ray from the point to -x crosses the edge; else 0.
int ray_crosses(const Edge& edge, Point2 at);
/// The x where an edge meets a horizontal line that crosses it.
double crossing_at(const Edge& edge, double y);

/// A part of an edge between two contacts.
struct Part {
  std::uint32_t from = 0, to = 0, edge = 0;
  bool kept = true;    // false: coincides with another, which replaces both
  bool known = false;  // has its winding number
  Winding step;        // the winding number on the left less that on the right
  Winding left;        // the winding number on the left
  Winding right() const { return {{left.of[0] - step.of[0], left.of[1] - step.of[1]}}; }
};

class Arrangement {
 public:
  enum class Outcome : std::uint8_t {
    done,
    contradiction,
    exceeded,  ///< more pairs of edges than allowed
    too_many,
    stopped
  };

  enum class Care : std::uint8_t {
    ordinary,
    thorough  ///< always a second round: points nearly in one position are separated or joined
  };

  /// The chains of `set`, which must outlive this object, must be closed. Points closer than `weld` become
  /// one.
  /// Stops where the boxes of more than `max_pairs` pairs of edges overlap.
  Outcome build(const EdgeSet& set, double weld, Care care, std::size_t max_pairs, Progress* progress);

  const std::vector<Part>& parts() const { return parts_; }
  const std::vector<Edge>& edges() const { return rounds_ == 0 ? set_->edges : contracted_; }
  Point2 point(std::uint32_t number) const { return points_[number]; }
  /// A point of a part, at a fraction of its chord.
  Point2 point_on(const Part& part, double fraction) const;
  /// Whether points were displaced. Then parts along one source are one segment only if the points between
  /// its ends are within `slack()` of it.
  bool displaced() const { return rounds_ > 0 || has_displaced_parts_; }
  double slack() const;

  /// A part of a loop, in its direction or against it.
  struct Link {
    std::uint32_t part;
    bool forward;
  };
  using Loop = std::vector<Link>;
  /// The outline of where inside(winding) is true: loops with the inside on their left that do not cross
  /// themselves or each other.
  template <class Inside>
  std::vector<Loop> loops(Inside inside) const {
    std::vector<std::int8_t> sides(parts_.size(), 0);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (!parts_[i].kept) continue;
      const bool left = inside(parts_[i].left), right = inside(parts_[i].right());
      if (left != right) sides[i] = left ? 1 : -1;
    }
    return follow(sides);
  }
  /// Whether a ray from the longest part of each loop has the winding numbers of the part.
  bool confirms(const std::vector<Loop>& loops) const;

 private:
  struct Hit {
    std::uint32_t edge, point;
  };
  Outcome find_contacts(std::size_t max_pairs, Progress* progress);
  void hit(std::uint32_t edge, std::uint32_t point) { hits_.push_back({edge, point}); }
  void find_contacts_of(const Edge& e, std::uint32_t i, const Edge& f, std::uint32_t j);
  void find_near_crossings(std::uint32_t first_crossing);
  void sort_hits();
  void split_edges(double slack);
  std::uint32_t welded(std::uint32_t point);
  void join(std::uint32_t a, std::uint32_t b);
  void cluster_joined();
  bool displaced_parts_are_clear(double slack) const;
  bool is_clear(const Part& part) const;
  void gather_ends();
  void merge_duplicates();
  void merge_duplicates_at(std::uint32_t point, std::vector<std::uint32_t>& ends);
  double bulge(const Part& part, bool forward) const;
  void contract();

  enum class Axis : std::uint8_t { x, y };
  void sort_ends();
  void sort_ends_at(std::uint32_t* first, std::uint32_t* last, Axis from) const;
  bool spread_windings();
  struct Component {
    std::uint32_t leftmost, lowest;  // points
    Box2 box;
    Winding outside;  // the winding number outside of it, relative to its first part's
    Winding offset;   // from such winding numbers to absolute ones
  };
  bool spread_from(std::uint32_t root, std::uint32_t number);
  bool locate_components();
  bool locate_enclosed(const std::vector<std::uint32_t>& enclosed, bool by_counting);
  Winding around(const Component& component, std::uint32_t number, Axis axis, bool by_counting) const;
  std::vector<std::uint32_t> enclosed_components() const;
  Winding outside(std::uint32_t point, Axis axis) const;
  struct Step {
    std::uint32_t end;  // whose left winding number is known
    Winding left;
  };
  bool spread_around(const Step& known);
  std::vector<Loop> follow(const std::vector<std::int8_t>& sides) const;
  bool confirms(std::uint32_t part, double fraction) const;

  /// A ray to -x (or -y) through all parts but those of one component, or but one part.
  struct Ray {
    Point2 from;
    std::uint32_t component, part;  // left out; kNone: none
    Winding winding;                // found by counting
  };
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct First {
    std::uint32_t part = kNone;
    bool certain = true;
  };
  /// Maximum distance of a part from its edge: a point within the tolerance of it was joined to another.
  double reach() const { return 2.0 * weld_; }
  Winding cast(Ray& ray, Axis axis) const;
  First first(const Ray& ray, Axis axis) const;
  void count(Ray& ray, Axis axis) const;
  void cross_part(Ray& ray, std::uint32_t part, Axis axis) const;
  /// Calls visit(part) for the parts of an edge that are kept, in order.
  template <class Visit>
  void parts_of_edge(std::uint32_t edge, Visit visit) const {
    const auto first = std::lower_bound(parts_.begin(), parts_.end(), edge,
                                        [](const Part& part, std::uint32_t e) { return part.edge < e; });
    for (auto part = first; part != parts_.end() && part->edge == edge; ++part)
      if (part->kept) visit(static_cast<std::uint32_t>(part - parts_.begin()));
  }
  Edge drawn(const Part& part, Axis axis) const;

  /// Ends of parts are numbered: twice the part's number, plus 1 for its last point.
  std::uint32_t point_of(std::uint32_t end) const {
    return (end & 1) != 0 ? parts_[end >> 1].to : parts_[end >> 1].from;
  }
  struct Leaving {
    Point2 unit;  // towards the other end
    double chord, curvature;
  };
  Leaving leaving(std::uint32_t end) const;
  Winding left_of_end(std::uint32_t end) const {
    return (end & 1) != 0 ? parts_[end >> 1].right() : parts_[end >> 1].left;
  }

  const EdgeSet* set_ = nullptr;
  double weld_ = 0.0;
  int rounds_ = 0;                      // after the first
  std::vector<Edge> contracted_;        // the edges of those rounds
  BoxTree tree_;                        // of the edges
  double displaced_ = 0.0;              // in this round, at most
  bool has_displaced_parts_ = false;    // the first round was the last although it displaced points
  std::vector<Point2> points_;          // the set's, then the intersections
  std::vector<std::uint32_t> same_as_;  // a forest: points that are one
  std::vector<Hit> hits_;
  std::vector<bool> touched_;  // edges that have an end of another, or an end on another
  std::vector<std::uint32_t> hits_of_edge_,
      edge_hits_;  // points by edge in order along it, and the first of each
  std::vector<Part> parts_;
  std::vector<std::uint32_t> ends_, point_ends_;  // ends of parts by point in order of turning, first of each
  std::vector<std::uint32_t> component_;          // by point; kNone: not reached
  std::vector<Component> components_;
  std::vector<Step> walk_;
};

}  // namespace kerf::region_detail

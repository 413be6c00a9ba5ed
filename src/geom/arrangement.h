// The plane divided by closed chains of edges: how often each chain's group winds around each part of it, and
// the outline of the parts that a rule picks.
//
// Edges are cut where they meet and points closer than the tolerance become one, so that what is left meets
// in points only. From then on no geometry is asked but the order of the edges around a point: winding
// numbers run from edge to edge, and the outline is followed by the numbers of points. Where the order should
// be wrong because points were moved, the winding numbers contradict each other; this is noticed, and the
// work is done again with a larger tolerance.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "box_tree.h"
#include "edge.h"

namespace kerf::region_detail {

struct Winding {
  std::int32_t of[2] = {0, 0};  // by group
  bool operator==(const Winding&) const = default;
};

/// How often the chains wind around a point that is on none of them. `skip(edge)` leaves edges out.
class WindingSearch {
 public:
  WindingSearch(const std::vector<Edge>& edges, const BoxTree& tree) : edges_(edges), tree_(tree) {}
  template <class Skip>
  Winding around(Point2 at, Skip skip) const;

 private:
  const std::vector<Edge>& edges_;
  const BoxTree& tree_;
};

/// +1 or -1 where a ray from the point to -x crosses the edge, by what the winding number changes; 0 where
/// not.
int ray_crosses(const Edge& edge, Point2 at);

template <class Skip>
Winding WindingSearch::around(Point2 at, Skip skip) const {
  constexpr double kFar = 1e300;
  Winding winding;
  tree_.query({-kFar, at.y, at.x, at.y}, [&](std::uint32_t i) {
    const int step = ray_crosses(edges_[i], at);
    if (step != 0 && !skip(i)) winding.of[edges_[i].group] += step;
  });
  return winding;
}

/// A part of an edge between two points where it meets others.
struct Part {
  std::uint32_t from = 0, to = 0, edge = 0;
  bool kept = true;    // false: coincides with another, which stands for both
  bool known = false;  // has its winding number
  Winding step;        // the winding number on the left less that on the right
  Winding left;        // the winding number on the left
  Winding right() const { return {{left.of[0] - step.of[0], left.of[1] - step.of[1]}}; }
};

class Arrangement {
 public:
  enum class Outcome : std::uint8_t { done, contradiction, too_many };

  enum class Care : std::uint8_t {
    ordinary,
    thorough  ///< also asks which edges pass near a crossing of two others
  };

  /// The chains of `set` must be closed. Points closer than `weld` become one.
  Outcome build(const EdgeSet& set, double weld, Care care);

  const std::vector<Part>& parts() const { return parts_; }
  const std::vector<Edge>& edges() const { return set_->edges; }
  Point2 point(std::uint32_t number) const { return points_[number]; }

  /// A way along a part: forwards or backwards.
  struct Way {
    std::uint32_t part;
    bool forward;
  };
  using Loop = std::vector<Way>;
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

 private:
  struct Hit {
    std::uint32_t edge, point;
  };
  bool find_meetings(const BoxTree& tree);
  bool find_near_crossings(const BoxTree& tree);
  void note(std::uint32_t edge, std::uint32_t point) { hits_.push_back({edge, point}); }
  void meet_edges(std::uint32_t i, std::uint32_t j);
  void cut_edges();
  void cut_edge(std::uint32_t edge, std::vector<std::uint32_t>& on_it, std::vector<Part>& raw);
  std::uint32_t welded(std::uint32_t point);
  void join(std::uint32_t a, std::uint32_t b);
  void gather_ends();
  void merge_twins();
  void merge_twins_at(std::uint32_t point, std::vector<std::uint32_t>& ends);
  bool twins(std::uint32_t a, std::uint32_t b) const;
  void sort_ends();
  void sort_ends_at(std::uint32_t* begin, std::uint32_t* end) const;
  bool spread_windings(const BoxTree& tree);
  bool spread_from(std::uint32_t root, const WindingSearch& search);
  struct Step {
    std::uint32_t end;  // whose left winding number is known
    Winding left;
  };
  bool spread_around(const Step& known, std::vector<std::uint32_t>& reached);
  std::vector<Loop> follow(const std::vector<std::int8_t>& sides) const;

  /// Ends of parts are numbered: twice the part's number, plus 1 for the end where it arrives.
  std::uint32_t place_of(std::uint32_t end) const {
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
  std::vector<Point2> points_;          // the set's, then the crossings
  std::vector<std::uint32_t> same_as_;  // a forest: points that are one
  std::vector<Hit> hits_;
  std::vector<Part> parts_;
  std::vector<std::uint32_t> ends_, ends_begin_;  // ends of parts by point, in order of turning
  std::vector<bool> seen_;                        // points on the walk
  std::vector<Step> walk_;
};

}  // namespace kerf::region_detail

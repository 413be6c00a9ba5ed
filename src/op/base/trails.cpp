// Trails: from an end of the paths along edges that are not cut yet, straight on where several meet, until
// there is none. With as many odd nodes left as a trail has ends, few trails are needed.
#include "op/base/trails.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kerf::op_detail {
namespace {

constexpr std::size_t kMaxOrdered = 5000;  // nodes or groups among which the nearest is searched
constexpr double kLevelSlack = 1e-9;       // mm

double distance_to_chord(Point3 p, Point3 a, Point3 b) {
  const Point3 way = b - a;
  const double square = dot(way, way);
  const double t = square > 0.0 ? std::clamp(dot(p - a, way) / square, 0.0, 1.0) : 0.0;
  return distance(p, a + t * way);
}

class TrailOrder {
 public:
  explicit TrailOrder(const std::vector<TrailEdge>& edges) : edges_(edges), used_(edges.size(), false) {
    std::uint32_t nodes = 0;
    for (const TrailEdge& e : edges) nodes = std::max({nodes, e.from + 1, e.to + 1});
    at_.resize(nodes), open_.resize(nodes, 0);
    for (std::uint32_t i = 0; i < edges.size(); ++i)
      for (const std::uint32_t node : {edges[i].from, edges[i].to}) {
        at_[node].push_back(i);
        ++open_[node];
      }
    group_nodes(nodes);
  }

  std::size_t groups() const { return groups_.size(); }
  /// The group that has a node nearest to a point, of those that are left; it is taken.
  std::vector<std::uint32_t> take_group(std::optional<Point2> here) {
    std::size_t best = 0;
    double shortest = INFINITY;
    for (std::size_t i = 0; i < std::min(groups_.size(), kMaxOrdered) && here; ++i)
      if (const double d = distance(point(groups_[i].front()).xy(), *here); d < shortest)
        shortest = d, best = i;
    std::vector<std::uint32_t> taken = std::move(groups_[best]);
    groups_.erase(groups_.begin() + static_cast<std::ptrdiff_t>(best));
    return taken;
  }

  /// The next trail of a group; empty where all is taken.
  std::vector<Point3> take_trail(std::vector<std::uint32_t>& group, std::optional<Point2> here) {
    while (true) {
      // Of a large group, only the last nodes are examined.
      const auto window = group.end() - static_cast<std::ptrdiff_t>(std::min(group.size(), kMaxOrdered));
      const auto taken = [&](std::uint32_t node) { return open_[node] == 0; };
      group.erase(std::remove_if(window, group.end(), taken), group.end());
      if (group.empty()) return {};
      if (open_[group.back()] > 0) break;
    }
    std::uint32_t node = start_of(group, here);
    std::vector<Point3> trail;
    while (const auto next = next_edge(node, trail)) {
      const TrailEdge& edge = edges_[*next];
      used_[*next] = true;
      --open_[edge.from], --open_[edge.to];
      std::vector<Point3> points = edge.points;
      if (edge.from != node) std::reverse(points.begin(), points.end());
      node = edge.from != node ? edge.from : edge.to;
      trail.insert(trail.end(), points.begin() + (trail.empty() ? 0 : 1), points.end());
    }
    return trail;
  }

 private:
  Point3 point(std::uint32_t node) const {
    const TrailEdge& edge = edges_[at_[node].front()];
    return edge.from == node ? edge.points.front() : edge.points.back();
  }

  void group_nodes(std::uint32_t nodes) {
    std::vector<bool> seen(nodes, false);
    for (std::uint32_t first = 0; first < nodes; ++first) {
      if (seen[first] || at_[first].empty()) continue;
      std::vector<std::uint32_t> group{first};
      seen[first] = true;
      for (std::size_t k = 0; k < group.size(); ++k)
        for (const std::uint32_t e : at_[group[k]])
          for (const std::uint32_t node : {edges_[e].from, edges_[e].to})
            if (!seen[node]) seen[node] = true, group.push_back(node);
      groups_.push_back(std::move(group));
    }
  }

  /// An end of one open edge rather than a junction; of these, the nearest.
  std::uint32_t start_of(const std::vector<std::uint32_t>& group, std::optional<Point2> here) const {
    const auto rank = [&](std::uint32_t node) { return open_[node] == 1 ? 0 : open_[node] % 2 == 1 ? 1 : 2; };
    std::uint32_t best = group.back();
    double shortest = INFINITY;
    for (std::size_t i = group.size() - std::min(group.size(), kMaxOrdered); i < group.size(); ++i) {
      if (open_[group[i]] == 0) continue;
      const double d = here ? distance(point(group[i]).xy(), *here) : 0.0;
      if (rank(group[i]) > rank(best) || (rank(group[i]) == rank(best) && d >= shortest)) continue;
      best = group[i], shortest = d;
    }
    return best;
  }

  /// The edge that continues a trail with the least change of direction.
  std::optional<std::uint32_t> next_edge(std::uint32_t node, const std::vector<Point3>& trail) const {
    std::optional<std::uint32_t> best;
    double straightest = -INFINITY;
    for (const std::uint32_t i : at_[node]) {
      if (used_[i]) continue;
      double cosine = 0.0;
      if (const auto& p = edges_[i].points; trail.size() > 1 && p.size() > 1) {
        const Point3 way = edges_[i].from == node ? p[1] - p[0] : p[p.size() - 2] - p.back();
        const Point3 last = trail.back() - trail[trail.size() - 2];
        const double lengths = length(way) * length(last);
        cosine = lengths > 0.0 ? dot(way, last) / lengths : 0.0;
      }
      if (!best || cosine > straightest) best = i, straightest = cosine;
    }
    return best;
  }

  const std::vector<TrailEdge>& edges_;
  std::vector<bool> used_;
  std::vector<std::vector<std::uint32_t>> at_;  // edges by node
  std::vector<std::uint32_t> open_;             // edges not taken, by node
  std::vector<std::vector<std::uint32_t>> groups_;
};

/// The passes of a trail: those after the first only where it is deeper than the one before.
void cut_trail(Cutter& cutter, const std::vector<Point3>& trail, const CutOptions& options) {
  double lowest = options.top;
  for (const Point3& p : trail) lowest = std::min(lowest, p.z);
  std::vector<double> levels = pass_levels(options.top, options.depth, options.stepdown);
  // Up to the first level that is not above the lowest point.
  const auto last = std::find_if(levels.begin(), levels.end(), [&](double z) { return z <= lowest; });
  if (last != levels.end()) levels.erase(last + 1, levels.end());
  std::vector<Point3> points = with_crossings(trail, levels);
  double before = INFINITY;
  for (const double level : levels) {
    for (const auto& run : runs_below(points, before)) {
      if (cutter.full()) return;
      cut_points(cutter, run, level, options.top, options);
    }
    before = level;
    std::reverse(points.begin(), points.end());  // the next pass starts where this one ended
  }
}

}  // namespace

std::vector<Point3> with_crossings(const std::vector<Point3>& path, const std::vector<double>& levels) {
  std::vector<Point3> made;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0) {
      const Point3 a = path[i - 1], b = path[i];
      std::vector<double> at;
      for (const double z : levels)
        if ((a.z - z) * (b.z - z) < 0.0) at.push_back((z - a.z) / (b.z - a.z));
      std::sort(at.begin(), at.end());
      for (const double t : at) made.push_back(a + t * (b - a));
    }
    made.push_back(path[i]);
  }
  return made;
}

std::vector<std::vector<Point3>> runs_below(const std::vector<Point3>& path, double before) {
  std::vector<std::vector<Point3>> runs;
  std::vector<Point3> run;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i].z <= before + kLevelSlack) run.push_back(path[i]);
    const bool ends = i + 1 == path.size() || path[i].z > before + kLevelSlack ||
                      (path[i].z >= before - kLevelSlack && path[i + 1].z >= before - kLevelSlack);
    if (!ends) continue;
    // A run that only touches the level of the pass before is cut already.
    if (std::any_of(run.begin(), run.end(), [&](Point3 p) { return p.z < before - kLevelSlack; }))
      runs.push_back(run);
    run.clear();
  }
  return runs;
}

void cut_points(Cutter& cutter, const std::vector<Point3>& points, double level, double cleared,
                const CutOptions& options) {
  cutter.travel(points.front().xy(), cleared);
  cutter.rapid_down(cleared + options.clearance.mm());
  cutter.plunge(std::max(points.front().z, level));
  for (std::size_t i = 1; i < points.size() && !cutter.full(); ++i)
    cutter.slope({points[i].x, points[i].y, std::max(points[i].z, level)});
}

std::vector<Point3> simplified(const std::vector<Point3>& points, double tolerance) {
  if (points.size() < 3) return points;
  std::vector<bool> keep(points.size(), false);
  keep.front() = keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    double furthest = tolerance;
    std::size_t at = a;
    for (std::size_t i = a + 1; i < b; ++i)
      if (const double d = distance_to_chord(points[i], points[a], points[b]); d > furthest)
        furthest = d, at = i;
    if (at == a) continue;
    keep[at] = true;
    open.push_back({a, at}), open.push_back({at, b});
  }
  std::vector<Point3> made;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (keep[i]) made.push_back(points[i]);
  return made;
}

void cut_trails(Cutter& cutter, const std::vector<TrailEdge>& edges, const CutOptions& options) {
  TrailOrder order(edges);
  const auto here = [&]() -> std::optional<Point2> {
    const auto at = cutter.position();
    return at ? std::optional(at->xy()) : std::nullopt;
  };
  while (order.groups() > 0 && !cutter.full()) {
    std::vector<std::uint32_t> group = order.take_group(here());
    cutter.lift();
    while (!cutter.full()) {
      const std::vector<Point3> trail = order.take_trail(group, here());
      if (trail.empty()) break;
      cut_trail(cutter, trail, options);
    }
  }
}

}  // namespace kerf::op_detail

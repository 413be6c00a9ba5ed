// From the Voronoi diagram of a boundary's chords to the axis: edges outside of the region, and those that
// only separate chords of one curve, are left out; short ones are contracted; what touches the same two
// segments is one edge.
#include "geom/medial/medial_axis.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include "boundary_chords.h"
#include "geom/base/line_arc.h"

namespace kerf {
namespace {

using namespace medial_detail;

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr int kNearChords = 2;  // of one segment, between which there is no axis

class AxisMaker {
 public:
  AxisMaker(const BoundaryChords& boundary, const MedialOptions& options)
      : boundary_(boundary), options_(options) {}
  MedialAxis run();

 private:
  enum class Side : std::uint8_t { unknown, inside, outside };
  /// A site in mm: a point, or a line with the region on its left.
  struct SiteLine {
    Point2 from, to;
    bool is_point = false;
  };
  SiteLine line_of(const Site& site) const;
  Point2 contact(const Site& site, Point2 at) const;
  void find_sides();
  void spread_sides();
  bool is_axis(const VoronoiEdge& edge) const;
  bool are_near(const Site& a, const Site& b) const;
  bool on_one_segment(const Site& a, const Site& b) const;
  bool meet_smoothly(const VoronoiEdge& edge) const;
  BoundaryElement element_of(const Site& site) const;
  Point2 midpoint(const VoronoiEdge& edge) const;
  void add_points(const VoronoiEdge& edge, std::vector<MedialPoint>& points) const;

  std::uint32_t group(std::uint32_t vertex);
  bool join(std::uint32_t a, std::uint32_t b, double limit);
  void contract();
  void make_nodes();
  void make_edges();
  void follow(std::uint32_t first, bool forward, MedialAxis& made);

  const BoundaryChords& boundary_;
  const MedialOptions& options_;
  Voronoi diagram_;
  std::vector<Point2> at_;              // of the vertices, mm
  std::vector<double> radii_;           // of the vertices, mm
  std::vector<Side> sides_;             // of the edges
  std::vector<std::uint32_t> kept_;     // edges of the axis that are not contracted
  std::vector<std::uint32_t> same_as_;  // a forest: vertices that are one node
  std::vector<double> extent_;          // of a node's vertices from the one that remains, mm
  std::vector<std::uint32_t> node_of_;  // by the vertex that remains of a node
  std::vector<std::vector<std::uint32_t>>
      edges_at_;  // ends by node: twice the index in kept_, 1 more for its end
  std::vector<bool> used_;
  MedialAxis made_;
};

AxisMaker::SiteLine AxisMaker::line_of(const Site& site) const {
  const GridChord& c = boundary_.chords[site.chord];
  const auto at = [&](GridPoint p) {
    return boundary_.at({static_cast<double>(p.x), static_cast<double>(p.y)});
  };
  if (site.kind == Site::Kind::chord) return {at(c.from), at(c.to), false};
  const Point2 p = at(site.kind == Site::Kind::start ? c.from : c.to);
  return {p, p, true};
}

/// The point of a site that is nearest to a point of one of its edges.
Point2 AxisMaker::contact(const Site& site, Point2 at) const {
  const SiteLine line = line_of(site);
  return line.is_point ? line.from : nearest_point(line_between(line.from, line.to), at);
}

// --------------------------------------------------------------------------------------- inside and outside

/// Inside is the left of a chord; an edge between two points has the side of the edges that it meets.
void AxisMaker::find_sides() {
  sides_.assign(diagram_.edges.size(), Side::unknown);
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const VoronoiEdge& edge = diagram_.edges[i];
    for (const Site& site : {edge.left, edge.right}) {
      if (site.kind != Site::Kind::chord) continue;
      const SiteLine line = line_of(site);
      const Point2 v = line.to - line.from;
      const auto off = [&](std::uint32_t vertex) { return cross(v, at_[vertex] - line.from); };
      sides_[i] = off(edge.from) + off(edge.to) > 0.0 ? Side::inside : Side::outside;
      break;
    }
  }
  spread_sides();
}

void AxisMaker::spread_sides() {
  std::vector<Side> at_vertex(at_.size(), Side::unknown);
  const double on_boundary = 4.0 * boundary_.unit;
  std::vector<std::uint32_t> open;
  const auto mark = [&](const VoronoiEdge& edge, Side side) {
    for (const std::uint32_t v : {edge.from, edge.to})
      if (radii_[v] > on_boundary) at_vertex[v] = side;
  };
  for (std::uint32_t i = 0; i < sides_.size(); ++i) {
    if (sides_[i] == Side::unknown)
      open.push_back(i);
    else
      mark(diagram_.edges[i], sides_[i]);
  }
  for (std::size_t before = open.size() + 1; !open.empty() && open.size() < before;) {
    before = open.size();
    open.erase(std::remove_if(open.begin(), open.end(),
                              [&](std::uint32_t i) {
                                const VoronoiEdge& edge = diagram_.edges[i];
                                for (const std::uint32_t v : {edge.from, edge.to})
                                  if (at_vertex[v] != Side::unknown) sides_[i] = at_vertex[v];
                                if (sides_[i] == Side::unknown) return false;
                                mark(edge, sides_[i]);
                                return true;
                              }),
               open.end());
  }
}

// ----------------------------------------------------------------------------------------- edges of the axis

/// The segments that a site is part of: one, or two in a corner.
struct Segments {
  std::uint32_t first, second;
  bool has(std::uint32_t segment) const { return first == segment || second == segment; }
};
Segments segments_of(const BoundaryChords& boundary, const Site& site) {
  const std::uint32_t own = boundary.segments[site.chord];
  if (site.kind == Site::Kind::start) return {boundary.segments[boundary.previous[site.chord]], own};
  if (site.kind == Site::Kind::end) return {own, boundary.segments[boundary.next[site.chord]]};
  return {own, own};
}

/// Whether two sites are a few chords apart.
bool AxisMaker::are_near(const Site& a, const Site& b) const {
  std::uint32_t before = a.chord, after = a.chord;
  for (int i = 0; i <= kNearChords; ++i) {
    if (before == b.chord || after == b.chord) return true;
    before = boundary_.previous[before], after = boundary_.next[after];
  }
  return false;
}

/// Whether two sites belong to one curve and are near each other: between them there is no axis. Of an arc
/// that is nearly a circle, chords at both sides of its opening have an axis up to its centre.
bool AxisMaker::on_one_segment(const Site& a, const Site& b) const {
  const Segments one = segments_of(boundary_, a), other = segments_of(boundary_, b);
  const bool corners = one.first != one.second && other.first != other.second;
  // Two corners may be the ends of one segment.
  if (corners) return one.first == other.first && one.second == other.second;
  return (one.has(other.first) || one.has(other.second)) && are_near(a, b);
}

/// Whether an edge is the normal of the boundary where two segments are tangent, up to the centre of an arc:
/// both contacts are at the joint. The other contacts of such segments have an axis.
bool AxisMaker::meet_smoothly(const VoronoiEdge& edge) const {
  const double steps = boundary_.sources[boundary_.segments[edge.left.chord]].step +
                       boundary_.sources[boundary_.segments[edge.right.chord]].step;
  const double limit = std::min(2.0 * steps + 2.0 * options_.smooth.rad(), 0.25 * std::numbers::pi);
  const Point2 at = midpoint(edge);
  const Point2 a = contact(edge.left, at) - at, b = contact(edge.right, at) - at;
  const auto within = [&](Point2 u, Point2 v) {
    return std::abs(std::atan2(cross(u, v), dot(u, v))) <= limit;
  };
  if (!within(a, b)) return false;
  const Segments one = segments_of(boundary_, edge.left), other = segments_of(boundary_, edge.right);
  const auto joined = [&](std::uint32_t first, std::uint32_t second) {
    const SourceSegment& source = boundary_.sources[first];
    return source.smooth_end && source.next == second && within(a, source.end - at) &&
           within(b, source.end - at);
  };
  for (const std::uint32_t p : {one.first, one.second})
    for (const std::uint32_t q : {other.first, other.second})
      if (joined(p, q) || joined(q, p)) return true;
  return false;
}

bool AxisMaker::is_axis(const VoronoiEdge& edge) const {
  return !on_one_segment(edge.left, edge.right) && !meet_smoothly(edge);
}

BoundaryElement AxisMaker::element_of(const Site& site) const {
  const Segments own = segments_of(boundary_, site);
  const SourceSegment& source = boundary_.sources[own.first];
  return {source.loop, source.segment, site.kind != Site::Kind::chord && own.first != own.second};
}

/// A point of an edge between its ends.
Point2 AxisMaker::midpoint(const VoronoiEdge& edge) const {
  std::vector<MedialPoint> points;
  add_points(edge, points);
  const std::size_t half = points.size() / 2;
  return points.size() % 2 == 1 ? points[half].at : 0.5 * (points[half - 1].at + points[half].at);
}

/// The points of an edge from end to end. Between a point and a chord it is a parabola; between two points
/// the radius is that of a hyperbola.
void AxisMaker::add_points(const VoronoiEdge& edge, std::vector<MedialPoint>& points) const {
  constexpr int kMaxPoints = 1 << 10;
  const double axis = options_.axis.mm();
  const Point2 a = at_[edge.from], b = at_[edge.to];
  SiteLine focus = line_of(edge.left), other = line_of(edge.right);
  if (!focus.is_point) std::swap(focus, other);
  const auto add = [&](Point2 p, double radius) { points.push_back({p, mm(radius)}); };
  add(a, radii_[edge.from]);
  if (focus.is_point) {
    const bool parabola = !other.is_point;
    const Point2 along = parabola ? other.to - other.from : b - a;
    const double size = norm(along);
    if (size > 0.0) {
      const Point2 x = (1.0 / size) * along, y = left_of(x);
      // The parabola's height over its directrix at its vertex, or the distance of the points from the edge.
      const double h = std::abs(parabola ? cross(x, focus.from - other.from) : cross(x, focus.from - a));
      const double sign = parabola && cross(x, focus.from - other.from) < 0.0 ? -1.0 : 1.0;
      const double first = dot(x, a - focus.from), last = dot(x, b - focus.from);
      const double wanted = h > 0.0 ? std::abs(last - first) / std::sqrt(8.0 * h * axis) : 1.0;
      const int count = static_cast<int>(std::clamp(std::ceil(wanted), 1.0, static_cast<double>(kMaxPoints)));
      for (int i = 1; i < count; ++i) {
        const double u = first + (last - first) * i / count;
        if (parabola) {
          const double radius = 0.5 * (u * u / h + h);
          add(focus.from + u * x + sign * (radius - h) * y, radius);
        } else {
          add(a + (u - first) * x, std::hypot(u, h));
        }
      }
    }
  }
  add(b, radii_[edge.to]);
}

// ------------------------------------------------------------------------------------------- nodes and edges

std::uint32_t AxisMaker::group(std::uint32_t vertex) {
  while (same_as_[vertex] != vertex) vertex = same_as_[vertex] = same_as_[same_as_[vertex]];
  return vertex;
}

/// The vertex with the larger radius stays. False where it would be further than `limit` from one of the
/// others: a chain of short edges is not a point.
bool AxisMaker::join(std::uint32_t a, std::uint32_t b, double limit) {
  a = group(a);
  b = group(b);
  if (a == b) return true;
  if (radii_[a] < radii_[b]) std::swap(a, b);
  const double extent = std::max(extent_[a], norm(at_[a] - at_[b]) + extent_[b]);
  if (extent > limit) return false;
  same_as_[b] = a;
  extent_[a] = extent;
  return true;
}

/// Joins the ends of short edges to points, and finds the others. Parts of the region of which no edge is
/// left, as discs, have their vertex of the largest radius as a node.
void AxisMaker::contract() {
  std::vector<std::uint32_t> all(at_.size());  // joined by all edges inside
  std::iota(all.begin(), all.end(), 0u);
  same_as_ = all;
  extent_.assign(at_.size(), 0.0);
  for (std::uint32_t i = 0; i < sides_.size(); ++i)
    if (sides_[i] == Side::inside) join(diagram_.edges[i].from, diagram_.edges[i].to, INFINITY);
  std::swap(all, same_as_);
  extent_.assign(at_.size(), 0.0);
  const double limit = options_.nodes.mm();
  std::vector<bool> has_edge(at_.size(), false), is_inside(at_.size(), false);
  for (std::uint32_t i = 0; i < sides_.size(); ++i) {
    const VoronoiEdge& edge = diagram_.edges[i];
    if (sides_[i] != Side::inside) continue;
    is_inside[edge.from] = is_inside[edge.to] = true;
    if (!is_axis(edge)) continue;
    if (!join(edge.from, edge.to, limit)) kept_.push_back(i);
  }
  // Ends that others have joined since.
  std::erase_if(
      kept_, [&](std::uint32_t i) { return group(diagram_.edges[i].from) == group(diagram_.edges[i].to); });
  const auto root = [&](std::uint32_t vertex) {
    while (all[vertex] != vertex) vertex = all[vertex];
    return vertex;
  };
  for (const std::uint32_t i : kept_) has_edge[root(diagram_.edges[i].from)] = true;
  node_of_.assign(at_.size(), kNone);
  for (std::uint32_t v = 0; v < at_.size(); ++v)
    if (is_inside[v] && all[v] == v && !has_edge[v]) {
      node_of_[group(v)] = static_cast<std::uint32_t>(made_.nodes.size());
      made_.nodes.push_back({at_[v], mm(radii_[v])});
    }
}

void AxisMaker::make_nodes() {
  const auto node = [&](std::uint32_t vertex) {
    const std::uint32_t own = group(vertex);
    if (node_of_[own] == kNone) {
      node_of_[own] = static_cast<std::uint32_t>(made_.nodes.size());
      made_.nodes.push_back({at_[own], mm(radii_[own])});
    }
    return node_of_[own];
  };
  for (const std::uint32_t i : kept_)
    for (const std::uint32_t v : {diagram_.edges[i].from, diagram_.edges[i].to}) node(v);
  edges_at_.resize(made_.nodes.size());
  for (std::uint32_t k = 0; k < kept_.size(); ++k) {
    edges_at_[node(diagram_.edges[kept_[k]].from)].push_back(2 * k);
    edges_at_[node(diagram_.edges[kept_[k]].to)].push_back(2 * k + 1);
  }
}

/// Follows edges from one of them through nodes of two ends as long as both sides stay the same.
void AxisMaker::follow(std::uint32_t first, bool forward, MedialAxis& made) {
  const auto start_of = [&](std::uint32_t end) {
    const VoronoiEdge& edge = diagram_.edges[kept_[end >> 1]];
    return node_of_[group((end & 1) == 0 ? edge.from : edge.to)];
  };
  const auto sides_of = [&](std::uint32_t end) {
    const VoronoiEdge& edge = diagram_.edges[kept_[end >> 1]];
    const BoundaryElement left = element_of(edge.left), right = element_of(edge.right);
    return (end & 1) == 0 ? std::pair{left, right} : std::pair{right, left};
  };
  std::uint32_t end = 2 * first + (forward ? 0 : 1);  // where the next edge starts
  MedialEdge edge;
  edge.from = start_of(end);
  std::tie(edge.left, edge.right) = sides_of(end);
  while (true) {
    used_[end >> 1] = true;
    std::vector<MedialPoint> points;
    add_points(diagram_.edges[kept_[end >> 1]], points);
    if ((end & 1) != 0) std::reverse(points.begin(), points.end());
    // Contracted ends have the position of their node.
    edge.to = start_of(end ^ 1);
    points.front() = made.nodes[start_of(end)];
    points.back() = made.nodes[edge.to];
    edge.points.insert(edge.points.end(), points.begin() + (edge.points.empty() ? 0 : 1), points.end());
    const std::vector<std::uint32_t>& here = edges_at_[edge.to];
    if (here.size() != 2) break;
    const std::uint32_t next = here[0] == (end ^ 1) ? here[1] : here[0];
    if (used_[next >> 1] || sides_of(next) != std::pair{edge.left, edge.right}) break;
    end = next;
  }
  made.edges.push_back(std::move(edge));
}

/// First from nodes where edges start or change their sides, then what is left: closed curves.
void AxisMaker::make_edges() {
  used_.assign(kept_.size(), false);
  const auto sides = [&](std::uint32_t end) {
    const VoronoiEdge& edge = diagram_.edges[kept_[end >> 1]];
    const BoundaryElement left = element_of(edge.left), right = element_of(edge.right);
    return (end & 1) == 0 ? std::pair{left, right} : std::pair{right, left};
  };
  for (const std::vector<std::uint32_t>& ends : edges_at_) {
    const auto mirrored = [](const auto& pair) { return std::pair{pair.second, pair.first}; };
    if (ends.size() == 2 && sides(ends[0]) == mirrored(sides(ends[1]))) continue;
    for (const std::uint32_t end : ends)
      if (!used_[end >> 1]) follow(end >> 1, (end & 1) == 0, made_);
  }
  for (std::uint32_t k = 0; k < kept_.size(); ++k)
    if (!used_[k]) follow(k, true, made_);
}

/// Removes nodes that edges pass through.
void drop_unused_nodes(MedialAxis& axis, std::size_t alone) {
  std::vector<bool> used(axis.nodes.size(), false);
  std::fill(used.begin(), used.begin() + static_cast<std::ptrdiff_t>(alone), true);
  for (const MedialEdge& edge : axis.edges) used[edge.from] = used[edge.to] = true;
  std::vector<std::uint32_t> number(axis.nodes.size(), kNone);
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < axis.nodes.size(); ++i)
    if (used[i]) {
      axis.nodes[count] = axis.nodes[i];
      number[i] = count++;
    }
  axis.nodes.resize(count);
  for (MedialEdge& edge : axis.edges) {
    edge.from = number[edge.from];
    edge.to = number[edge.to];
  }
}

MedialAxis AxisMaker::run() {
  diagram_ = voronoi(boundary_.chords);
  at_.reserve(diagram_.vertices.size());
  for (const Point2 v : diagram_.vertices) at_.push_back(boundary_.at(v));
  radii_.assign(at_.size(), 0.0);
  for (const VoronoiEdge& edge : diagram_.edges)
    for (const std::uint32_t v : {edge.from, edge.to}) radii_[v] = norm(contact(edge.left, at_[v]) - at_[v]);
  find_sides();
  contract();
  const std::size_t alone = made_.nodes.size();
  make_nodes();
  make_edges();
  drop_unused_nodes(made_, alone);
  return std::move(made_);
}

}  // namespace

std::optional<MedialAxis> medial_axis(const Region& region, const MedialOptions& options,
                                      Diagnostics& diagnostics) {
  const auto boundary = boundary_chords(region, options, diagnostics);
  if (!boundary || stop_requested(options.region.progress)) return std::nullopt;
  if (boundary->chords.empty()) return MedialAxis{};
  return AxisMaker(*boundary, options).run();
}

std::optional<Circle> largest_inscribed_circle(const Region& region, const RegionOptions& options,
                                               Diagnostics& diagnostics) {
  const Length chord = options.tolerance.chord;
  const auto axis =
      medial_axis(region, {.region = options, .axis = 0.5 * chord, .nodes = 2.0 * chord}, diagnostics);
  if (!axis) return std::nullopt;
  const RegionSearch search(region);
  std::optional<Circle> best;
  const auto consider = [&](const MedialPoint& point) {
    // The axis is that of chords: only the boundary itself gives the radius.
    if (best && point.radius.mm() + 4.0 * options.tolerance.chord.mm() < best->radius.mm()) return;
    if (search.locate(point.at, {}) != Location::inside) return;
    const auto radius = search.clearance(point.at);
    if (radius && (!best || *radius > best->radius)) best = Circle{point.at, *radius};
  };
  for (const MedialPoint& node : axis->nodes) consider(node);
  for (const MedialEdge& edge : axis->edges)
    for (const MedialPoint& point : edge.points) consider(point);
  return best;
}

}  // namespace kerf

// Paths divided where they enter and leave a region.
#include <algorithm>
#include <cmath>

#include "boundary.h"
#include "crossing.h"
#include "geom/outline/outline_check.h"
#include "resolve.h"

namespace kerf {
namespace {

using namespace region_detail;

/// A part of a path's edge between two points where its location may change.
struct Stretch {
  std::uint32_t edge = 0;
  Point2 from, to;
  Location location = Location::outside;
};

/// The point at a fraction of the chord between two points of an edge.
Point2 point_between(const Edge& e, Point2 from, Point2 to, double fraction) {
  const Point2 p = from + fraction * (to - from);
  if (!e.is_arc()) return p;
  const Point2 centre = e.circle_centre(), out = p - centre;
  return centre + (e.radius / norm(out)) * out;
}

class PathDivider {
 public:
  PathDivider(const Outline& path, const Region& region, double weld) : path_(path), weld_(weld), set_(weld) {
    boundary_.add(region);
    add_outline(set_, path, 0, 0);
    if (path.closed()) set_.close();
  }
  std::vector<PathPiece> run();

 private:
  void cut(std::uint32_t edge, std::vector<Point2>& points) const;
  Location locate(const Stretch& stretch) const;
  void settle_short_ones();
  void append(const Stretch* first, const Stretch* last, std::vector<PathPiece>& made) const;
  Segment segment(const Stretch& first, const Stretch& last, Point2 from) const;

  const Outline& path_;
  double weld_;
  Boundary boundary_;
  EdgeSet set_;
  std::vector<Stretch> stretches_;
};

/// The contacts of an edge with the boundary, in order, with its ends.
void PathDivider::cut(std::uint32_t edge, std::vector<Point2>& points) const {
  const Edge& e = set_.edges[edge];
  points.assign(1, e.from);
  boundary_.tree.query(e.box(weld_), [&](std::uint32_t i) {
    Edge other = boundary_.set.edges[i];
    // The two sets number their points independently.
    other.from_point = other.to_point = 0xffffffffu;
    const Contacts m = contacts_of(e, other, weld_);
    if (m.first_has_from) points.push_back(other.from);
    if (m.first_has_to) points.push_back(other.to);
    points.insert(points.end(), m.at, m.at + m.crossings);
  });
  std::sort(points.begin() + 1, points.end(), [&](Point2 a, Point2 b) { return along(e, a) < along(e, b); });
  points.erase(
      std::unique(points.begin(), points.end(), [&](Point2 a, Point2 b) { return norm(b - a) <= weld_; }),
      points.end());
  while (points.size() > 1 && norm(e.to - points.back()) <= weld_) points.pop_back();
  points.push_back(e.to);
}

/// On the boundary where all of five points are; else that of the point furthest from it.
Location PathDivider::locate(const Stretch& s) const {
  double furthest = -1.0;
  Point2 chosen;
  for (const double fraction : {0.5, 0.21, 0.83, 0.05, 0.95}) {
    const Point2 p = point_between(set_.edges[s.edge], s.from, s.to, fraction);
    const auto nearest = boundary_.nearest(p);
    const double off = nearest ? nearest->distance.mm() : 2.0 * weld_ + 1.0;
    if (off > furthest) {
      furthest = off;
      chosen = p;
    }
    if (fraction == 0.5 && off > 4.0 * weld_) break;
  }
  return furthest <= 2.0 * weld_ ? Location::boundary : boundary_.locate(chosen, 0.0);
}

/// Stretches as short as the tolerance have the location of one beside them.
void PathDivider::settle_short_ones() {
  for (std::size_t i = 1; i < stretches_.size(); ++i)
    if (norm(stretches_[i].to - stretches_[i].from) <= 2.0 * weld_)
      stretches_[i].location = stretches_[i - 1].location;
  if (stretches_.size() > 1 && norm(stretches_[0].to - stretches_[0].from) <= 2.0 * weld_)
    stretches_[0].location = stretches_[1].location;
}

/// A segment along all stretches of one segment of the path.
Segment PathDivider::segment(const Stretch& first, const Stretch& last, Point2 from) const {
  const Edge& e = set_.edges[first.edge];
  Segment made{last.to, std::nullopt};
  const std::uint32_t source = e.source;
  // The end of a path is exactly that of the input.
  const bool is_end = last.edge + 1 == set_.edges.size() && last.to == e.to && !path_.closed();
  if (is_end) made.to = path_.segments.back().to;
  const auto carrier = outline_detail::make_carrier(path_.point(source), path_.segments[source], 0.0);
  if (carrier.is_arc() && distance(from, made.to) > 0.0)
    made.via =
        outline_detail::arc_midpoint(from, made.to, carrier.circle_centre(), carrier.radius, carrier.turn);
  return made;
}

void PathDivider::append(const Stretch* first, const Stretch* last, std::vector<PathPiece>& made) const {
  PathPiece& piece = made.emplace_back();
  piece.location = first->location;
  piece.first_segment = set_.edges[first->edge].source;
  piece.path.start = first->from;
  while (first != last) {
    const std::uint32_t source = set_.edges[first->edge].source;
    const Stretch* next = first + 1;
    while (next != last && set_.edges[next->edge].source == source) ++next;
    const Point2 from = piece.path.point(piece.path.segments.size());
    // A whole circle takes two segments.
    if (next - first > 1 && (next - 1)->to == from) {
      const Stretch* between = first + (next - first) / 2;
      piece.path.segments.push_back(segment(*first, *(between - 1), from));
      piece.path.segments.push_back(segment(*between, *(next - 1), piece.path.segments.back().to));
    } else {
      piece.path.segments.push_back(segment(*first, *(next - 1), from));
    }
    first = next;
  }
}

std::vector<PathPiece> PathDivider::run() {
  std::vector<Point2> points;
  for (std::uint32_t i = 0; i < set_.edges.size(); ++i) {
    cut(i, points);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      stretches_.push_back({i, points[k], points[k + 1], Location::outside});
      stretches_.back().location = locate(stretches_.back());
    }
  }
  settle_short_ones();
  std::vector<PathPiece> made;
  const auto differs = [&](std::size_t i, std::size_t k) {
    return stretches_[i].location != stretches_[k].location;
  };
  const std::size_t count = stretches_.size();
  if (path_.closed() && count > 0) {  // from where the location changes, if it does
    std::size_t start = 0;
    while (start < count && !differs(start, (start + count - 1) % count)) ++start;
    std::rotate(stretches_.begin(), stretches_.begin() + static_cast<std::ptrdiff_t>(start % count),
                stretches_.end());
  }
  for (std::size_t first = 0, next = 0; first < count; first = next) {
    while (next < count && !differs(first, next)) ++next;
    append(stretches_.data() + first, stretches_.data() + next, made);
  }
  return made;
}

}  // namespace

std::optional<std::vector<PathPiece>> divide(const Outline& path, const Region& region,
                                             const RegionOptions& options, Diagnostics& diagnostics) {
  if (!usable_loops(region.loops, options, diagnostics) ||
      !outline_detail::check_outline(path, options.name, options.where, diagnostics))
    return std::nullopt;
  double largest = largest_coordinate(path);
  for (const Outline& loop : region.loops) largest = std::max(largest, largest_coordinate(loop));
  return PathDivider(path, region, weld_for(options, largest)).run();
}

std::optional<std::vector<Outline>> clip(const Outline& path, const Region& region, Location wanted,
                                         const RegionOptions& options, Diagnostics& diagnostics) {
  auto pieces = divide(path, region, options, diagnostics);
  if (!pieces) return std::nullopt;
  std::vector<Outline> made;
  for (PathPiece& piece : *pieces)
    if (piece.location == wanted) made.push_back(std::move(piece.path));
  return made;
}

}  // namespace kerf

// Queries of regions: location and nearest points, the part of a circle inside, distances between regions,
// and self-intersections of outlines.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

#include "base/codes/outline.h"
#include "boundary.h"
#include "crossing.h"
#include "geom/outline/outline_check.h"
#include "resolve.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace region_detail {

void Boundary::add(const Region& region) {
  for (std::uint32_t loop = 0; loop < region.loops.size(); ++loop) {
    add_outline(set, region.loops[loop], static_cast<std::uint32_t>(sources_.size()), 0);
    set.close();
    for (std::uint32_t i = 0; i < region.loops[loop].segments.size(); ++i)
      sources_.push_back({{}, loop, i, {}});
  }
  tree = tree_of(set.edges, 0.0);
}

Location Boundary::locate(Point2 at, double weld) const {
  bool near = false;
  tree.query(Box2{at, at}.grown(weld),
             [&](std::uint32_t i) { near = near || distance_to(set.edges[i], at) <= weld; });
  if (near) return Location::boundary;
  return WindingSearch(set.edges, tree).around(at).of[0] > 0 ? Location::inside : Location::outside;
}

std::optional<BoundaryPoint> Boundary::nearest(Point2 at) const {
  std::optional<BoundaryPoint> best;
  tree.nearest({at, at}, std::numeric_limits<double>::infinity(), [&](std::uint32_t i) {
    const Edge& e = set.edges[i];
    const Point2 p = nearest_point(e, at);
    const double d = distance(p, at);
    if (!best || d < best->distance.mm()) {
      best = sources_[e.source];
      best->at = p;
      best->distance = mm(d);
    }
    return d;
  });
  return best;
}

}  // namespace region_detail

using namespace region_detail;

struct RegionSearch::Tree {
  Boundary boundary;
};

RegionSearch::RegionSearch(const Region& region) {
  const auto made = std::make_shared<Tree>();
  made->boundary.add(region);
  tree_ = made;
}

Location RegionSearch::locate(Point2 at, Length weld) const { return tree_->boundary.locate(at, weld.mm()); }

std::optional<BoundaryPoint> RegionSearch::nearest(Point2 at) const { return tree_->boundary.nearest(at); }

std::optional<Length> RegionSearch::clearance(Point2 at) const {
  const auto found = nearest(at);
  if (!found) return std::nullopt;
  return locate(at, {}) == Location::outside ? mm(-found->distance.mm()) : found->distance;
}

std::vector<AngleRange> RegionSearch::inside(const Circle& circle) const {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double r = circle.radius.mm();
  const Boundary& boundary = tree_->boundary;
  const Point2 right = circle.centre + Point2{r, 0.0};
  const LineArc whole{right, right, {-r, 0.0}, r, 1.0};
  const double margin = 0x1p-40 * (std::abs(circle.centre.x) + std::abs(circle.centre.y) + r);  // of rounding
  std::vector<double> angles{0.0, kTurn};
  boundary.tree.query(Box2{circle.centre, circle.centre}.grown(r), [&](std::uint32_t i) {
    const Edge& e = boundary.set.edges[i];
    const Crossings found = carriers_cross(whole, e, margin);
    for (int k = 0; k < found.count; ++k) {
      const Point2 out = found.at[k] - circle.centre;
      const double angle = std::atan2(out.y, out.x);
      if (touches(e, found.at[k], margin) >= 0.0) angles.push_back(angle < 0.0 ? angle + kTurn : angle);
    }
  });
  std::sort(angles.begin(), angles.end());
  std::vector<AngleRange> made;
  double end = -1.0;  // of the last range
  for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
    const double sweep = angles[i + 1] - angles[i];
    if (sweep * r <= margin) continue;
    const double between = angles[i] + 0.5 * sweep;
    if (locate(circle.centre + r * Point2{std::cos(between), std::sin(between)}, {}) != Location::inside)
      continue;
    if (end >= 0.0 && (angles[i] - end) * r <= margin)
      made.back().sweep = radians(angles[i + 1] - made.back().start.rad());
    else
      made.push_back({radians(angles[i]), radians(sweep)});
    end = angles[i + 1];
  }
  // A range that ends at a full turn continues at 0.
  if (made.size() > 1 && end == kTurn && made[0].start == radians(0.0)) {
    made.back().sweep = radians(made.back().sweep.rad() + made[0].sweep.rad());
    made.erase(made.begin());
  }
  return made;
}

Angle RegionSearch::engagement(const Circle& tool, Point2 direction) const {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double first = std::atan2(direction.y, direction.x) - 0.25 * kTurn;  // of the leading half
  double sum = 0.0;
  for (const AngleRange& range : inside(tool)) {
    double start = range.start.rad() - first;
    start -= kTurn * std::floor(start / kTurn);
    const double end = start + range.sweep.rad();
    sum += std::max(0.0, std::min(end, 0.5 * kTurn) - start);
    sum += std::max(0.0, std::min(end, 1.5 * kTurn) - kTurn);
  }
  return radians(sum);
}

// ------------------------------------------------------------------------------------------ between regions

std::optional<NearestPoints> nearest_points(const Region& first, const Region& second) {
  Boundary one, other;
  one.add(first);
  other.add(second);
  if (one.set.edges.empty() || other.set.edges.empty()) return std::nullopt;
  // Boundaries that do not intersect: a loop lies inside of the other region with all of its points.
  const auto start_inside = [](const Boundary& boundary, const Region& region) -> std::optional<Point2> {
    for (const Outline& loop : region.loops)
      if (boundary.locate(loop.start, 0.0) != Location::outside) return loop.start;
    return std::nullopt;
  };
  if (const auto common = start_inside(other, first)) return NearestPoints{*common, *common, {}};
  if (const auto common = start_inside(one, second)) return NearestPoints{*common, *common, {}};
  NearestPoints best;
  double least = std::numeric_limits<double>::infinity();
  for (const Edge& e : one.set.edges) {
    if (least == 0.0) break;
    other.tree.nearest(e.box(0.0), least, [&](std::uint32_t i) {
      const ClosestPoints found = closest_points(e, other.set.edges[i]);
      const double own = distance(found.first, found.second);
      if (own < least) {
        least = own;
        best = {found.first, found.second, mm(own)};
      }
      return own;
    });
  }
  return best;
}

// -------------------------------------------------------------------------------------- self-intersections

std::optional<std::vector<SelfIntersection>> self_intersections(const Outline& outline,
                                                                const RegionOptions& options,
                                                                Diagnostics& diagnostics) {
  if (!usable_options(options, diagnostics) ||
      !outline_detail::check_outline(outline, options.name, options.where, diagnostics))
    return std::nullopt;
  EdgeSet set(weld_for(options, largest_coordinate(outline)));
  add_outline(set, outline, 0, 0);
  if (outline.closed()) set.close();
  std::vector<SelfIntersection> found;
  const auto note = [&](Point2 at, const Edge& e, const Edge& f) {
    if (e.source != f.source)
      found.push_back({at, std::min(e.source, f.source), std::max(e.source, f.source)});
  };
  const bool all = tree_of(set.edges, set.weld()).pairs([&](std::uint32_t i, std::uint32_t j) {
    const Edge &e = set.edges[i], &f = set.edges[j];
    const Contacts m = contacts_of(e, f, set.weld());
    if (m.first_has_from) note(f.from, e, f);
    if (m.first_has_to) note(f.to, e, f);
    if (m.second_has_from) note(e.from, e, f);
    if (m.second_has_to) note(e.to, e, f);
    for (int k = 0; k < m.crossings; ++k) note(m.at[k], e, f);
    return found.size() < limits::kMaxSelfIntersections;
  });
  if (!all) {
    diagnostics.error(codes::region_too_complex, options.where,
                      "the outline intersects itself in too many points");
    return std::nullopt;
  }
  std::sort(found.begin(), found.end(), [](const SelfIntersection& a, const SelfIntersection& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  });
  // An end that touches two pieces of one arc is one intersection.
  found.erase(std::unique(found.begin(), found.end(),
                          [&](const SelfIntersection& a, const SelfIntersection& b) {
                            return a.first == b.first && a.second == b.second &&
                                   distance(a.at, b.at) <= set.weld();
                          }),
              found.end());
  return found;
}

}  // namespace kerf

// Questions about regions: inside or outside, the nearest point, and where an outline meets itself.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "crossing.h"
#include "geom/outline/outline_check.h"
#include "resolve.h"

#include "kerf/limits.h"

namespace kerf {
namespace {

using namespace region_detail;

Point2 nearest_on(const Edge& e, Point2 p) {
  const Point2 v = e.chord(), q = p - e.from;
  if (!e.is_arc()) return e.from + std::clamp(dot(q, v) / dot(v, v), 0.0, 1.0) * v;
  const Point2 out = q - e.centre, begin = Point2{} - e.centre, end = v - e.centre;
  // Less than half a turn: between the rays through both ends.
  const bool between = e.turn * cross(begin, out) >= 0.0 && e.turn * cross(out, end) >= 0.0;
  const double size = norm(out);
  if (between && size > 0.0) return e.from + e.centre + (e.radius / size) * out;
  return distance(p, e.from) < distance(p, e.to) ? e.from : e.to;
}

}  // namespace

struct RegionSearch::Tree {
  EdgeSet set{0.0};
  BoxTree boxes;
  std::vector<BoundaryPoint> sources;  // loop and segment by source
};

RegionSearch::RegionSearch(const Region& region) {
  const auto made = std::make_shared<Tree>();
  for (std::uint32_t loop = 0; loop < region.loops.size(); ++loop) {
    add_outline(made->set, region.loops[loop], static_cast<std::uint32_t>(made->sources.size()), 0);
    made->set.close();
    for (std::uint32_t i = 0; i < region.loops[loop].segments.size(); ++i)
      made->sources.push_back({{}, loop, i, {}});
  }
  made->boxes = tree_of(made->set.edges, 0.0);
  tree_ = made;
}

Location RegionSearch::locate(Point2 at, Length weld) const {
  const double margin = weld.mm();
  bool near = false;
  tree_->boxes.query(Box2{at, at}.grown(margin), [&](std::uint32_t i) {
    near = near || distance(nearest_on(tree_->set.edges[i], at), at) <= margin;
  });
  if (near) return Location::boundary;
  const WindingSearch search(tree_->set.edges, tree_->boxes);
  return search.around(at).of[0] > 0 ? Location::inside : Location::outside;
}

std::optional<BoundaryPoint> RegionSearch::nearest(Point2 at) const {
  std::optional<BoundaryPoint> best;
  tree_->boxes.nearest(at, std::numeric_limits<double>::infinity(), [&](std::uint32_t i) {
    const Edge& e = tree_->set.edges[i];
    const Point2 p = nearest_on(e, at);
    const double d = distance(p, at);
    if (!best || d < best->distance.mm()) {
      best = tree_->sources[e.source];
      best->at = p;
      best->distance = mm(d);
    }
    return d;
  });
  return best;
}

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
    const Meeting m = meet(e, f, set.weld());
    if (m.first_has_from) note(f.from, e, f);
    if (m.first_has_to) note(f.to, e, f);
    if (m.second_has_from) note(e.from, e, f);
    if (m.second_has_to) note(e.to, e, f);
    for (int k = 0; k < m.crossings; ++k) note(m.at[k], e, f);
    return found.size() < limits::kMaxSelfIntersections;
  });
  if (!all) {
    diagnostics.error(Code::region_too_complex, options.where, "the outline meets itself in too many places");
    return std::nullopt;
  }
  std::sort(found.begin(), found.end(), [](const SelfIntersection& a, const SelfIntersection& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  });
  // An end that touches two pieces of one arc is one meeting.
  found.erase(std::unique(found.begin(), found.end(),
                          [&](const SelfIntersection& a, const SelfIntersection& b) {
                            return a.first == b.first && a.second == b.second &&
                                   distance(a.at, b.at) <= set.weld();
                          }),
              found.end());
  return found;
}

}  // namespace kerf

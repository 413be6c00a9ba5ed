// The boundary of a sum of two connected regions is among the sums of their boundaries' segments.
#include <cmath>
#include <fmt/format.h>

#include "base/codes/outline.h"
#include "geom/offset/hull.h"

#include "kerf/geom/offset.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxPairs = 200'000;  // of segments: more take minutes

/// The circle of a region that is one.
std::optional<Circle> circle_of(const Region& region) {
  if (region.loops.size() != 1) return std::nullopt;
  std::optional<Circle> circle;
  Point2 from = region.loops[0].start;
  for (const Segment& s : region.loops[0].segments) {
    const auto arc = s.via ? arc_circle(from, s) : std::nullopt;
    if (!arc || arc->turn != Turn::ccw) return std::nullopt;
    if (!circle) circle = Circle{arc->centre, mm(arc->radius)};
    constexpr double kSame = 1e-9;  // mm
    if (distance(circle->centre, arc->centre) > kSame || std::fabs(circle->radius.mm() - arc->radius) > kSame)
      return std::nullopt;
    from = s.to;
  }
  return circle;
}

Region shifted(const Region& region, Point2 by) { return placed(region, Placement{by, {1.0, 1.0}}); }

std::vector<std::vector<Point2>> chords(const Region& region, Length chord) {
  std::vector<std::vector<Point2>> loops;
  for (const Outline& loop : region.loops) loops.push_back(flattened(loop, chord));
  return loops;
}

std::size_t count_of(const std::vector<std::vector<Point2>>& loops) {
  std::size_t count = 0;
  for (const auto& loop : loops) count += loop.size() - 1;
  return count;
}

/// All sums of points of two lines.
void add_parallelogram(std::vector<Region>& sums, Point2 corner, Point2 first, Point2 second) {
  const double size = cross(first, second);
  if (std::fabs(size) < 1e-12) return;
  if (size < 0.0) std::swap(first, second);
  Outline out{corner, {}};
  for (const Point2 p : {corner + first, corner + first + second, corner + second, corner})
    out.segments.push_back({p, {}});
  sums.push_back({{std::move(out)}});
}

/// Of connected regions.
std::optional<Region> sum_of(const Region& first, const Region& second, Length chord,
                             const RegionOptions& options, Diagnostics& diagnostics) {
  for (const auto& [circle, other] : {std::pair{circle_of(second), &first}, {circle_of(first), &second}}) {
    if (!circle) continue;
    auto grown = offset(*other, circle->radius, options, diagnostics);
    if (!grown) return std::nullopt;
    return shifted(grown->region, circle->centre);
  }
  const auto a = chords(first, chord), b = chords(second, chord);
  if (count_of(a) * count_of(b) > kMaxPairs) {
    diagnostics.error(codes::region_too_complex, options.where,
                      fmt::format("the Minkowski sum of outlines of {} and {} segments has too many pairs",
                                  count_of(a), count_of(b)));
    return std::nullopt;
  }
  std::vector<Region> sums{shifted(first, b[0][0]), shifted(second, a[0][0])};
  for (const auto& p : a)
    for (const auto& q : b)
      for (std::size_t i = 1; i < p.size(); ++i)
        for (std::size_t j = 1; j < q.size(); ++j)
          add_parallelogram(sums, p[i - 1] + q[j - 1], p[i] - p[i - 1], q[j] - q[j - 1]);
  return unite(sums, options, diagnostics);
}

}  // namespace

std::optional<Region> minkowski_sum(const Region& first, const Region& second, Length chord,
                                    const RegionOptions& options, Diagnostics& diagnostics) {
  std::vector<Region> parts;
  for (const Figure& a : figures(first))
    for (const Figure& b : figures(second)) {
      const auto x = make_region(a, options, diagnostics), y = make_region(b, options, diagnostics);
      if (!x || !y) return std::nullopt;
      auto sum = sum_of(*x, *y, chord, options, diagnostics);
      if (!sum) return std::nullopt;
      parts.push_back(std::move(*sum));
    }
  return unite(parts, options, diagnostics);
}

}  // namespace kerf

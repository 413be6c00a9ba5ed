// Lines and arcs along a polyline: from each point the longest stretch that one of them fits.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "arc_heights.h"
#include "fit_check.h"

#include "kerf/geom/fit.h"

namespace kerf {
namespace {

using namespace outline_detail;

/// Whether the chords between points from `first` to `last` are within `slack` of an arc through them.
bool chords_fit(const std::vector<Point2>& points, std::size_t first, std::size_t last, double radius,
                double slack) {
  for (std::size_t i = first; i < last; ++i) {
    const double half = 0.5 * distance(points[i], points[i + 1]);
    if (half > radius || half * half > slack * (radius + std::sqrt(radius * radius - half * half)))
      return false;
  }
  return true;
}

/// The point halfway along an arc over a stretch of points, nothing for a line; false if neither fits. One
/// half of the tolerance is for the points, the other for what the arc rises above the chords between them.
bool fit_stretch(const std::vector<Point2>& points, std::size_t first, std::size_t last, double within,
                 std::optional<Point2>& via) {
  ArcHeights heights(points[first], points[last]);
  if (!heights.has_chord()) return false;
  for (std::size_t i = first + 1; i < last; ++i)
    if (!heights.allow(points[i], 0.5 * within)) return false;
  via.reset();
  if (heights.allows_line()) return true;
  const double height = heights.mean();
  if (!chords_fit(points, first, last, heights.radius(height), 0.5 * within)) return false;
  via = heights.via(height);
  return true;
}

}  // namespace

std::optional<Outline> fit_arcs(const std::vector<Point2>& points, Length within, const FitOptions& options,
                                Diagnostics& diagnostics) {
  if (!check_fit(points, 2, within, options, diagnostics)) return std::nullopt;
  std::vector<Point2> distinct;
  for (const Point2 p : points)
    if (distinct.empty() || !(distinct.back() == p)) distinct.push_back(p);
  Outline made;
  made.start = distinct[0];
  if (distinct.size() == 1) made.segments.push_back({made.start, {}});
  for (std::size_t i = 0; i + 1 < distinct.size();) {
    std::optional<Point2> via;
    const std::size_t last = furthest(i + 1, distinct.size() - 1, [&](std::size_t to) {
      std::optional<Point2> found;
      if (!fit_stretch(distinct, i, to, within.mm(), found)) return false;
      via = found;
      return true;
    });
    made.segments.push_back({distinct[last], via});
    i = last;
  }
  return made;
}

}  // namespace kerf

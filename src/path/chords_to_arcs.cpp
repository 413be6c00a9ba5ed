// Chains of chords become arcs. A chain grows greedily: arcs are tried for doubled lengths, which are then
// halved, and one is kept if every point and every chord's midpoint lie within the tolerance.
//
// Two arcs are tried for each chain: that through its start, the point halfway and its end, which also finds
// arcs of more than 180 degrees, and if it fails the mean of all arcs near the points
// (geom/fit/arc_heights.h, which also fits arcs to points alone). A toolpath has further conditions: the tool
// must always move forward, corners stay, and helices rise evenly.
#include <cmath>
#include <numbers>
#include <optional>

#include "geom/fit/arc_heights.h"
#include "path/chain.h"

#include "kerf/path/passes.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxChain = 4096;               // chords of one arc
constexpr double kMaxStep = 0.8;                      // radians that one chord may span; more is a corner
constexpr double kMaxSweep = 1.9 * std::numbers::pi;  // an arc that nearly closes is ill defined

class Fitter {
 public:
  Fitter(const Toolpath& path, const ArcFitOptions& options) : path_(path), options_(options) {}

  /// The longest arc that starts at `from` with step `first`; its last step is put in `last`.
  std::optional<LineArc> longest(Point3 from, std::size_t first, std::size_t& last) const;

 private:
  std::optional<LineArc> fit(Point3 from, std::size_t first, std::size_t last) const;
  std::optional<LineArc> mean_arc(Point3 from, std::size_t first, std::size_t last) const;
  bool holds(const LineArc& arc, Point3 from, std::size_t first, std::size_t last) const;

  const Toolpath& path_;
  const ArcFitOptions& options_;
};

std::optional<LineArc> Fitter::fit(Point3 from, std::size_t first, std::size_t last) const {
  const auto kept = [&](const LineArc& arc) {
    return arc.radius <= options_.largest_radius.mm() && arc.radius >= options_.tolerance.mm() &&
           holds(arc, from, first, last);
  };
  constexpr double kStraight = 1e-9;  // radians
  const Point2 start = from.xy(), end = path_[last].to().xy();
  const Point2 halfway = path_[first + (last - first) / 2].to().xy();
  const CircleThrough circle = circle_through(halfway - start, end - start, kStraight);
  const LineArc through{start, end, circle.centre, length(circle.centre), circle.turn};
  if (through.is_arc() && kept(through)) return through;
  const std::optional<LineArc> between = mean_arc(from, first, last);
  return between && kept(*between) ? between : std::nullopt;
}

/// The mean of the arcs that pass near all points and midpoints of chords.
std::optional<LineArc> Fitter::mean_arc(Point3 from, std::size_t first, std::size_t last) const {
  const double tolerance = options_.tolerance.mm();
  ArcHeights heights(from.xy(), path_[last].to().xy());
  if (!heights.has_chord()) return std::nullopt;
  Point2 at = from.xy();
  for (std::size_t i = first; i <= last; ++i) {
    const Point2 to = path_[i].to().xy();
    if (!heights.allow(0.5 * (at + to), tolerance) || (i < last && !heights.allow(to, tolerance)))
      return std::nullopt;
    at = to;
  }
  const double height = heights.mean();
  return height != 0.0 ? std::optional(heights.arc(height)) : std::nullopt;
}

bool Fitter::holds(const LineArc& arc, Point3 from, std::size_t first, std::size_t last) const {
  const double tolerance = options_.tolerance.mm();
  const Point2 centre = arc.circle_centre();
  Point3 start = from;
  double swept = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    const Point3 end = path_[i].to();
    const Point2 a = start.xy() - centre, b = end.xy() - centre;
    const double step = arc.turn * std::atan2(cross(a, b), dot(a, b));
    if (!(step > 0.0) || step > kMaxStep) return false;
    if (std::abs(length(0.5 * (a + b)) - arc.radius) > tolerance) return false;
    swept += step;
    start = end;
  }
  if (swept > kMaxSweep) return false;
  // A helix rises evenly; how far a point lies aside and above count together.
  const double rise = path_[last].to().z - from.z;
  double turned = 0.0;
  start = from;
  for (std::size_t i = first; i <= last; ++i) {
    const Point2 a = start.xy() - centre, b = path_[i].to().xy() - centre;
    turned += arc.turn * std::atan2(cross(a, b), dot(a, b));
    const double aside = length(b) - arc.radius, above = from.z + rise * turned / swept - path_[i].to().z;
    if (std::hypot(aside, above) > tolerance) return false;
    start = path_[i].to();
  }
  return true;
}

std::optional<LineArc> Fitter::longest(Point3 from, std::size_t first, std::size_t& last) const {
  std::size_t end = first;  // of the run of steps that may be put together
  while (end - first < kMaxChain && detail::chains(path_, end + 1, first)) ++end;
  const std::size_t fewest = std::max<std::size_t>(options_.fewest, 3);
  if (end + 1 - first < fewest) return std::nullopt;
  std::optional<LineArc> best = fit(from, first, first + fewest - 1);
  if (!best) return std::nullopt;
  last = furthest(first + fewest - 1, end, [&](std::size_t to) {
    const std::optional<LineArc> longer = fit(from, first, to);
    if (longer) best = longer;
    return longer.has_value();
  });
  return best;
}

}  // namespace

PassResult chords_to_arcs(const Toolpath& path, const ArcFitOptions& options) {
  Toolpath out;
  detail::StartPosition from;
  const Fitter fitter(path, options);
  for (std::size_t i = 0; i < path.size(); ++i) {
    std::optional<LineArc> fit;
    std::size_t last = i;
    if (path[i].kind() == StepKind::cut && from.is_known() && detail::is_plain(path, i))
      fit = fitter.longest(from.at, i, last);
    if (fit)
      out.add(step::Arc{.to = path[last].to(),
                        .centre = fit->circle_centre(),
                        .turn = fit->turn > 0.0 ? Turn::ccw : Turn::cw,
                        .feed = path[i].feed()},
              out.copy_origin(path, i));
    else
      out.add_copy(path, i);
    i = last;
    from.pass(path[i]);
  }
  return detail::finished(path, std::move(out));
}

}  // namespace kerf

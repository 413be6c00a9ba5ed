// Chains of chords become arcs. A chain grows greedily: an arc through its begin, a point in its middle and
// its end is tried for doubled lengths and then narrowed down, and kept if every point and every chord's
// middle lie within the tolerance.
#include <cmath>
#include <numbers>
#include <optional>

#include "path/chain.h"

#include "kerf/passes.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxChain = 4096;               // chords of one arc
constexpr double kMaxStep = 0.8;                      // radians that one chord may span; more is a corner
constexpr double kMaxSweep = 1.9 * std::numbers::pi;  // an arc that nearly closes is ill defined

struct Fit {
  Point2 centre;
  double radius = 0.0;
  Turn turn = Turn::ccw;
};

std::optional<Fit> circle_through(Point2 a, Point2 b, Point2 c) {
  const Point2 ab = b - a, ac = c - a;
  const double area = 2.0 * cross(ab, ac);
  if (std::abs(area) < 1e-12 * (dot(ab, ab) + dot(ac, ac))) return std::nullopt;
  const double k = dot(ab, ab), m = dot(ac, ac);
  const Point2 centre{(ac.y * k - ab.y * m) / area, (ab.x * m - ac.x * k) / area};
  return Fit{a + centre, length(centre), area > 0.0 ? Turn::ccw : Turn::cw};
}

class Fitter {
 public:
  Fitter(const Toolpath& path, const ArcFitOptions& options) : path_(path), options_(options) {}

  /// The longest arc that begins at `from` with step `first`; its last step is put in `last`.
  std::optional<Fit> longest(Point3 from, std::size_t first, std::size_t& last) const;

 private:
  std::optional<Fit> fit(Point3 from, std::size_t first, std::size_t last) const;
  bool holds(const Fit& fit, Point3 from, std::size_t first, std::size_t last) const;

  const Toolpath& path_;
  const ArcFitOptions& options_;
};

std::optional<Fit> Fitter::fit(Point3 from, std::size_t first, std::size_t last) const {
  const Point2 middle = path_[first + (last - first) / 2].to().xy();
  const auto fit = circle_through(from.xy(), middle, path_[last].to().xy());
  if (!fit || fit->radius > options_.largest_radius.mm() || fit->radius < options_.tolerance.mm())
    return std::nullopt;
  return holds(*fit, from, first, last) ? fit : std::nullopt;
}

bool Fitter::holds(const Fit& fit, Point3 from, std::size_t first, std::size_t last) const {
  const double tolerance = options_.tolerance.mm();
  const double sign = fit.turn == Turn::ccw ? 1.0 : -1.0;
  Point3 begin = from;
  double swept = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    const Point3 end = path_[i].to();
    const Point2 a = begin.xy() - fit.centre, b = end.xy() - fit.centre;
    const double step = sign * std::atan2(cross(a, b), dot(a, b));
    if (!(step > 0.0) || step > kMaxStep) return false;
    if (std::abs(length(0.5 * (a + b)) - fit.radius) > tolerance) return false;
    swept += step;
    begin = end;
  }
  if (swept > kMaxSweep) return false;
  // A helix rises evenly; how far a point lies aside and above count together.
  const double rise = path_[last].to().z - from.z;
  double turned = 0.0;
  begin = from;
  for (std::size_t i = first; i <= last; ++i) {
    const Point2 a = begin.xy() - fit.centre, b = path_[i].to().xy() - fit.centre;
    turned += sign * std::atan2(cross(a, b), dot(a, b));
    const double aside = length(b) - fit.radius, above = from.z + rise * turned / swept - path_[i].to().z;
    if (std::hypot(aside, above) > tolerance) return false;
    begin = path_[i].to();
  }
  return true;
}

std::optional<Fit> Fitter::longest(Point3 from, std::size_t first, std::size_t& last) const {
  std::size_t end = first;  // of the run of steps that may be put together
  while (end - first < kMaxChain && detail::chains(path_, end + 1, first)) ++end;
  const std::size_t fewest = std::max<std::size_t>(options_.fewest, 3);
  if (end + 1 - first < fewest) return std::nullopt;
  std::size_t good = first + fewest - 1;
  std::optional<Fit> best = fit(from, first, good);
  if (!best) return std::nullopt;
  for (std::size_t stride = 1; stride > 0;) {  // doubled while it holds, then halved
    const std::size_t trial = good + stride;
    const auto longer = trial <= end ? fit(from, first, trial) : std::nullopt;
    if (longer) {
      best = longer;
      good = trial;
      stride *= 2;
    } else {
      stride /= 2;
    }
  }
  last = good;
  return best;
}

}  // namespace

PassResult fit_arcs(const Toolpath& path, const ArcFitOptions& options) {
  Toolpath out;
  detail::Begin begin;
  const Fitter fitter(path, options);
  for (std::size_t i = 0; i < path.size(); ++i) {
    std::optional<Fit> fit;
    std::size_t last = i;
    if (path[i].kind() == StepKind::cut && begin.known() && detail::is_plain(path, i))
      fit = fitter.longest(begin.at, i, last);
    if (fit)
      out.add(
          step::Arc{.to = path[last].to(), .centre = fit->centre, .turn = fit->turn, .feed = path[i].feed()},
          out.copy_origin(path, i));
    else
      out.add_copy(path, i);
    i = last;
    begin.pass(path[i]);
  }
  return detail::finished(path, std::move(out));
}

}  // namespace kerf

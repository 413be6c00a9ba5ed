// The minimum of the distance along the path of a slope or plunge. For a convex tool the distance is a convex
// function of the path parameter t: Newton's method finds its minimum where it is smooth; where it has a kink
// (two parts of the profile at equal distance), the minimum is the intersection of two parabolas. For other
// tools the path is sampled first, and the minimum is refined between samples.
#include "sim/exact/sweep_distance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kerf::sim {
namespace {

/// A range of the path parameter t.
struct PathRange {
  double first = 0.0, last = 0.0;
  bool empty() const { return !(first <= last); }
  double width() const { return last - first; }
  double clamp(double t) const { return std::clamp(t, first, last); }
};

/// Spacing of the samples for a tool that is not convex, as a fraction of its radius, and their maximum
/// number; also the maximum number of iterations of a search.
constexpr double kSampleSpacing = 0.25;
constexpr int kMaxSamples = 64;
/// A search ends when the minimum can be lower by this at max_curvature, mm, or when the range is this short,
/// mm.
constexpr double kDistanceTolerance = 1e-9;
constexpr double kPathTolerance = 1e-7;
/// Maximum error of a parabola that replaces the distance, mm, and the maximum slope at which it may.
constexpr double kParabolaTolerance = 2e-8;
constexpr double kSmallSlope = 1e-2;

/// The function is smooth in a range if both second derivatives predict the change of slope across it with a
/// summed error below this fraction of that change.
constexpr double kSmoothDeviation = 0.5;
/// Both sides of a kink are nearly straight: their slopes change by less than this fraction of the kink's.
constexpr double kStraightFraction = 0.1;
/// Newton iterations for the intersection of two parabolas.
constexpr int kKinkIterations = 3;
/// Factor by which the maximum step grows while the minimum is not bracketed.
constexpr double kStrideGrowth = 8.0;
/// The first step of a search from a known result is limited to the distance that the point has moved, but
/// to this at least, mm.
constexpr double kMinStride = 1e-3;

/// Distance of a query point to the tool as a function of the path parameter of a straight sweep.
class PathSearch {
 public:
  PathSearch(const Sweep& sweep, const ToolDistance& tool, Point3 point)
      : sweep_(sweep), tool_(tool), point_(point), is_plunge_(sweep.length <= 0.0) {}

  struct Sample {
    Distance distance;
    double by_t = 0.0, by_tt = 0.0;  // first and second derivative by the path parameter
  };
  Sample at(double t) const;
  /// The range outside which the tool is further away than `reach`.
  PathRange range_within(double reach) const;
  /// Start value for the search.
  double guess() const;
  double sample_spacing() const { return kSampleSpacing * std::max(tool_.rim(), kPathTolerance); }
  /// Width of a range in which parabolas from both ends are within kParabolaTolerance of the distance.
  double parabola_width() const { return std::cbrt(6.0 * kParabolaTolerance * tool_.rim() * tool_.rim()); }
  /// Distance that the tool moves per mm of the path parameter.
  double per_mm() const { return is_plunge_ ? 1.0 : std::sqrt(1.0 + sweep_.slope * sweep_.slope); }
  /// The change of the path parameter that projects a displacement onto the path.
  double projection_on_path(Point3 moved) const;

  /// The minimum in a range in which there is only one, from `guess` with steps of up to `stride` at first.
  /// Stops early if the minimum cannot be below `enough`.
  PathDistance minimum(PathRange range, double guess, double stride, double enough) const;
  PathDistance minimum_of_samples(PathRange range, double enough) const;

 private:
  const Sweep& sweep_;
  const ToolDistance& tool_;
  Point3 point_;
  bool is_plunge_;
};

PathSearch::Sample PathSearch::at(double t) const {
  const double x = is_plunge_ ? sweep_.x : sweep_.x + t * sweep_.ux;
  const double y = is_plunge_ ? sweep_.y : sweep_.y + t * sweep_.uy;
  const double z = is_plunge_ ? t : sweep_.z + t * sweep_.slope;
  const double dx = point_.x - x, dy = point_.y - y, rho = std::sqrt(dx * dx + dy * dy);
  const ProfileDistance profile = tool_.at(rho, point_.z - z);
  const double per_rho = rho > 0.0 ? 1.0 / rho : 0.0, by_rho = profile.by_r * per_rho;
  // Velocity of the point in the tool's half plane, relative to the tool, as t increases by 1.
  const double in_plan = is_plunge_ ? 0.0 : 1.0, rise = is_plunge_ ? 1.0 : sweep_.slope;
  const double out = -in_plan * per_rho * (dx * sweep_.ux + dy * sweep_.uy);
  const double across = profile.by_r * rise + profile.by_z * out;
  Sample sample;
  sample.distance = {profile.value, {by_rho * dx, by_rho * dy, profile.by_z}};
  sample.by_t = profile.by_r * out - profile.by_z * rise;
  sample.by_tt = by_rho * (in_plan - out * out) + profile.curvature * across * across;
  return sample;
}

PathRange PathSearch::range_within(double reach) const {
  const double wide = tool_.rim() + reach;
  const double dx = point_.x - sweep_.x, dy = point_.y - sweep_.y;
  const double along = dx * sweep_.ux + dy * sweep_.uy, across = dx * sweep_.uy - dy * sweep_.ux;
  if (is_plunge_) {
    if (dx * dx + dy * dy > wide * wide) return {1.0, 0.0};
    const double low = std::min(sweep_.z, sweep_.z_end), high = std::max(sweep_.z, sweep_.z_end);
    return {low, std::max(low, std::min(high, point_.z - tool_.bottom() + reach))};
  }
  const double half2 = wide * wide - across * across;
  if (half2 < 0.0) return {1.0, 0.0};
  const double half = std::sqrt(half2);
  return {std::max(0.0, along - half), std::min(sweep_.length, along + half)};
}

/// Nearest to the centre of a ball of the tool's radius: exact for ball-nose tools, close for others.
double PathSearch::guess() const {
  const Point3 centre{sweep_.x, sweep_.y, (is_plunge_ ? 0.0 : sweep_.z) + tool_.bottom() + tool_.rim()};
  return projection_on_path(point_ - centre);
}

double PathSearch::projection_on_path(Point3 moved) const {
  if (is_plunge_) return moved.z;
  return (moved.x * sweep_.ux + moved.y * sweep_.uy + moved.z * sweep_.slope) /
         (1.0 + sweep_.slope * sweep_.slope);
}

/// Two samples with the minimum between them.
struct Bracket {
  PathSearch::Sample first, last;
  double width = 0.0;

  /// Whether the distance is smooth between them.
  bool is_smooth() const {
    const double slope_change = last.by_t - first.by_t;
    return std::abs(first.by_tt * width - slope_change) + std::abs(last.by_tt * width - slope_change) <
           kSmoothDeviation * slope_change;
  }
  /// Whether both sides of a kink between them are nearly straight.
  bool is_kink() const {
    return std::max(std::abs(first.by_tt), std::abs(last.by_tt)) * width <
           kStraightFraction * (last.by_t - first.by_t);
  }
  /// An estimate of the distance, and its parameter from the first sample.
  struct Estimate {
    double t, value;
  };
  /// The intersection of the tangents: a convex function is not below them.
  Estimate lower_bound() const {
    const double drop = last.distance.value - first.distance.value;
    const double at = (last.by_t * width - drop) / (last.by_t - first.by_t);
    return {at, first.distance.value + first.by_t * at};
  }
  /// The intersection of the parabolas from both ends: the position of a kink.
  Estimate kink() const {
    // A stronger curvature would change the slope by more than the kink does: ignore it.
    const double max_curvature = (last.by_t - first.by_t) / width;
    const double first_tt = first.by_tt < max_curvature ? first.by_tt : 0.0;
    const double last_tt = last.by_tt < max_curvature ? last.by_tt : 0.0;
    double at = lower_bound().t, value = 0.0;
    for (int n = 0; n < kKinkIterations; ++n) {
      const double back = at - width;
      value = first.distance.value + at * (first.by_t + 0.5 * first_tt * at);
      const double other = last.distance.value + back * (last.by_t + 0.5 * last_tt * back);
      const double closing = first.by_t + first_tt * at - last.by_t - last_tt * back;
      if (closing < 0.0) at = std::clamp(at - (value - other) / closing, 0.0, width);
    }
    return {at, value};
  }
  /// Gradient at a kink: as the query point moves, the minimum follows the intersection of both sides.
  Point3 gradient() const {
    const double slope_change = last.by_t - first.by_t;
    return (last.by_t / slope_change) * first.distance.gradient -
           (first.by_t / slope_change) * last.distance.gradient;
  }
};

/// Newton's method, kept within the bracket [range.first, range.last] that each sample narrows. Until both
/// ends are bracketed the steps are limited to `stride`, which grows.
PathDistance PathSearch::minimum(PathRange range, double guess, double stride, double enough) const {
  Bracket bracket;
  bool has_first = false, has_last = false;
  PathDistance best;
  double t = range.clamp(guess);
  for (int n = 0; n < kMaxSamples; ++n) {
    const Sample sample = at(t);
    if (sample.distance.value < best.distance.value) best = {sample.distance, t};
    if (sample.by_t >= 0.0) {
      range.last = t;
      bracket.last = sample;
      has_last = true;
    }
    if (sample.by_t <= 0.0) {
      range.first = t;
      bracket.first = sample;
      has_first = true;
    }
    const double width = bracket.width = range.width();
    if (!(width > kPathTolerance)) break;
    const double step = sample.by_tt > 0.0 ? -sample.by_t / sample.by_tt : std::copysign(width, -sample.by_t);
    const bool is_inside = range.first < t + step && t + step < range.last;
    const double gain = -0.5 * sample.by_t * step;
    if (is_inside && gain <= kParabolaTolerance && std::abs(sample.by_t) <= kSmallSlope) {
      if (sample.distance.value <= best.distance.value) best.distance.value -= gain;
      break;
    }
    if (!has_first || !has_last) {
      const double lowest = sample.distance.value - std::abs(sample.by_t) * width;
      if (best.distance.value - lowest <= kDistanceTolerance || lowest >= enough) break;
      t = range.clamp(t + std::clamp(step, -stride, stride));
      stride *= kStrideGrowth;
      continue;
    }
    const double lowest = bracket.lower_bound().value;
    if (lowest >= enough) break;
    if (best.distance.value - lowest <= kDistanceTolerance) {
      best.distance.gradient = bracket.gradient();
      break;
    }
    if (is_inside && bracket.is_smooth()) {
      t += step;
      continue;
    }
    const Bracket::Estimate kink = bracket.kink();
    const double close = parabola_width();
    if (width <= close && bracket.is_kink() && kink.value <= best.distance.value)
      return {{kink.value, bracket.gradient()}, range.first + kink.t};
    // Slightly beyond the kink as seen from the nearer end, so that the other end moves close to it too.
    const double beyond = kink.t < 0.5 * width ? 0.4 * close : -0.4 * close;
    t = range.first + std::clamp(kink.t + beyond, 0.01 * width, 0.99 * width);
  }
  return best;
}

/// Between adjacent samples there is at max_curvature one minimum, as they are close together.
PathDistance PathSearch::minimum_of_samples(PathRange range, double enough) const {
  const double wanted = std::ceil(range.width() / sample_spacing());
  const int pieces = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(kMaxSamples)));
  const auto position = [&](int k) { return range.first + range.width() * k / pieces; };
  PathDistance best;
  const auto take = [&](const PathDistance& found) {
    if (found.distance.value < best.distance.value) best = found;
  };
  Sample before = at(range.first);
  take({before.distance, range.first});
  for (int k = 1; k <= pieces; ++k) {
    const Sample sample = at(position(k));
    take({sample.distance, position(k)});
    if (before.by_t < 0.0 && sample.by_t > 0.0)
      take(minimum({position(k - 1), position(k)}, 0.5 * (position(k - 1) + position(k)), sample_spacing(),
                   std::min(enough, best.distance.value)));
    before = sample;
  }
  return best;
}

}  // namespace

Point2 nearest_in_plan(const Sweep& sweep, Point2 point) {
  const double dx = point.x - sweep.x, dy = point.y - sweep.y;
  if (!sweep.is_arc) {
    const double t = std::clamp(dx * sweep.ux + dy * sweep.uy, 0.0, sweep.length);
    return {sweep.x + t * sweep.ux, sweep.y + t * sweep.uy};
  }
  const double rho = std::sqrt(dx * dx + dy * dy);
  const double c = std::cos(sweep.turn), s = std::sin(sweep.turn);
  // In the arc's direction of rotation: at or after its start angle, at or before its end angle.
  const double sense = sweep.turn < 0.0 ? -1.0 : 1.0;
  const double along = sweep.ux * dx + sweep.uy * dy, across = sense * (sweep.ux * dy - sweep.uy * dx);
  const bool after_start = across >= 0.0, before_end = sense * s * along - c * across >= 0.0;
  const double turn = std::abs(sweep.turn);
  const bool between = turn >= 2.0 * std::numbers::pi ||
                       (turn <= std::numbers::pi ? after_start && before_end : after_start || before_end);
  if (between && rho > 0.0) return {sweep.x + dx / rho * sweep.radius, sweep.y + dy / rho * sweep.radius};
  // Outside the arc's angles: the nearer end point.
  const Point2 start{sweep.x + sweep.radius * sweep.ux, sweep.y + sweep.radius * sweep.uy};
  const Point2 end{sweep.x + sweep.radius * (c * sweep.ux - s * sweep.uy),
                   sweep.y + sweep.radius * (s * sweep.ux + c * sweep.uy)};
  return distance(start, point) <= distance(end, point) ? start : end;
}

Distance distance_to_level(const ToolDistance& tool, Point2 nearest, double z, Point3 point) {
  const double dx = point.x - nearest.x, dy = point.y - nearest.y, rho = std::sqrt(dx * dx + dy * dy);
  const ProfileDistance profile = tool.at(rho, point.z - z);
  const double per_rho = rho > 0.0 ? profile.by_r / rho : 0.0;
  return {profile.value, {per_rho * dx, per_rho * dy, profile.by_z}};
}

PathDistance distance_along(const Sweep& sweep, const ToolDistance& tool, Point3 point, double reach,
                            double enough) {
  const PathSearch search(sweep, tool, point);
  const PathRange range = search.range_within(reach);
  if (range.empty()) return {};
  return tool.is_convex() ? search.minimum(range, search.guess(), search.sample_spacing(), enough)
                          : search.minimum_of_samples(range, enough);
}

PathDistance distance_beside(const Sweep& sweep, const ToolDistance& tool, Point3 point, double reach,
                             const PathDistance& known, Point3 moved, double enough) {
  const PathSearch search(sweep, tool, point);
  const PathRange range = search.range_within(reach);
  if (range.empty()) return {};
  // There may be several minima, and another one may now be the lowest.
  if (!tool.is_convex()) return search.minimum_of_samples(range, enough);
  const double guess = known.t + search.projection_on_path(moved);
  return search.minimum(range, guess, std::max(length(moved), kMinStride), enough);
}

DistanceBounds bounds_of_distance(const Sweep& sweep, const ToolDistance& tool, Point3 point, double reach) {
  const PathSearch search(sweep, tool, point);
  const PathRange range = search.range_within(reach);
  if (range.empty()) return {};
  const double t = range.clamp(search.guess());
  const PathSearch::Sample sample = search.at(t);
  const double value = sample.distance.value;
  if (tool.is_convex())  // the function is above its tangent
    return {value + std::min(sample.by_t * (range.first - t), sample.by_t * (range.last - t)), value};
  // The distance changes by no more than the tool moves.
  return {value - std::max(t - range.first, range.last - t) * search.per_mm(), value};
}

}  // namespace kerf::sim

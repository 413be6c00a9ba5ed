// Finds where along its sweep a tool comes nearest to a place.
#include "sim/sweep_distance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kerf::sim {
namespace {

/// Where along a sweep the tool is: mm along the path in plan, or of a plunge the height.
struct Span {
  double first = 0.0, last = 0.0;
  bool empty() const { return !(first <= last); }
};

/// Looks along a path are this share of the tool's radius apart at first, and never more than so many.
constexpr double kLookShare = 0.25;
constexpr int kMostLooks = 64;
/// The search for the nearest point ends when so little can be gained, mm, or with so short a piece of path.
constexpr double kDistanceTolerance = 1e-9;
constexpr double kPathTolerance = 1e-7;

/// A sweep that is a line, and a place that looks at it.
class Looker {
 public:
  Looker(const Sweep& sweep, const ToolDistance& tool, Point3 place)
      : sweep_(sweep), tool_(tool), place_(place), is_plunge_(sweep.length <= 0.0) {}

  struct Look {
    Distance distance;
    double along = 0.0;  // how the distance changes along the path
  };
  Look at(double t) const {
    const double x = is_plunge_ ? sweep_.x : sweep_.x + t * sweep_.ux;
    const double y = is_plunge_ ? sweep_.y : sweep_.y + t * sweep_.uy;
    const double z = is_plunge_ ? t : sweep_.z + t * sweep_.slope;
    Look look;
    look.distance = from(x, y, z);
    const Point3& way = look.distance.gradient;
    look.along = is_plunge_ ? -way.z : -(way.x * sweep_.ux + way.y * sweep_.uy + way.z * sweep_.slope);
    return look;
  }

  /// The part of the path from which the tool may be nearer than `reach`.
  Span near(double reach) const {
    const double wide = tool_.rim() + reach;
    const double dx = place_.x - sweep_.x, dy = place_.y - sweep_.y;
    const double along = dx * sweep_.ux + dy * sweep_.uy, across = dx * sweep_.uy - dy * sweep_.ux;
    if (is_plunge_) {
      if (dx * dx + dy * dy > wide * wide) return {1.0, 0.0};
      const double low = std::min(sweep_.z, sweep_.z_end), high = std::max(sweep_.z, sweep_.z_end);
      return {low, std::max(low, std::min(high, place_.z - tool_.bottom() + reach))};
    }
    const double half2 = wide * wide - across * across;
    if (half2 < 0.0) return {1.0, 0.0};
    const double half = std::sqrt(half2);
    return {std::max(0.0, along - half), std::min(sweep_.length, along + half)};
  }

  /// Anything that is not below `enough` will do where nothing is.
  Distance nearest(Span span, double enough) const;

 private:
  Distance from(double x, double y, double z) const {
    const double dx = place_.x - x, dy = place_.y - y, rho = std::sqrt(dx * dx + dy * dy);
    const TurnedDistance turned = tool_.at(rho, place_.z - z);
    const double per_rho = rho > 0.0 ? turned.by_r / rho : 0.0;
    return {turned.value, {per_rho * dx, per_rho * dy, turned.by_z}};
  }
  Distance between(Span span, Look first, Look last, double enough) const;

  const Sweep& sweep_;
  const ToolDistance& tool_;
  Point3 place_;
  bool is_plunge_;
};

/// The lowest place of a piece of the path at whose ends the distance falls towards its inside. The distance
/// to a convex piece of a tool is a convex function along a line: it is above its tangents, and where those
/// meet is the bottom of a kink; the bottom of a curve is where the slopes say.
Distance Looker::between(Span span, Look first, Look last, double enough) const {
  for (int n = 0; n < kMostLooks; ++n) {
    const double width = span.last - span.first, bend = last.along - first.along;
    const double drop = last.distance.value - first.distance.value;
    const double meet = (last.along * width - drop) / bend;  // of the tangents, from the first end
    const double lowest = first.distance.value + first.along * meet;
    const double best = std::min(first.distance.value, last.distance.value);
    if (best - lowest <= kDistanceTolerance || lowest >= enough || !(width > kPathTolerance)) break;
    const double where = n % 2 == 0 ? meet : -first.along / bend * width;
    const double t = span.first + std::clamp(where, 0.01 * width, 0.99 * width);
    const Look look = at(t);
    if (look.along > 0.0) {
      span.last = t;
      last = look;
    } else {
      span.first = t;
      first = look;
    }
  }
  return first.distance.value < last.distance.value ? first.distance : last.distance;
}

Distance Looker::nearest(Span span, double enough) const {
  const double step = kLookShare * std::max(tool_.rim(), kPathTolerance);
  const double wanted = std::ceil((span.last - span.first) / step);
  const int pieces = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(kMostLooks)));
  const auto place = [&](int k) { return span.first + (span.last - span.first) * k / pieces; };
  Look before = at(span.first);
  Distance best = before.distance;
  for (int k = 1; k <= pieces; ++k) {
    const Look look = at(place(k));
    if (before.along < 0.0 && look.along > 0.0) {
      const Distance inside = between({place(k - 1), place(k)}, before, look, std::min(enough, best.value));
      if (inside.value < best.value) best = inside;
    }
    if (look.distance.value < best.value) best = look.distance;
    before = look;
  }
  return best;
}

}  // namespace

Point2 nearest_in_plan(const Sweep& sweep, Point2 place) {
  const double dx = place.x - sweep.x, dy = place.y - sweep.y;
  if (!sweep.is_arc) {
    const double t = std::clamp(dx * sweep.ux + dy * sweep.uy, 0.0, sweep.length);
    return {sweep.x + t * sweep.ux, sweep.y + t * sweep.uy};
  }
  const double far = std::sqrt(dx * dx + dy * dy);
  const double c = std::cos(sweep.turn), s = std::sin(sweep.turn);
  // Seen from the begin, counted in the arc's own sense: left of it, and left of its end.
  const double way = sweep.turn < 0.0 ? -1.0 : 1.0;
  const double along = sweep.ux * dx + sweep.uy * dy, across = way * (sweep.ux * dy - sweep.uy * dx);
  const bool after_begin = across >= 0.0, before_end = way * s * along - c * across >= 0.0;
  const double turn = std::abs(sweep.turn);
  const bool between = turn >= 2.0 * std::numbers::pi ||
                       (turn <= std::numbers::pi ? after_begin && before_end : after_begin || before_end);
  if (between && far > 0.0) return {sweep.x + dx / far * sweep.radius, sweep.y + dy / far * sweep.radius};
  // Beyond the arc: whichever end is nearer.
  const Point2 begin{sweep.x + sweep.radius * sweep.ux, sweep.y + sweep.radius * sweep.uy};
  const Point2 end{sweep.x + sweep.radius * (c * sweep.ux - s * sweep.uy),
                   sweep.y + sweep.radius * (s * sweep.ux + c * sweep.uy)};
  return distance(begin, place) <= distance(end, place) ? begin : end;
}

Distance distance_to_level(const ToolDistance& tool, Point2 nearest, double z, Point3 place) {
  const double dx = place.x - nearest.x, dy = place.y - nearest.y, rho = std::sqrt(dx * dx + dy * dy);
  const TurnedDistance turned = tool.at(rho, place.z - z);
  const double per_rho = rho > 0.0 ? turned.by_r / rho : 0.0;
  return {turned.value, {per_rho * dx, per_rho * dy, turned.by_z}};
}

Distance distance_to(const Sweep& sweep, const ToolDistance& tool, Point3 place, double reach,
                     double enough) {
  if (is_level(sweep)) return distance_to_level(tool, nearest_in_plan(sweep, place.xy()), sweep.z, place);
  const Looker looker(sweep, tool, place);
  const Span span = looker.near(reach);
  return span.empty() ? Distance{} : looker.nearest(span, enough);
}

DistanceBounds bounds_of_distance(const Sweep& sweep, const ToolDistance& tool, Point3 place, double reach) {
  if (is_level(sweep)) {
    const double value = distance_to(sweep, tool, place, reach).value;
    return {value, value};
  }
  const Looker looker(sweep, tool, place);
  const Span span = looker.near(reach);
  if (span.empty()) return {};
  // Nothing comes nearer faster than the tool moves.
  const double value = looker.at(0.5 * (span.first + span.last)).distance.value;
  const double per_mm = sweep.length > 0.0 ? std::sqrt(1.0 + sweep.slope * sweep.slope) : 1.0;
  return {value - 0.5 * (span.last - span.first) * per_mm, value};
}

}  // namespace kerf::sim

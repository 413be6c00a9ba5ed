// Finds where along its sweep a tool comes nearest to a place.
#include "sim/exact/sweep_distance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kerf::sim {
namespace {

/// Where along a sweep the tool is.
struct PathRange {
  double first = 0.0, last = 0.0;
  bool empty() const { return !(first <= last); }
  double width() const { return last - first; }
  double clamp(double t) const { return std::clamp(t, first, last); }
};

/// Looks along the path of a tool that is not convex are this share of its radius apart, and never more than
/// so many.
constexpr double kLookShare = 0.25;
constexpr int kMaxLooks = 64;
/// The search for the nearest point ends when so little can be gained, mm, or with so short a piece of path.
constexpr double kDistanceTolerance = 1e-9;
constexpr double kPathTolerance = 1e-7;
/// Where a parabola stands for the distance, it may be so far off, mm.
constexpr double kParabolaTolerance = 2e-8;
/// And only where it is nearly level.
constexpr double kNearlyLevel = 1e-2;

/// Slopes at the ends of a piece of path that agree with how they change by this share are those of one
/// curve.
constexpr double kSmoothTurn = 0.5;
/// Both sides of a kink bend by less than this share of it.
constexpr double kStraight = 0.1;
/// Newton's method for where parabolas meet is that quick.
constexpr int kMeetings = 3;
/// Where the lowest place is further off than was thought, the next look is so many times as far away.
constexpr double kLongerStride = 8.0;
/// Nor are looks nearer to each other than this at first, mm.
constexpr double kMinStride = 1e-3;

/// A sweep that is a line, and a place that looks at it.
class Looker {
 public:
  Looker(const Sweep& sweep, const ToolDistance& tool, Point3 place)
      : sweep_(sweep), tool_(tool), place_(place), is_plunge_(sweep.length <= 0.0) {}

  struct Look {
    Distance distance;
    double along = 0.0, bend = 0.0;  // how the distance changes along the path, and how that does
  };
  Look at(double t) const;
  /// The part of the path from which the tool may be nearer than `reach`.
  PathRange near(double reach) const;
  /// Where the tool may come nearest.
  double guess() const;
  double look_width() const { return kLookShare * std::max(tool_.rim(), kPathTolerance); }
  /// Along so short a piece of path parabolas from both ends tell the distance.
  double close_width() const { return std::cbrt(6.0 * kParabolaTolerance * tool_.rim() * tool_.rim()); }
  /// How far the tool goes, for each mm that the path is said to.
  double per_mm() const { return is_plunge_ ? 1.0 : std::sqrt(1.0 + sweep_.slope * sweep_.slope); }
  /// How far along the path a place goes that moves.
  double share_along(Point3 moved) const;

  /// Of a piece of the path along which the distance has one lowest place, which may be `stride` from where
  /// it is guessed. Anything that is not below `enough` will do where nothing is.
  Nearest lowest(PathRange range, double guess, double stride, double enough) const;
  Nearest lowest_of_many(PathRange range, double enough) const;

 private:
  const Sweep& sweep_;
  const ToolDistance& tool_;
  Point3 place_;
  bool is_plunge_;
};

Looker::Look Looker::at(double t) const {
  const double x = is_plunge_ ? sweep_.x : sweep_.x + t * sweep_.ux;
  const double y = is_plunge_ ? sweep_.y : sweep_.y + t * sweep_.uy;
  const double z = is_plunge_ ? t : sweep_.z + t * sweep_.slope;
  const double dx = place_.x - x, dy = place_.y - y, rho = std::sqrt(dx * dx + dy * dy);
  const TurnedDistance turned = tool_.at(rho, place_.z - z);
  const double per_rho = rho > 0.0 ? 1.0 / rho : 0.0, by_rho = turned.by_r * per_rho;
  // The place's way in the tool's half plane, while the tool moves on by 1.
  const double in_plan = is_plunge_ ? 0.0 : 1.0, rise = is_plunge_ ? 1.0 : sweep_.slope;
  const double out = -in_plan * per_rho * (dx * sweep_.ux + dy * sweep_.uy);
  const double across = turned.by_r * rise + turned.by_z * out;
  Look look;
  look.distance = {turned.value, {by_rho * dx, by_rho * dy, turned.by_z}};
  look.along = turned.by_r * out - turned.by_z * rise;
  look.bend = by_rho * (in_plan - out * out) + turned.bend * across * across;
  return look;
}

PathRange Looker::near(double reach) const {
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

/// Where the middle of a ball would: right for balls, near for other tools.
double Looker::guess() const {
  const Point3 middle{sweep_.x, sweep_.y, (is_plunge_ ? 0.0 : sweep_.z) + tool_.bottom() + tool_.rim()};
  return share_along(place_ - middle);
}

double Looker::share_along(Point3 moved) const {
  if (is_plunge_) return moved.z;
  return (moved.x * sweep_.ux + moved.y * sweep_.uy + moved.z * sweep_.slope) /
         (1.0 + sweep_.slope * sweep_.slope);
}

/// Two looks with the lowest place between them.
struct Bracket {
  Looker::Look first, last;
  double width = 0.0;

  /// Whether one curve goes through both, and not a kink between them.
  bool is_smooth() const {
    const double turn = last.along - first.along;
    return std::abs(first.bend * width - turn) + std::abs(last.bend * width - turn) < kSmoothTurn * turn;
  }
  /// Whether both sides of a kink are nearly straight.
  bool is_kink() const {
    return std::max(std::abs(first.bend), std::abs(last.bend)) * width <
           kStraight * (last.along - first.along);
  }
  /// A place from the first, and the distance there as it is told.
  struct Told {
    double at, value;
  };
  /// Where the tangents meet: a convex function is not below them.
  Told lowest() const {
    const double drop = last.distance.value - first.distance.value;
    const double at = (last.along * width - drop) / (last.along - first.along);
    return {at, first.distance.value + first.along * at};
  }
  /// Where parabolas meet: the place of a kink.
  Told kink() const {
    // A bend that is as strong as that is one of the kink's.
    const double most = (last.along - first.along) / width;
    const double first_bend = first.bend < most ? first.bend : 0.0;
    const double last_bend = last.bend < most ? last.bend : 0.0;
    double at = lowest().at, value = 0.0;
    for (int n = 0; n < kMeetings; ++n) {
      const double back = at - width;
      value = first.distance.value + at * (first.along + 0.5 * first_bend * at);
      const double other = last.distance.value + back * (last.along + 0.5 * last_bend * back);
      const double closing = first.along + first_bend * at - last.along - last_bend * back;
      if (closing < 0.0) at = std::clamp(at - (value - other) / closing, 0.0, width);
    }
    return {at, value};
  }
  /// The distance's way at a kink: while a place moves the tool goes along to where both sides agree.
  Point3 gradient() const {
    const double turn = last.along - first.along;
    return (last.along / turn) * first.distance.gradient - (first.along / turn) * last.distance.gradient;
  }
};

/// The distance to a convex tool is a convex function along a line. Newton's method finds the bottom of a
/// curve; that of a kink is where its two sides meet.
Nearest Looker::lowest(PathRange range, double guess, double stride, double enough) const {
  Bracket bracket;
  bool knows_first = false, knows_last = false;
  Nearest best;
  double t = range.clamp(guess);
  for (int n = 0; n < kMaxLooks; ++n) {
    const Look look = at(t);
    if (look.distance.value < best.distance.value) best = {look.distance, t};
    if (look.along >= 0.0) {
      range.last = t;
      bracket.last = look;
      knows_last = true;
    }
    if (look.along <= 0.0) {
      range.first = t;
      bracket.first = look;
      knows_first = true;
    }
    const double width = bracket.width = range.width();
    if (!(width > kPathTolerance)) break;
    const double step = look.bend > 0.0 ? -look.along / look.bend : std::copysign(width, -look.along);
    const bool is_inside = range.first < t + step && t + step < range.last;
    const double gain = -0.5 * look.along * step;
    if (is_inside && gain <= kParabolaTolerance && std::abs(look.along) <= kNearlyLevel) {
      if (look.distance.value <= best.distance.value) best.distance.value -= gain;
      break;
    }
    if (!knows_first || !knows_last) {
      const double lowest = look.distance.value - std::abs(look.along) * width;
      if (best.distance.value - lowest <= kDistanceTolerance || lowest >= enough) break;
      t = range.clamp(t + std::clamp(step, -stride, stride));
      stride *= kLongerStride;
      continue;
    }
    const double lowest = bracket.lowest().value;
    if (lowest >= enough) break;
    if (best.distance.value - lowest <= kDistanceTolerance) {
      best.distance.gradient = bracket.gradient();
      break;
    }
    if (is_inside && bracket.is_smooth()) {
      t += step;
      continue;
    }
    const Bracket::Told kink = bracket.kink();
    const double close = close_width();
    if (width <= close && bracket.is_kink() && kink.value <= best.distance.value)
      return {{kink.value, bracket.gradient()}, range.first + kink.at};
    // A little beyond the kink, seen from the end that is nearer, so that the other end comes near too.
    const double beyond = kink.at < 0.5 * width ? 0.4 * close : -0.4 * close;
    t = range.first + std::clamp(kink.at + beyond, 0.01 * width, 0.99 * width);
  }
  return best;
}

/// Looks that are near enough to each other have at most one lowest place between them.
Nearest Looker::lowest_of_many(PathRange range, double enough) const {
  const double wanted = std::ceil(range.width() / look_width());
  const int pieces = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(kMaxLooks)));
  const auto place = [&](int k) { return range.first + range.width() * k / pieces; };
  Nearest best;
  const auto take = [&](const Nearest& found) {
    if (found.distance.value < best.distance.value) best = found;
  };
  Look before = at(range.first);
  take({before.distance, range.first});
  for (int k = 1; k <= pieces; ++k) {
    const Look look = at(place(k));
    take({look.distance, place(k)});
    if (before.along < 0.0 && look.along > 0.0)
      take(lowest({place(k - 1), place(k)}, 0.5 * (place(k - 1) + place(k)), look_width(),
                  std::min(enough, best.distance.value)));
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

Nearest nearest_along(const Sweep& sweep, const ToolDistance& tool, Point3 place, double reach,
                      double enough) {
  const Looker looker(sweep, tool, place);
  const PathRange range = looker.near(reach);
  if (range.empty()) return {};
  return tool.is_convex() ? looker.lowest(range, looker.guess(), looker.look_width(), enough)
                          : looker.lowest_of_many(range, enough);
}

Nearest nearest_beside(const Sweep& sweep, const ToolDistance& tool, Point3 place, double reach,
                       const Nearest& known, Point3 moved, double enough) {
  const Looker looker(sweep, tool, place);
  const PathRange range = looker.near(reach);
  if (range.empty()) return {};
  // Of several lowest places another one may be the lowest now.
  if (!tool.is_convex()) return looker.lowest_of_many(range, enough);
  const double guess = known.where + looker.share_along(moved);
  return looker.lowest(range, guess, std::max(length(moved), kMinStride), enough);
}

DistanceBounds bounds_of_distance(const Sweep& sweep, const ToolDistance& tool, Point3 place, double reach) {
  const Looker looker(sweep, tool, place);
  const PathRange range = looker.near(reach);
  if (range.empty()) return {};
  const double t = range.clamp(looker.guess());
  const Looker::Look look = looker.at(t);
  const double value = look.distance.value;
  if (tool.is_convex())  // it is above its tangent
    return {value + std::min(look.along * (range.first - t), look.along * (range.last - t)), value};
  // Nothing comes nearer faster than the tool moves.
  return {value - std::max(t - range.first, range.last - t) * looker.per_mm(), value};
}

}  // namespace kerf::sim

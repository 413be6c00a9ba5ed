// The descent to the moment at which a tool is deepest in a ray.
#include "sim/rotary/rotary_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kerf::sim {
namespace {

constexpr double kNone = 1e300;         // the end of a missing interval
constexpr double kTolerance = 2e-4;     // mm, of the ends of intervals
constexpr double kShortestWay = 0.001;  // mm of the motion
constexpr double kGolden = 0.381966;
constexpr double kSameTime = 1e-9;  // a fraction of a motion
constexpr double kAllAround = 0.1;  // radians
constexpr double kMaxSeries = 0.3;  // radians, of series to the seventh power
constexpr int kSamples = 12;
constexpr std::size_t kGaps = 4;
constexpr int kMaxSteps = 40;
constexpr int kNearestSteps = 3;
constexpr int kBisections = 14;

}  // namespace

PartSweep::PartSweep(const Frusta& part, const RotaryMotion& motion, const RoundBar& bar)
    : part_(part), motion_(motion), radius_(0.5 * bar.diameter), axis_y_(bar.axis_y), axis_z_(bar.axis_z) {
  lowest_ = std::min(motion.from.z, motion.to.z) + part.bottom() - axis_z_;
  rim_ = part.rim_below(radius_ - lowest_ + part.bottom());
  const double way = std::max(distance(motion.from, motion.to), std::abs(motion.turned()) * radius_);
  shortest_way_ = way > 0.0 ? kShortestWay / way : 1.0;
  const double right = std::min(motion.from.y, motion.to.y) - axis_y_ - rim_;
  const double left = std::max(motion.from.y, motion.to.y) - axis_y_ + rim_;
  turn_sine_ = std::sin(motion.turn(0.5));
  turn_cosine_ = std::cos(motion.turn(0.5));
  half_sine_ = std::sin(0.5 * motion.turned());
  half_cosine_ = std::cos(0.5 * motion.turned());
  at_start_ = {0.0, axis_y_ - motion.from.y, axis_z_ - motion.from.z, 0.0, 1.0};
  at_end_ = {0.0, axis_y_ - motion.to.y, axis_z_ - motion.to.z, 0.0, 1.0};
  limit_angles(right, left);
}

/// From the heights and the sides that the part and the bar have in common; by the right-hand rule Y+ is at
/// negative angles.
void PartSweep::limit_angles(double right, double left) {
  using std::numbers::pi;
  if (lowest_ > 0.0) {
    angles_.low = std::min(std::atan2(-left, lowest_), 0.0);
    angles_.high = std::max(std::atan2(-right, lowest_), 0.0);
  } else {
    angles_.high = pi;
    angles_.low = -pi;
  }
  if (right > 0.0 && right < radius_) {
    angles_.low = std::max(angles_.low, std::asin(right / radius_) - pi);
    angles_.high = std::min(angles_.high, -std::asin(right / radius_));
  } else if (left < 0.0 && -left < radius_) {
    angles_.low = std::max(angles_.low, std::asin(-left / radius_));
    angles_.high = std::min(angles_.high, pi - std::asin(-left / radius_));
  }
  angles_.is_all = angles_.high - angles_.low + std::abs(motion_.turned()) >= 2.0 * pi - kAllAround;
}

bool PartSweep::misses_bar() const {
  const double right = std::min(motion_.from.y, motion_.to.y) - axis_y_;
  const double left = std::max(motion_.from.y, motion_.to.y) - axis_y_;
  const double beside = std::max({right, -left, 0.0});
  return std::hypot(std::max(beside - rim_, 0.0), std::max(lowest_, 0.0)) >= radius_;
}

/// Limits the moments to those when `at` + t * `rate` is between two values.
bool PartSweep::limit_to(double at, double rate, double low, double high) {
  if (at > low && at < high && at + rate > low && at + rate < high) return true;
  if (rate == 0.0) return false;
  const double t0 = (low - at) / rate, t1 = (high - at) / rate;
  first_ = std::max(first_, std::min(t0, t1));
  last_ = std::min(last_, std::max(t0, t1));
  return first_ <= last_;
}

/// Prepares for rays of an angle; their sines and cosines along the piece follow from those at its midpoint.
void PartSweep::turn_to(const RayAngle& angle) {
  prepared_ = angle.angle;
  sine_ = angle.cosine * turn_sine_ - angle.sine * turn_cosine_;
  cosine_ = angle.cosine * turn_cosine_ + angle.sine * turn_sine_;
  at_start_.sine = sine_ * half_cosine_ - cosine_ * half_sine_;
  at_start_.cosine = cosine_ * half_cosine_ + sine_ * half_sine_;
  at_end_.sine = sine_ * half_cosine_ + cosine_ * half_sine_;
  at_end_.cosine = cosine_ * half_cosine_ - sine_ * half_sine_;
  const bool passes = cosine_ > 0.0 && at_start_.sine * at_end_.sine <= 0.0;
  upright_ = passes ? 1.0 : std::max(at_start_.cosine, at_end_.cosine);
}

bool PartSweep::aim(double x, const RayAngle& angle, double turn, double reach) {
  x_ = x;
  angle_ = angle.angle + turn;
  reach_ = reach;
  if (!(lowest_ < reach)) return false;
  first_ = 0.0;
  last_ = 1.0;
  const double along = motion_.to.x - motion_.from.x;
  if (!(x > low_x() && x < high_x())) return false;
  if (angle.angle != prepared_) turn_to(angle);
  if (lowest_ >= reach * std::max(upright_, 0.0)) return false;
  if (motion_.turned() != 0.0 && !angles_.is_all &&
      !limit_to(angle_ - motion_.turn_from, -motion_.turned(), angles_.low, angles_.high))
    return false;
  if (is_beside(lowest_, rim_) || !limit_to(x - motion_.from.x, -along, -rim_, rim_)) return false;
  touch_start_ = first_;
  if (motion_.is_along_bar() && along != 0.0) {
    // Sections of a tool across the bar are the larger, the nearer they are to its axis.
    touch_start_ = first_ = last_ = std::clamp((x - motion_.from.x) / along, 0.0, 1.0);
    return true;
  }
  return limit_to_extremes();
}

/// Whether the points of the ray above the height `lowest` stay further from the tool's axis than the part,
/// of which nothing is wider than `widest`, is at their heights.
bool PartSweep::is_beside(double lowest, double widest) const {
  double low = std::min(at_start_.sine, at_end_.sine), high = std::max(at_start_.sine, at_end_.sine);
  if (at_start_.cosine * at_end_.cosine <= 0.0)
    (low + high > 0.0 ? high : low) = low + high > 0.0 ? 1.0 : -1.0;
  const double least = upright_ > 0.0 ? std::clamp(lowest / upright_, 0.0, reach_) : 0.0;
  low *= low > 0.0 ? least : reach_;
  high *= high > 0.0 ? reach_ : least;
  // The rays' y is that of the bar's axis relative to the tool.
  const double y =
      std::max({low + std::min(at_start_.y, at_end_.y), -high - std::max(at_start_.y, at_end_.y), 0.0});
  const double x = std::max(
      {std::min(motion_.from.x, motion_.to.x) - x_, x_ - std::max(motion_.from.x, motion_.to.x), 0.0});
  const double rim = part_.rim_below(reach_ * std::max(upright_, 0.0) - lowest_ + part_.bottom());
  return x * x + y * y >= std::min(rim * rim, widest * widest);
}

/// Whether the squares of the distances of the ray's points beyond `least` from the tool's axis are convex
/// functions of time: their second derivative is x'^2 + y'^2 + y y'', where y'' is that of the turn.
bool PartSweep::is_convex(double least) const {
  const double turned = motion_.turned(), x_rate = motion_.to.x - motion_.from.x;
  if (turned == 0.0) return true;
  const double lean = std::max(std::abs(at_start_.sine), std::abs(at_end_.sine));
  const double y = std::max(std::abs(at_start_.y), std::abs(at_end_.y)) + reach_ * lean;
  const double y_rate = motion_.from.y - motion_.to.y;
  const double slow = y_rate + least * std::min(at_start_.cosine, at_end_.cosine) * turned;
  const double fast = y_rate + reach_ * upright_ * turned;
  const double min_rate = slow * fast > 0.0 ? std::min(std::abs(slow), std::abs(fast)) : 0.0;
  return y * reach_ * lean * turned * turned <= x_rate * x_rate + min_rate * min_rate;
}

/// Where all points of the ray come nearer to the axis of the tool and rise in it, or go away and fall, one
/// end of the piece has all. False if that is the start, which the piece before has cut.
bool PartSweep::limit_to_extremes() {
  const double least = std::max(lowest_ / upright_, 0.0), cosine = std::min(at_start_.cosine, at_end_.cosine);
  const double turned = motion_.turned();
  if (!part_.widens() || !(cosine > 0.0) || reach_ * upright_ > lowest_ - part_.bottom() + part_.top())
    return true;
  if (!is_convex(least)) return true;
  const double start_turn = at_start_.sine * turned, end_turn = at_end_.sine * turned;
  const bool recedes = start_turn >= 0.0 && end_turn >= 0.0 && motion_.to.z >= motion_.from.z;
  const bool nears = start_turn <= 0.0 && end_turn <= 0.0 && motion_.to.z <= motion_.from.z;
  if (!recedes && !nears) return true;
  // Half the rate of the square of the distance, of the points between r = `least` and `reach_`.
  const double x_rate = motion_.from.x - motion_.to.x, y_rate = motion_.from.y - motion_.to.y;
  const double span = reach_ - least;
  const auto rate = [&](const TiltedRay& ray, double tip_x, double r) {
    return (x_ - tip_x) * x_rate + (ray.y + r * ray.sine) * (y_rate + r * ray.cosine * turned);
  };
  const auto curvature = [&](const TiltedRay& ray) {
    return 0.25 * ray.sine * ray.cosine * turned * span * span;
  };
  if (recedes) {
    const double x = motion_.from.x, margin = std::max(curvature(at_start_), 0.0);
    if (rate(at_start_, x, least) >= margin && rate(at_start_, x, reach_) >= margin) {
      last_ = first_;
      return first_ > 0.0 || !motion_.continues;
    }
  }
  if (nears) {
    const double x = motion_.to.x, margin = std::min(curvature(at_end_), 0.0);
    if (rate(at_end_, x, least) <= margin && rate(at_end_, x, reach_) <= margin) first_ = last_;
  }
  return true;
}

TiltedRay PartSweep::seen(double t) const {
  const Point3 tip = motion_.at(t);
  TiltedRay ray{x_ - tip.x, axis_y_ - tip.y, axis_z_ - tip.z, sine_, cosine_};
  const double turn = (t - 0.5) * motion_.turned(), square = turn * turn;
  if (turn == 0.0) return ray;
  double sine = turn * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)));
  double cosine = 1.0 - 0.5 * square * (1.0 - square / 12.0 * (1.0 - square / 30.0));
  if (std::abs(turn) > kMaxSeries) {
    sine = std::sin(turn);
    cosine = std::cos(turn);
  }
  ray.sine = sine_ * cosine + cosine_ * sine;
  ray.cosine = cosine_ * cosine - sine_ * sine;
  return ray;
}

/// The moment when the tool's axis is nearest to the point of the ray at `r`, from an estimate.
double PartSweep::nearest(double r, double t) const {
  const double along = motion_.from.x - motion_.to.x;
  for (int n = 0; n < kNearestSteps; ++n) {
    const TiltedRay ray = seen(t);
    const double across = motion_.from.y - motion_.to.y + r * ray.cosine * motion_.turned();
    const double square = along * along + across * across;
    if (!(square > 0.0)) return motion_.to.z < motion_.from.z ? last_ : first_;
    const double step = (ray.x * along + (ray.y + r * ray.sine) * across) / square;
    const double next = std::clamp(t - step, first_, last_);
    const bool is_near = std::abs(next - t) < shortest_way_;
    t = next;
    if (is_near || motion_.turned() == 0.0) break;
  }
  return t;
}

/// The interval of a body at a moment, which joins those known.
PartSweep::Moment PartSweep::moment(std::size_t body, double t) {
  RayInterval found{};
  Moment at{t, {kNone, -kNone}};
  if (part_.intersect(body, seen(t), radius_, found)) {
    at.interval = found;
    if (found.low < reached_.hull.low) deepest_ = t;
    reached_.hull = {std::min(reached_.hull.low, found.low), std::max(reached_.hull.high, found.high)};
    reached_.common = {std::max(reached_.common.low, found.low), std::min(reached_.common.high, found.high)};
  }
  moments_.push_back(at);
  return at;
}

/// No interval starts lower: that of a ray straight below the body does not.
double PartSweep::lowest_low(std::size_t body) const {
  return std::max(lowest_ + part_.bottom(body) - part_.bottom(), 0.0);
}

void PartSweep::sample(std::size_t body) {
  for (int k = 1; k < kSamples; ++k) moment(body, first_ + (last_ - first_) * k / kSamples);
  sampled_ = true;
}

/// Searches for contact at moments that do not depend on what is left of the ray, so that a motion and the
/// same one backwards find the same.
bool PartSweep::find_contact(std::size_t body) {
  const double least = lowest_low(body), centre = 0.5 * (first_ + last_);
  for (const double end : {first_, last_}) moment(body, end);
  const double outer = nearest(radius_, centre);
  if (outer > first_ && outer < last_) moment(body, outer);
  if (!is_convex(std::min(least, reach_))) sample(body);
  if (reached_.hull.low < kNone) return true;
  const double inner = nearest(least, centre);
  if (std::abs(inner - outer) > shortest_way_ && moment(body, inner).touches()) return true;
  return approach(body);
}

/// Searches for contact by what the ray lacks to it.
bool PartSweep::approach(std::size_t body) {
  std::array<Gap, kGaps + 1> gaps{};
  for (std::size_t n = 0; n <= kGaps; ++n) {
    const double t = first_ + (last_ - first_) * static_cast<double>(n) / kGaps;
    gaps[n] = {t, part_.shortfall(body, seen(t), radius_)};
  }
  for (std::size_t n = 0; n <= kGaps; ++n) {
    const Gap &before = gaps[n == 0 ? 0 : n - 1], &after = gaps[std::min<std::size_t>(n + 1, kGaps)];
    if (gaps[n].lack <= before.lack && gaps[n].lack <= after.lack && approach(body, before, gaps[n], after))
      return true;
  }
  return false;
}

/// Narrows a stretch of time around the smallest gap until the ray touches or, by convexity, cannot.
bool PartSweep::approach(std::size_t body, Gap low, Gap at, Gap high) {
  for (int n = 0; n < kMaxSteps; ++n) {
    if (at.lack <= 0.0 && moment(body, at.t).touches()) return true;
    const double left = at.t - low.t, right = high.t - at.t;
    if (std::max(left, right) <= shortest_way_) return false;
    const double rise_low = low.lack - at.lack, rise_high = high.lack - at.lack;
    const bool both = left > 0.0 && right > 0.0;
    // A turn makes ways as uneven as an arc is above its chord.
    const double turned = motion_.turned() * (left + right), uneven = 0.5 * radius_ * turned * turned;
    if (both && at.lack - uneven > std::max(rise_low * right / left, rise_high * left / right)) return false;
    double t = right > left ? at.t + kGolden * right : at.t - kGolden * left;
    const double across = rise_low * right + rise_high * left;
    if (both && n % 3 != 2 && across > 0.0) {
      const double vertex = at.t + 0.5 * (rise_low * right * right - rise_high * left * left) / across;
      if (std::abs(vertex - at.t) > 0.5 * shortest_way_) t = vertex;
    }
    const Gap next{t, part_.shortfall(body, seen(t), radius_)};
    Gap& side = t < at.t ? low : high;
    Gap& other = t < at.t ? high : low;
    if (next.lack < at.lack) {
      other = at;
      at = next;
    } else {
      side = next;
    }
  }
  return false;
}

void PartSweep::sort_moments() {
  std::sort(moments_.begin(), moments_.end(), [](const Moment& a, const Moment& b) { return a.t < b.t; });
  const auto same = [](const Moment& a, const Moment& b) { return b.t - a.t < kSameTime; };
  moments_.erase(std::unique(moments_.begin(), moments_.end(), same), moments_.end());
}

/// Refines the least of the moments, and all that are less than their neighbours, as a turn allows several.
void PartSweep::descend(std::size_t body, bool upwards) {
  if (upwards && !sampled_) sample(body);
  sort_moments();
  const std::vector<Moment> known = moments_;
  const double enough = upwards ? -reach_ : lowest_low(body) + kTolerance;
  for (std::size_t n = 0; n < known.size(); ++n) {
    const Moment& before = known[n == 0 ? 0 : n - 1];
    const Moment& after = known[std::min(n + 1, known.size() - 1)];
    const double here = known[n].end(upwards);
    const bool is_less = n == 0 || here < before.end(upwards);
    if (here < kNone && here > enough && is_less && here <= after.end(upwards))
      refine(body, upwards, before, known[n], after);
  }
}

/// Narrows a stretch of time that has the minimum, `at` being the best moment of it. By convexity the minimum
/// on one side of it is above the line through the values on the other side.
void PartSweep::refine(std::size_t body, bool upwards, Moment low, Moment at, Moment high) {
  for (int n = 0; n < kMaxSteps; ++n) {
    const double left = at.t - low.t, right = high.t - at.t, best = at.end(upwards);
    if (std::max(left, right) <= shortest_way_) return;
    const double rise_low = low.end(upwards) - best, rise_high = high.end(upwards) - best;
    const bool both = left > 0.0 && right > 0.0 && std::max(rise_low, rise_high) < 0.5 * kNone;
    if (both && std::max(rise_low * right / left, rise_high * left / right) < kTolerance) return;
    double t = right > left ? at.t + kGolden * right : at.t - kGolden * left;
    const double across = rise_low * right + rise_high * left;
    if (both && n % 3 != 2 && across > 0.0) {
      const double vertex = at.t + 0.5 * (rise_low * right * right - rise_high * left * left) / across;
      if (std::abs(vertex - at.t) > 0.5 * shortest_way_) t = vertex;
    }
    const Moment next = moment(body, t);
    if (next.end(upwards) < best) {
      (t < at.t ? high : low) = at;
      at = next;
    } else {
      (t < at.t ? low : high) = next;
    }
  }
}

/// Whether a body stays in the ray from one moment of contact to another: their intervals, or those of
/// moments between them, overlap.
bool PartSweep::stays(std::size_t body, const Moment& a, const Moment& b) {
  if (a.interval.low <= b.interval.high && b.interval.low <= a.interval.high) return true;
  if (b.t - a.t <= shortest_way_) return true;
  const Moment centre = moment(body, 0.5 * (a.t + b.t));
  return centre.touches() && stays(body, a, centre) && stays(body, centre, b);
}

/// A turn may take the body out of the ray and in again elsewhere.
void PartSweep::divide(std::size_t body, std::vector<RayInterval>& out) {
  sort_moments();
  const std::vector<Moment> known = moments_;
  const Moment* last = nullptr;
  for (const Moment& at : known) {
    if (at.touches() && last != nullptr && stays(body, *last, at)) {
      out.back() = {std::min(out.back().low, at.interval.low), std::max(out.back().high, at.interval.high)};
    } else if (at.touches()) {
      out.push_back(at.interval);
    }
    last = at.touches() ? &at : nullptr;
  }
}

void PartSweep::cover(std::size_t body, std::vector<RayInterval>& out) {
  if (!(lowest_low(body) < reach_)) return;
  const double lowest = lowest_ + part_.bottom(body) - part_.bottom();
  if (bodies() > 1 && (lowest >= reach_ * std::max(upright_, 0.0) || is_beside(lowest, part_.rim(body))))
    return;
  reached_.hull = {kNone, -kNone};
  reached_.common = {-kNone, kNone};
  moments_.clear();
  sampled_ = false;
  if (first_ == last_) {
    if (!moment(body, first_).touches()) return;
  } else {
    if (!find_contact(body)) return;
    if (reached_.hull.low > lowest_low(body) + kTolerance) descend(body, false);
    if (reached_.hull.high < reach_ || reached_.common.low > reached_.common.high) descend(body, true);
  }
  if (reached_.common.low > reached_.common.high && motion_.turned() != 0.0) return divide(body, out);
  out.push_back(reached_.hull);
}

double PartSweep::first_contact(double depth) {
  const auto touches = [&](double t) {
    RayInterval found{};
    for (std::size_t body = 0; body < bodies(); ++body)
      if (part_.intersect(body, seen(t), radius_, found) && std::min(found.high, reach_) - found.low > depth)
        return true;
    return false;
  };
  if (touches(touch_start_)) return touch_start_;
  double before = touch_start_, after = deepest_;
  for (int n = 0; n < kBisections; ++n) {
    const double centre = 0.5 * (before + after);
    (touches(centre) ? after : before) = centre;
  }
  return after;
}

}  // namespace kerf::sim

// The queue of planned motions.
#include "path/planner.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kerf::detail {
namespace {

constexpr std::size_t kMaxRing = 10'000;  // motions; more look-ahead changes no time
// Closer than this to a straight line or a reversal, the cosine has no digits left for the corner circle.
constexpr double kStraight = 0.999999;

/// Seconds for `length` mm between two speeds, with a maximum: ramps, and the rest at that speed.
double ramp_seconds(double length, double acceleration, double from, double to, double highest) {
  const double peak2 = acceleration * length + (from * from + to * to) / 2.0;
  const double peak = std::max({std::sqrt(peak2), from, to});
  if (peak <= highest) return (2.0 * peak - from - to) / acceleration;
  const double ramps = (2.0 * highest * highest - from * from - to * to) / (2.0 * acceleration);
  return (2.0 * highest - from - to) / acceleration + std::max(length - ramps, 0.0) / highest;
}

}  // namespace

Planner::Planner(const Machine& machine, std::vector<float>& seconds)
    : seconds_(seconds),
      steps_per_mm_(machine.steps_per_mm),
      deviation_(machine.junction_deviation.mm()),
      slowest_(machine.slowest_feed.mm_per_min() / 60.0),
      ring_(std::clamp<std::size_t>(static_cast<std::size_t>(std::max(machine.look_ahead, 1)), 1, kMaxRing)) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    rates_[axis] = machine.rates[axis].mm_per_min() / 60.0;
    accelerations_[axis] = in_mm_per_s2(machine.accelerations[axis]);
  }
}

Point3 Planner::rounded(Point3 to) const {
  for (int axis = 0; axis < 3; ++axis) {
    const double steps = steps_per_mm_[static_cast<std::size_t>(axis)];
    if (steps > 0.0) to[axis] = std::round(to[axis] * steps) / steps;
  }
  return to;
}

/// The speed on a circle tangent to both motions within the junction deviation of the corner, with the
/// centripetal acceleration that the axes permit towards its inside.
double Planner::corner_speed2(Point3 before, Point3 after) const {
  const double cosine = dot(before, after);  // 1: straight on
  if (cosine > kStraight) return std::numeric_limits<double>::infinity();
  if (cosine < -kStraight) return 0.0;
  const double half_sine = std::sqrt(0.5 * (1.0 + cosine));  // of half the angle between the two moves
  return along(after - before, accelerations_) * deviation_ * half_sine / (1.0 - half_sine);
}

void Planner::move(Point3 to, double feed, std::size_t step) {
  to = rounded(to);
  const Point3 way = to - here_;
  const double length = kerf::length(way);
  if (!(length > 0.0)) return;
  here_ = to;
  ++moves_;
  const Point3 direction = (1.0 / length) * way;
  if (count_ == ring_.size()) finish_front();
  Move& next = at(count_);
  next = {length, along(direction, accelerations_), 0.0, 0.0, 0.0, step};
  next.speed = std::min(std::max(feed, slowest_), along(direction, rates_));
  if (!stopped_) {
    const double slower = std::min(next.speed, last_speed_);
    next.max_entry2 = std::min(corner_speed2(direction_, direction), slower * slower);
  }
  ++count_;
  stopped_ = false;
  direction_ = direction;
  last_speed_ = next.speed;
  plan_backwards();
}

void Planner::plan_backwards() {
  double exit2 = 0.0;
  for (std::size_t i = count_ - 1; i > 0; --i) {
    Move& m = at(i);
    const double entry2 = std::min(m.max_entry2, exit2 + 2.0 * m.acceleration * m.length);
    const bool known = i + 1 < count_ && entry2 == m.entry2;
    m.entry2 = exit2 = entry2;
    if (known) return;
  }
}

void Planner::finish_front() {
  const Move& m = at(0);
  double exit2 = 0.0;
  if (count_ > 1) {
    exit2 = std::min(at(1).entry2, m.entry2 + 2.0 * m.acceleration * m.length);
    at(1).entry2 = exit2;
  }
  seconds_[m.step] += static_cast<float>(
      ramp_seconds(m.length, m.acceleration, std::sqrt(m.entry2), std::sqrt(exit2), m.speed));
  front_ = (front_ + 1) % ring_.size();
  --count_;
}

void Planner::stop() {
  while (count_ > 0) finish_front();
  stopped_ = true;
}

void Planner::set_position(Point3 to) {
  stop();
  here_ = rounded(to);
}

}  // namespace kerf::detail

// Lines and arcs along a polyline: from each point the longest stretch that one of them fits.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "fit_check.h"
#include "segment.h"

#include "kerf/fit.h"

namespace kerf {
namespace {

using namespace outline_detail;

/// A stretch of points that one arc over their chord may replace. The arc is told by its height over the
/// middle of the chord (above 0: to the left); each point allows an interval of heights.
class Stretch {
 public:
  Stretch(const std::vector<Point2>& points, std::size_t first, std::size_t last, double within)
      : points_(points), first_(first), last_(last), slack_(0.5 * within) {}
  /// The height of an arc that fits, 0 for a line; false if none does.
  bool fit(double& height);

 private:
  double height_through(double x, double y) const;
  bool allow(Point2 p);
  bool chords_fit(double height) const;
  const std::vector<Point2>& points_;
  std::size_t first_, last_;
  double slack_;  // half for the points, half for what an arc rises above the chords between them
  Point2 middle_, direction_;
  double half_ = 0.0;  // of the chord
  double low_ = 0.0, high_ = 0.0;
};

/// Height of the arc over the chord through a point `x` beside the chord's middle and `y` to its left.
double Stretch::height_through(double x, double y) const {
  if (y == 0.0) return 0.0;
  const double up = std::abs(y);
  const double centre = (x * x + up * up - half_ * half_) / (2.0 * up);
  const double root = std::sqrt(centre * centre + half_ * half_);
  const double height = centre > 0.0 ? root + centre : half_ * half_ / (root - centre);
  return y > 0.0 ? height : -height;
}

bool Stretch::allow(Point2 p) {
  const Point2 q = p - middle_;
  const double x = dot(q, direction_), y = cross(direction_, q);
  if (std::abs(x) >= half_) return std::abs(x) - half_ <= slack_ && std::abs(y) <= slack_;
  low_ = std::max(low_, height_through(x, y - slack_));
  high_ = std::min(high_, height_through(x, y + slack_));
  return low_ <= high_;
}

bool Stretch::chords_fit(double height) const {
  if (height == 0.0) return true;
  const double radius = 0.5 * (height * height + half_ * half_) / std::abs(height);
  for (std::size_t i = first_; i < last_; ++i) {
    const double half = 0.5 * distance(points_[i], points_[i + 1]);
    if (half > radius || half * half > slack_ * (radius + std::sqrt(radius * radius - half * half)))
      return false;
  }
  return true;
}

bool Stretch::fit(double& height) {
  const Point2 chord = points_[last_] - points_[first_];
  const double length = norm(chord);
  if (length == 0.0) return false;
  half_ = 0.5 * length;
  middle_ = points_[first_] + 0.5 * chord;
  direction_ = (1.0 / length) * chord;
  low_ = -half_;
  high_ = half_;  // at most half a turn
  for (std::size_t i = first_ + 1; i < last_; ++i)
    if (!allow(points_[i])) return false;
  height = low_ <= 0.0 && high_ >= 0.0 ? 0.0 : 0.5 * (low_ + high_);
  return chords_fit(height);
}

/// The last point that one line or arc reaches from `first`, looked for in steps that double and then halve.
std::size_t furthest(const std::vector<Point2>& points, std::size_t first, double within, double& height) {
  std::size_t good = first + 1;
  height = 0.0;
  const auto reaches = [&](std::size_t last) {
    double found = 0.0;
    if (!Stretch(points, first, last, within).fit(found)) return false;
    height = found;
    good = last;
    return true;
  };
  std::size_t step = 1;
  while (good + step < points.size() && reaches(good + step)) step *= 2;
  for (; step > 0; step /= 2)
    if (good + step < points.size()) reaches(good + step);
  return good;
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
  if (distinct.size() == 1) made.segments.push_back({made.start, {}, {}});
  for (std::size_t i = 0; i + 1 < distinct.size();) {
    double height = 0.0;
    const std::size_t last = furthest(distinct, i, within.mm(), height);
    Segment segment{distinct[last], {}, {}};
    const Point2 chord = distinct[last] - distinct[i];
    if (height != 0.0) segment.via = distinct[i] + 0.5 * chord + (height / norm(chord)) * left_of(chord);
    made.segments.push_back(segment);
    i = last;
  }
  return made;
}

}  // namespace kerf

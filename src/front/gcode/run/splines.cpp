// G5 to G5.3: splines as chains of chords within a tolerance.
//
// Source: LinuxCNC's pages "G5 Cubic Spline", "G5.1 Quadratic Spline", "G5.2 G5.3 NURBS Block".
#include "front/gcode/run/splines.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "base/codes/gcode.h"

#include "kerf/base/limits.h"

namespace kerf::gcode {
namespace {

constexpr Length kChordTolerance = mm(0.002);
constexpr std::size_t kMaxPoints = 10'000;
constexpr int kMaxOrder = 20;
constexpr int kDefaultOrder = 3;

}  // namespace

void Splines::curve(Tenths motion) {
  if (modes_.plane != Plane::xy || !coordinates_.frame().only_shifted) {
    reporter_.error(
        codes::code_unsupported, line_.column(),
        "splines are supported in the XY plane only, without rotation and scale; the line is skipped");
    return line_.use(kAllLetters);
  }
  if (motion == 50) return cubic();
  if (motion == 51) return quadratic();
  nurbs();
}

/// Two words as a vector in mm; nothing if both are missing.
std::optional<Point2> Splines::point_words(char u, char v) {
  const std::optional<double> x = line_.take(u), y = line_.take(v);
  if (!x && !y) return std::nullopt;
  return modes_.scale * Point2{x.value_or(0.0), y.value_or(0.0)};
}

/// Cuts along a spline from the current position at constant Z and feed.
void Splines::cut_along(const Spline& spline) {
  const std::vector<Point2> points = flattened(spline, kChordTolerance, limits::kMaxChords);
  double total = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) total += distance(points[i - 1], points[i]);
  const double feed = feeds_.feed_for(total);
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (steps_.full()) return;
    ToolPosition to = position_;
    to.at.x = points[i].x;
    to.at.y = points[i].y;
    to.unknown &= ~3u;
    if (!reachable(to.at)) return;
    mover_.cut(to, feed);
  }
}

/// G5 X Y I J P Q: control points relative to the start (I J) and to the end (P Q). Without I J the curve
/// continues the last one with the same tangent.
void Splines::cubic() {
  const std::optional<ToolPosition> to = mover_.target();
  if (!to) return;
  const std::optional<Point2> first = point_words('I', 'J'), second = point_words('P', 'Q');
  if (!second || (!first && !last_control_point_)) {
    reporter_.error(codes::word_missing, line_.column(),
                    "G5 needs P and Q, and also I and J unless a G5 precedes it; skipped");
    return line_.use(kAllLetters);
  }
  const Point2 a = position_.at.xy(), d = to->at.xy();
  const Point2 b = a + first.value_or(-last_control_point_.value_or(Point2{}));
  cut_along(clamped_spline(3, {a, b, d + *second, d}));
  last_control_point_ = *second;
}

/// G5.1 X Y I J: one control point, relative to the start.
void Splines::quadratic() {
  const std::optional<ToolPosition> to = mover_.target();
  if (!to) return;
  const std::optional<Point2> control = point_words('I', 'J');
  if (!control) {
    reporter_.error(codes::word_missing, line_.column(), "G5.1 needs I or J, its control point; skipped");
    return line_.use(kAllLetters);
  }
  const Point2 a = position_.at.xy();
  cut_along(clamped_spline(2, {a, a + *control, to->at.xy()}));
}

/// The position of the tool is the first control point; G5.2 P without X and Y gives its weight.
void Splines::add_control_point() {
  const bool first = control_points_.empty();
  if (first) curve_order_ = kDefaultOrder;
  if (const auto order = line_.take('L'))
    curve_order_ = static_cast<int>(std::clamp(std::floor(*order), 2.0, double{kMaxOrder}));
  const bool position_given = line_.has_unused(kAxisLetters);
  const std::optional<ToolPosition> to = mover_.target();
  const double weight = line_.take('P').value_or(1.0);
  if (!to || control_points_.size() > kMaxPoints) return;
  if (!(weight > 0.0 && weight < 1e6)) {
    reporter_.error(codes::word_out_of_range, line_.column('P'),
                    "the weight of a control point must be above 0");
    return;
  }
  if (first) {
    control_points_.push_back(position_.at.xy());
    control_weights_.push_back(position_given ? 1.0 : weight);
  }
  if (!position_given) return;
  control_points_.push_back(to->at.xy());
  control_weights_.push_back(weight);
}

/// G5.2 X Y P L collects control points until G5.3 draws the curve.
void Splines::nurbs() {
  const bool draws = line_.has(Group::motion) && line_.code(Group::motion) == 53;
  if (!draws) return add_control_point();
  const std::vector<Point2> points = std::exchange(control_points_, {});
  const std::vector<double> weights = std::exchange(control_weights_, {});
  modes_.motion = kNoMotion;
  if (points.size() < 2 || static_cast<int>(points.size()) < curve_order_) {
    reporter_.error(
        codes::word_missing, line_.column(),
        fmt::format("G5.3 has order {}, which needs at least as many control points", curve_order_));
    return;
  }
  cut_along(clamped_spline(curve_order_ - 1, points, weights));
}

}  // namespace kerf::gcode

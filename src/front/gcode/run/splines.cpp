// G5 to G5.3: splines as chains of chords within a tolerance.
//
// Source: LinuxCNC's pages "G5 Cubic Spline", "G5.1 Quadratic Spline", "G5.2 G5.3 NURBS Block".
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "front/gcode/run/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr Length kChord = mm(0.002);  // that a chord may stray from its curve
constexpr int kMaxChords = 10'000;    // of one curve
constexpr std::size_t kMaxPoints = 10'000;
constexpr int kHighestOrder = 20;
constexpr int kUsualOrder = 3;

}  // namespace

void Interpreter::curve(Tenths motion) {
  if (modes_.plane != Plane::xy || !placement_.plain) {
    talker_.error(Code::code_unsupported, line_.column(),
                  "splines lie in the XY plane, neither turned nor scaled; the line is left out");
    return line_.use(kAllLetters);
  }
  if (motion == 50) return cubic();
  if (motion == 51) return quadratic();
  nurbs();
}

/// Two words as a vector in mm; nothing where both are absent.
std::optional<Point2> Interpreter::point_words(char u, char v) {
  const std::optional<double> x = line_.take(u), y = line_.take(v);
  if (!x && !y) return std::nullopt;
  return modes_.scale * Point2{x.value_or(0.0), y.value_or(0.0)};
}

/// Cuts along a spline from here, Z and the feed staying.
void Interpreter::cut_along(const Spline& spline) {
  const std::vector<Point2> points = flattened(spline, kChord, kMaxChords);
  double total = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) total += distance(points[i - 1], points[i]);
  const double feed = feed_for(total);
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (full_) return;
    Place to = here_;
    to.at.x = points[i].x;
    to.at.y = points[i].y;
    to.unknown &= ~3u;
    if (!reachable(to.at)) return;
    cut(to, feed);
  }
}

/// G5 X Y I J P Q: handles from the start (I J) and from the end (P Q). Without I J the curve continues the
/// last one.
void Interpreter::cubic() {
  const std::optional<Place> to = target();
  if (!to) return;
  const std::optional<Point2> first = point_words('I', 'J'), second = point_words('P', 'Q');
  if (!second || (!first && !last_curve_handle_)) {
    talker_.error(Code::word_missing, line_.column(),
                  "G5 needs P and Q, and I and J where no G5 goes before; it is left out");
    return line_.use(kAllLetters);
  }
  const Point2 a = here_.at.xy(), d = to->at.xy();
  const Point2 b = a + first.value_or(-last_curve_handle_.value_or(Point2{}));
  cut_along(clamped_spline(3, {a, b, d + *second, d}));
  last_curve_handle_ = *second;
}

/// G5.1 X Y I J: one handle, from the start.
void Interpreter::quadratic() {
  const std::optional<Place> to = target();
  if (!to) return;
  const std::optional<Point2> handle = point_words('I', 'J');
  if (!handle) {
    talker_.error(Code::word_missing, line_.column(), "G5.1 needs I or J, its handle; it is left out");
    return line_.use(kAllLetters);
  }
  const Point2 a = here_.at.xy();
  cut_along(clamped_spline(2, {a, a + *handle, to->at.xy()}));
}

/// The position of the tool is the first control point; G5.2 P without X and Y gives its weight.
void Interpreter::add_control_point() {
  const bool first = control_points_.empty();
  if (first) curve_order_ = kUsualOrder;
  if (const auto order = line_.take('L'))
    curve_order_ = static_cast<int>(std::clamp(std::floor(*order), 2.0, double{kHighestOrder}));
  const bool place_told = line_.has_unused(kAxisLetters);
  const std::optional<Place> to = target();
  const double weight = line_.take('P').value_or(1.0);
  if (!to || control_points_.size() > kMaxPoints) return;
  if (!(weight > 0.0 && weight < 1e6)) {
    talker_.error(Code::word_out_of_range, line_.column('P'), "the weight of a control point is above 0");
    return;
  }
  if (first) {
    control_points_.push_back(here_.at.xy());
    control_weights_.push_back(place_told ? 1.0 : weight);
  }
  if (!place_told) return;
  control_points_.push_back(to->at.xy());
  control_weights_.push_back(weight);
}

/// G5.2 X Y P L collects control points until G5.3 draws the curve.
void Interpreter::nurbs() {
  const bool draws = line_.has(Group::motion) && line_.code(Group::motion) == 53;
  if (!draws) return add_control_point();
  const std::vector<Point2> points = std::exchange(control_points_, {});
  const std::vector<double> weights = std::exchange(control_weights_, {});
  modes_.motion = kNoMotion;
  if (points.size() < 2 || static_cast<int>(points.size()) < curve_order_) {
    talker_.error(Code::word_missing, line_.column(),
                  fmt::format("G5.3 draws a curve of order {}, which needs as many points", curve_order_));
    return;
  }
  cut_along(clamped_spline(curve_order_ - 1, points, weights));
}

}  // namespace kerf::gcode

// G5 to G5.3: splines as chains of chords within a tolerance.
//
// Source: LinuxCNC's pages "G5 Cubic Spline", "G5.1 Quadratic Spline", "G5.2 G5.3 NURBS Block".
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "front/gcode/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr double kChord = 0.002;     // mm that a chord may stray from its curve
constexpr int kMostChords = 10'000;  // of one curve
constexpr std::size_t kMostPoints = 10'000;
constexpr int kHighestOrder = 20;
constexpr int kUsualOrder = 3;

/// Chords of a cubic in Bezier form: its second derivative is largest at an end.
int chords_of(Point2 a, Point2 b, Point2 c, Point2 d) {
  const double bend = std::max(length(a - 2.0 * b + c), length(b - 2.0 * c + d));
  const double count = std::ceil(std::sqrt(0.75 * bend / kChord));
  return std::isfinite(count) ? static_cast<int>(std::clamp(count, 1.0, double{kMostChords})) : 1;
}

Point2 cubic_at(Point2 a, Point2 b, Point2 c, Point2 d, double t) {
  const double s = 1.0 - t;
  return s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d;
}

struct Weighted {
  Point2 p;
  double w = 1.0;
};

/// A point of a rational B-spline with clamped, evenly spaced knots, by de Boor's scheme.
Point2 spline_at(const std::vector<Weighted>& points, int order, double t) {
  const int degree = order - 1;
  const int last = static_cast<int>(points.size()) - 1;
  const int spans = last - degree + 1;
  const auto knot = [&](int i) { return static_cast<double>(std::clamp(i - degree, 0, spans)); };
  const int span = std::clamp(static_cast<int>(t), 0, spans - 1) + degree;
  std::vector<Weighted> d;
  for (int j = 0; j <= degree; ++j) {
    const Weighted& from = points[static_cast<std::size_t>(span - degree + j)];
    d.push_back({from.w * from.p, from.w});
  }
  for (int r = 1; r <= degree; ++r)
    for (int j = degree; j >= r; --j) {
      const double low = knot(span - degree + j), high = knot(span + 1 + j - r);
      const double share = high > low ? (t - low) / (high - low) : 0.0;
      Weighted& here = d[static_cast<std::size_t>(j)];
      const Weighted& before = d[static_cast<std::size_t>(j - 1)];
      here.p = (1.0 - share) * before.p + share * here.p;
      here.w = (1.0 - share) * before.w + share * here.w;
    }
  const Weighted& end = d[static_cast<std::size_t>(degree)];
  return (1.0 / end.w) * end.p;
}

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

/// Cuts to each point in turn, Z and the feed staying.
void Interpreter::polyline(const std::vector<Point2>& points) {
  double total = 0.0;
  Point2 from = here_.at.xy();
  for (const Point2 p : points) {
    total += distance(from, p);
    from = p;
  }
  const double feed = feed_for(total);
  for (const Point2 p : points) {
    if (full_) return;
    Place to = here_;
    to.at.x = p.x;
    to.at.y = p.y;
    to.unknown &= ~3u;
    if (!reachable(to.at)) return;
    cut(to, feed);
  }
}

/// G5 X Y I J P Q: handles from the begin (I J) and from the end (P Q). Without I J the curve goes on as the
/// last one ended.
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
  const Point2 b = a + first.value_or(-1.0 * last_curve_handle_.value_or(Point2{}));
  const Point2 c = d + *second;
  const int count = chords_of(a, b, c, d);
  std::vector<Point2> points;
  for (int i = 1; i <= count; ++i) points.push_back(i == count ? d : cubic_at(a, b, c, d, i / double(count)));
  polyline(points);
  last_curve_handle_ = *second;
}

/// G5.1 X Y I J: one handle, from the begin.
void Interpreter::quadratic() {
  const std::optional<Place> to = target();
  if (!to) return;
  const std::optional<Point2> handle = point_words('I', 'J');
  if (!handle) {
    talker_.error(Code::word_missing, line_.column(), "G5.1 needs I or J, its handle; it is left out");
    return line_.use(kAllLetters);
  }
  const Point2 a = here_.at.xy(), d = to->at.xy(), middle = a + *handle;
  const Point2 b = a + 2.0 / 3.0 * (middle - a), c = d + 2.0 / 3.0 * (middle - d);
  const int count = chords_of(a, b, c, d);
  std::vector<Point2> points;
  for (int i = 1; i <= count; ++i) points.push_back(i == count ? d : cubic_at(a, b, c, d, i / double(count)));
  polyline(points);
}

/// The place where the tool stands is the first control point, whose weight G5.2 P without X and Y tells.
void Interpreter::add_control_point() {
  const bool first = control_points_.empty();
  if (first) curve_order_ = kUsualOrder;
  if (const auto order = line_.take('L'))
    curve_order_ = static_cast<int>(std::clamp(std::floor(*order), 2.0, double{kHighestOrder}));
  const bool place_told = line_.has_unused(kAxisLetters);
  const std::optional<Place> to = target();
  const double weight = line_.take('P').value_or(1.0);
  if (!to || control_points_.size() > kMostPoints) return;
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
  std::vector<Weighted> points;
  for (std::size_t i = 0; i < control_points_.size(); ++i)
    points.push_back({control_points_[i], control_weights_[i]});
  control_points_.clear();
  control_weights_.clear();
  modes_.motion = kNoMotion;
  if (points.size() < 2 || static_cast<int>(points.size()) < curve_order_) {
    talker_.error(Code::word_missing, line_.column(),
                  fmt::format("G5.3 draws a curve of order {}, which needs as many points", curve_order_));
    return;
  }
  double hull = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) hull += distance(points[i - 1].p, points[i].p);
  const int spans = static_cast<int>(points.size()) - curve_order_ + 1;
  const double wanted = std::ceil(std::sqrt(hull / kChord) / spans) * spans;
  const int count = static_cast<int>(std::clamp(wanted, double(spans), double{kMostChords}));
  std::vector<Point2> chain;
  for (int i = 1; i <= count; ++i)
    chain.push_back(spline_at(points, curve_order_, spans * (i / double(count))));
  chain.back() = points.back().p;
  polyline(chain);
}

}  // namespace kerf::gcode

// Bézier curves and splines as pairs of arcs: a piece is halved until its arcs are near enough.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/outline.h"
#include "curve.h"
#include "fit_check.h"
#include "geom/outline/segment.h"

#include "kerf/geom/fit.h"

namespace kerf {
namespace outline_detail {

bool check_fit(const std::vector<Point2>& points, std::size_t fewest, Length within,
               const FitOptions& options, Diagnostics& diagnostics) {
  const auto refuse = [&](Code code, const std::string& what) {
    diagnostics.error(code, options.where, fmt::format("curve \"{}\": {}", options.name, what));
    return false;
  };
  if (points.size() < fewest)
    return refuse(codes::curve_malformed, fmt::format("at least {} points are needed", fewest));
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!usable(points[i]))
      return refuse(codes::outline_not_finite,
                    fmt::format("point {}: a number is not finite or beyond 1e60", i));
  if (!(within.mm() > 0.0 && within.mm() <= kLargestCoordinate))
    return refuse(codes::region_bad_argument,
                  fmt::format("the tolerance must be above 0 and at most 1e60, not {:g}", within.mm()));
  return true;
}

}  // namespace outline_detail

namespace {

using namespace outline_detail;

constexpr int kSamples = 16;  // intervals of a piece, at whose ends it is compared
constexpr double kSampled =
    0.9;  // fraction of the tolerance permitted at samples, for deviations between them
constexpr double kShortest = 1e-6;     // of the whole range of the parameter
constexpr double kRounding = 0x1p-40;  // of the largest coordinate: no tolerance is finer
constexpr double kWeights = 1e3;       // the largest weight

class CurveFitter {
 public:
  CurveFitter(const RationalBezier& curve, double within, Outline& made)
      : curve_(curve), within_(within), made_(made) {}
  /// Appends the whole curve.
  void run() {
    // Halves, so that a closed curve has a chord.
    piece(0.0, 0.5);
    piece(0.5, 1.0);
  }

 private:
  Point2 direction(double t, double towards) const;
  void piece(double from, double to);
  bool near(double from, double to, const Carrier* carriers, int count) const;
  bool arcs(double from, double to, Point2 end);
  const RationalBezier& curve_;
  double within_;
  Outline& made_;
};

/// Unit direction at t of the piece between t and `towards`; where the derivative is zero, that of a short
/// chord.
Point2 CurveFitter::direction(double t, double towards) const {
  const CurveSample here = curve_.at(t);
  const double sense = towards > t ? 1.0 : -1.0;
  Point2 slope = here.slope;
  const double size = norm(curve_.at(towards).at - here.at) / std::abs(towards - t);
  if (!(norm(slope) > 1e-6 * size)) slope = sense * (curve_.at(t + 1e-3 * (towards - t)).at - here.at);
  const double length = norm(slope);
  return length > 0.0 ? (1.0 / length) * slope : Point2{};
}

bool CurveFitter::near(double from, double to, const Carrier* carriers, int count) const {
  for (int i = 1; i < kSamples; ++i) {
    const Point2 p = curve_.at(from + (to - from) * i / kSamples).at;
    double least = distance_to(carriers[0], p);
    for (int k = 1; k < count; ++k) least = std::min(least, distance_to(carriers[k], p));
    if (!(least <= kSampled * within_)) return false;
  }
  return true;
}

/// Two arcs that meet in the incentre of the triangle of chord and tangents, as `smooth_curve` makes them.
bool CurveFitter::arcs(double from, double to, Point2 end) {
  const Point2 start = made_.point(made_.segments.size());
  const Point2 first = direction(from, to), last = direction(to, from);
  const CurvePoint a{start, radians(std::atan2(first.y, first.x))};
  const CurvePoint b{end, radians(std::atan2(last.y, last.x))};
  CurveOptions options;
  options.straight = {};
  Diagnostics unused;
  const auto pair = smooth_curve({a, b}, options, unused);
  if (!pair) return false;
  Carrier carriers[2];
  int count = 0;
  Point2 at = start;
  for (const Segment& s : pair->segments) {
    carriers[count++] = make_carrier(at, s, 0.0);
    at = s.to;
  }
  if (!near(from, to, carriers, count)) return false;
  made_.segments.insert(made_.segments.end(), pair->segments.begin(), pair->segments.end());
  return true;
}

void CurveFitter::piece(double from, double to) {
  const Point2 end = curve_.at(to).at, start = made_.point(made_.segments.size());
  if (!(start == end) && arcs(from, to, end)) return;
  const Carrier line = make_carrier(start, {end, {}}, 0.0);
  const bool is_point = distance(start, end) <= within_ && near(from, to, &line, 1);
  if (to - from > kShortest && !is_point) {
    const double between = 0.5 * (from + to);
    piece(from, between);
    piece(between, to);
  } else if (!(start == end)) {
    made_.segments.push_back({end, {}});
  }
}

bool check_spline(const Spline& spline, const FitOptions& options, Diagnostics& diagnostics) {
  const auto refuse = [&](const char* what) {
    diagnostics.error(codes::curve_malformed, options.where,
                      fmt::format("curve \"{}\": {}", options.name, what));
    return false;
  };
  if (spline.degree < 1 || spline.degree > kMaxDegree) return refuse("the degree must be 1 to 25");
  const auto degree = static_cast<std::size_t>(spline.degree);
  if (spline.control.size() <= degree) return refuse("more control points than the degree are needed");
  if (spline.knots.size() != spline.control.size() + degree + 1)
    return refuse("as many knots as control points and degree and 1 are needed");
  for (std::size_t i = 0; i < spline.knots.size(); ++i)
    if (!std::isfinite(spline.knots[i]) || (i > 0 && spline.knots[i] < spline.knots[i - 1]))
      return refuse("a knot is not finite, or falls below the one before");
  if (!(spline.knots[spline.control.size()] > spline.knots[degree])) return refuse("the knots span nothing");
  if (!spline.weights.empty() && spline.weights.size() != spline.control.size())
    return refuse("there must be a weight for each control point");
  for (const double w : spline.weights)
    if (!(w >= 1.0 / kWeights && w <= kWeights)) return refuse("weights must be numbers from 0.001 to 1000");
  return true;
}

Outline fit_pieces(const std::vector<RationalBezier>& pieces, Length within) {
  double largest = 0.0;
  for (const RationalBezier& piece : pieces)
    for (const auto& c : piece.control)
      largest = std::max({largest, std::abs(c.x / c.w), std::abs(c.y / c.w)});
  const double slack = std::max(within.mm(), kRounding * largest);
  Outline made;
  made.start = pieces.front().at(0.0).at;
  for (const RationalBezier& piece : pieces) CurveFitter(piece, slack, made).run();
  return made;
}

}  // namespace

std::optional<Outline> fit_bezier(const std::vector<Point2>& control, Length within,
                                  const FitOptions& options, Diagnostics& diagnostics) {
  if (!check_fit(control, 2, within, options, diagnostics)) return std::nullopt;
  if (control.size() > kMaxDegree + 1)
    return diagnostics.error(codes::curve_malformed, options.where,
                             fmt::format("curve \"{}\": more than 26 control points", options.name)),
           std::nullopt;
  RationalBezier curve;
  for (const Point2 p : control) curve.control.push_back({p.x, p.y, 1.0});
  return fit_pieces({curve}, within);
}

std::optional<Outline> fit_spline(const Spline& spline, Length within, const FitOptions& options,
                                  Diagnostics& diagnostics) {
  if (!check_fit(spline.control, 2, within, options, diagnostics) ||
      !check_spline(spline, options, diagnostics))
    return std::nullopt;
  return fit_pieces(pieces_of(spline), within);
}

}  // namespace kerf

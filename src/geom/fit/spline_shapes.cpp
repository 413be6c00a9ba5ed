// Splines from other descriptions of a curve: arcs of ellipses, and points to pass through.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "fit_check.h"

#include "kerf/geom/fit.h"

namespace kerf {
namespace {

/// Solves a system whose matrix has `lower`, `diagonal` and `upper` beside each other in each row; the
/// diagonal dominates. The right-hand side becomes the solution.
void solve_tridiagonal(const std::vector<double>& lower, std::vector<double> diagonal,
                       const std::vector<double>& upper, std::vector<Point2>& right) {
  const std::size_t n = right.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = lower[i] / diagonal[i - 1];
    diagonal[i] -= factor * upper[i - 1];
    right[i] = right[i] - factor * right[i - 1];
  }
  for (std::size_t i = n; i-- > 0;) {
    if (i + 1 < n) right[i] = right[i] - upper[i] * right[i + 1];
    right[i] = (1.0 / diagonal[i]) * right[i];
  }
}

/// The derivatives at the points that make the second derivative continuous; `h` are the distances.
class Derivatives {
 public:
  Derivatives(const std::vector<Point2>& points, const std::vector<double>& h) : points_(points), h_(h) {}
  std::vector<Point2> open(std::optional<Point2> start, std::optional<Point2> end) const;
  std::vector<Point2> closed() const;

 private:
  Point2 slope(std::size_t i) const { return (1.0 / h_[i]) * (points_[i + 1] - points_[i]); }
  /// The row of a point between the spans `before` and `after`.
  Point2 inner(std::size_t before, std::size_t after) const {
    return 3.0 * (h_[after] * slope(before) + h_[before] * slope(after));
  }
  const std::vector<Point2>& points_;
  const std::vector<double>& h_;
};

std::vector<Point2> Derivatives::open(std::optional<Point2> start, std::optional<Point2> end) const {
  const std::size_t n = points_.size();
  std::vector<double> lower(n), diagonal(n, 1.0), upper(n);
  std::vector<Point2> right(n);
  const auto unit = [](std::optional<Point2> d) -> std::optional<Point2> {
    const double size = d ? length(*d) : 0.0;
    if (!(size > 0.0) || !std::isfinite(size)) return std::nullopt;
    return (1.0 / size) * *d;
  };
  const auto first = unit(start), last = unit(end);
  right[0] = first ? *first : 3.0 * slope(0);
  right[n - 1] = last ? *last : 3.0 * slope(n - 2);
  if (!first) diagonal[0] = 2.0, upper[0] = 1.0;
  if (!last) diagonal[n - 1] = 2.0, lower[n - 1] = 1.0;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    lower[i] = h_[i];
    diagonal[i] = 2.0 * (h_[i - 1] + h_[i]);
    upper[i] = h_[i - 1];
    right[i] = inner(i - 1, i);
  }
  solve_tridiagonal(lower, diagonal, upper, right);
  return right;
}

/// The last point is the first. The corners of the cyclic matrix are treated by the Sherman-Morrison
/// formula.
std::vector<Point2> Derivatives::closed() const {
  const std::size_t n = points_.size() - 1;
  std::vector<double> lower(n), diagonal(n), upper(n);
  std::vector<Point2> right(n), corner(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = i == 0 ? n - 1 : i - 1;
    lower[i] = h_[i];
    diagonal[i] = 2.0 * (h_[before] + h_[i]);
    upper[i] = h_[before];
    right[i] = inner(before, i);
  }
  const double top = lower[0], bottom = upper[n - 1], gamma = -diagonal[0];
  diagonal[0] -= gamma;
  diagonal[n - 1] -= top * bottom / gamma;
  corner[0].x = gamma;
  corner[n - 1].x = bottom;
  solve_tridiagonal(lower, diagonal, upper, right);
  solve_tridiagonal(lower, diagonal, upper, corner);
  const Point2 along = right[0] + (top / gamma) * right[n - 1];
  const double scale = 1.0 + corner[0].x + top / gamma * corner[n - 1].x;
  for (std::size_t i = 0; i < n; ++i) right[i] = right[i] - (corner[i].x / scale) * along;
  right.push_back(right[0]);
  return right;
}

}  // namespace

Spline ellipse_spline(Point2 centre, Point2 u, Point2 v, Angle start, Angle sweep) {
  const double turn = std::clamp(sweep.rad(), -2.0 * std::numbers::pi, 2.0 * std::numbers::pi);
  const int pieces =
      std::max(1, static_cast<int>(std::ceil(std::abs(turn) / (0.5 * std::numbers::pi) - 1e-9)));
  const double step = turn / pieces, weight = std::cos(0.5 * step);
  const auto at = [&](double t, double factor) {
    return centre + factor * (std::cos(t) * u + std::sin(t) * v);
  };
  Spline made;
  made.degree = 2;
  made.control.push_back(at(start.rad(), 1.0));
  made.weights.push_back(1.0);
  made.knots.assign(3, 0.0);
  for (int i = 0; i < pieces; ++i) {
    const double from = start.rad() + i * step;
    made.control.push_back(at(from + 0.5 * step, 1.0 / weight));
    made.control.push_back(at(from + step, 1.0));
    made.weights.insert(made.weights.end(), {weight, 1.0});
    made.knots.insert(made.knots.end(), i + 1 < pieces ? 2 : 3, i + 1.0);
  }
  const bool full = std::abs(std::abs(turn) - 2.0 * std::numbers::pi) < 1e-9;
  if (full) made.control.back() = made.control.front();
  return made;
}

std::optional<Spline> spline_through(const std::vector<Point2>& given, const SplineEnds& ends,
                                     const FitOptions& options, Diagnostics& diagnostics) {
  if (!outline_detail::check_fit(given, 2, mm(1.0), options, diagnostics)) return std::nullopt;
  std::vector<Point2> points;
  std::vector<double> h;
  const auto add = [&](Point2 p) {
    const double step = points.empty() ? 1.0 : distance(points.back(), p);
    if (!(step > 0.0)) return;
    if (!points.empty()) h.push_back(step);
    points.push_back(p);
  };
  for (const Point2 p : given) add(p);
  if (ends.closed) add(points.front());
  if (!outline_detail::check_fit(points, 2, mm(1.0), options, diagnostics)) return std::nullopt;
  const Derivatives derivatives(points, h);
  const bool ring = ends.closed && points.size() > 3;
  const std::vector<Point2> slopes = ring ? derivatives.closed() : derivatives.open(ends.start, ends.end);
  Spline made;
  made.control.push_back(points[0]);
  made.knots.assign(4, 0.0);
  double knot = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    made.control.push_back(points[i] + (h[i] / 3.0) * slopes[i]);
    made.control.push_back(points[i + 1] - (h[i] / 3.0) * slopes[i + 1]);
    made.control.push_back(points[i + 1]);
    knot += h[i];
    made.knots.insert(made.knots.end(), i + 2 < points.size() ? 3 : 4, knot);
  }
  return made;
}

}  // namespace kerf

// Points of Bézier curves, and splines as Bézier curves.
#include "curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace kerf::outline_detail {

/// De Casteljau's corner cutting; the last two points give the derivative.
CurveSample RationalBezier::at(double t) const {
  std::array<Control, kMaxDegree + 1> p;
  std::copy(control.begin(), control.end(), p.begin());
  const std::size_t n = control.size() - 1;
  Control before = p[0], after = p[n];
  for (std::size_t k = n; k > 0; --k) {
    if (k == 1) before = p[0], after = p[1];
    for (std::size_t i = 0; i < k; ++i)
      p[i] = {(1.0 - t) * p[i].x + t * p[i + 1].x, (1.0 - t) * p[i].y + t * p[i + 1].y,
              (1.0 - t) * p[i].w + t * p[i + 1].w};
  }
  const Point2 at{p[0].x / p[0].w, p[0].y / p[0].w};
  const double scale = static_cast<double>(n) / p[0].w, dw = after.w - before.w;
  return {at, {scale * (after.x - before.x - dw * at.x), scale * (after.y - before.y - dw * at.y)}};
}

/// A chord over a step h of the parameter is within h^2 / 8 of the curve times a bound of its second
/// derivative. With r = P / w that is r'' = (P'' - 2 w' r' - w'' r) / w, and the derivatives of P and w are
/// bounded by the differences of their control points.
int RationalBezier::chords(double chord, int limit) const {
  const double degree = static_cast<double>(control.size() - 1);
  Point2 low{control[0].x / control[0].w, control[0].y / control[0].w}, high = low;
  double min_weight = control[0].w;
  for (const Control& c : control) {
    low = {std::min(low.x, c.x / c.w), std::min(low.y, c.y / c.w)};
    high = {std::max(high.x, c.x / c.w), std::max(high.y, c.y / c.w)};
    min_weight = std::min(min_weight, c.w);
  }
  const Point2 origin = 0.5 * (low + high);  // as seen from here the curve is nowhere far
  const double reach = 0.5 * length(high - low);
  const auto seen = [&](const Control& c) { return Point2{c.x - c.w * origin.x, c.y - c.w * origin.y}; };
  double first = 0.0, second = 0.0, first_w = 0.0, second_w = 0.0;  // largest differences
  for (std::size_t i = 0; i + 1 < control.size(); ++i) {
    first = std::max(first, length(seen(control[i + 1]) - seen(control[i])));
    first_w = std::max(first_w, std::abs(control[i + 1].w - control[i].w));
    if (i == 0) continue;
    const Control &a = control[i - 1], &b = control[i], &c = control[i + 1];
    second = std::max(second, length(seen(a) - 2.0 * seen(b) + seen(c)));
    second_w = std::max(second_w, std::abs(a.w - 2.0 * b.w + c.w));
  }
  const double slope = degree * (first + first_w * reach) / min_weight;
  const double curving =
      (degree * (degree - 1.0) * (second + second_w * reach) + 2.0 * degree * first_w * slope) / min_weight;
  const double count = std::ceil(std::sqrt(curving / (8.0 * chord)));
  return std::isfinite(count) ? static_cast<int>(std::clamp(count, 1.0, static_cast<double>(limit))) : limit;
}

/// The polynomial pieces of a spline, each as a Bézier curve: its control point j is the spline's polar form
/// with the end of the span j times and its start for the rest.
std::vector<RationalBezier> pieces_of(const Spline& spline) {
  const auto degree = static_cast<std::size_t>(spline.degree);
  const std::vector<double>& knots = spline.knots;
  std::vector<RationalBezier::Control> control;
  for (std::size_t i = 0; i < spline.control.size(); ++i) {
    const double w = spline.weights.empty() ? 1.0 : spline.weights[i];
    control.push_back({w * spline.control[i].x, w * spline.control[i].y, w});
  }
  std::vector<RationalBezier> made;
  for (std::size_t span = degree; span < control.size(); ++span) {
    const double a = knots[span], b = knots[span + 1];
    if (!(b > a)) continue;
    RationalBezier piece;
    for (std::size_t j = 0; j <= degree; ++j) {
      std::array<RationalBezier::Control, kMaxDegree + 1> p;
      for (std::size_t i = 0; i <= degree; ++i) p[i] = control[span - degree + i];
      for (std::size_t round = 1; round <= degree; ++round) {
        const double t = round <= j ? b : a;
        for (std::size_t i = degree; i >= round; --i) {
          const double low = knots[span - degree + i], high = knots[span + 1 + i - round];
          const double fraction = high > low ? (t - low) / (high - low) : 0.0;
          p[i] = {(1.0 - fraction) * p[i - 1].x + fraction * p[i].x,
                  (1.0 - fraction) * p[i - 1].y + fraction * p[i].y,
                  (1.0 - fraction) * p[i - 1].w + fraction * p[i].w};
        }
      }
      piece.control.push_back(p[degree]);
    }
    made.push_back(std::move(piece));
  }
  return made;
}

}  // namespace kerf::outline_detail

namespace kerf {

Spline clamped_spline(int degree, std::vector<Point2> control, std::vector<double> weights) {
  Spline spline{degree, std::move(control), {}, std::move(weights)};
  const int spans = static_cast<int>(spline.control.size()) - degree;
  for (int i = -degree; i <= spans + degree; ++i) spline.knots.push_back(std::clamp(i, 0, spans));
  return spline;
}

std::vector<Point2> flattened(const Spline& spline, Length chord, int limit) {
  const std::vector<outline_detail::RationalBezier> pieces = outline_detail::pieces_of(spline);
  const int each = std::max(1, limit / static_cast<int>(pieces.size()));
  std::vector<Point2> points{spline.control.front()};
  for (const outline_detail::RationalBezier& piece : pieces) {
    const int count = piece.chords(chord.mm(), each);
    for (int i = 1; i <= count; ++i) points.push_back(piece.at(i == count ? 1.0 : i / double(count)).at);
  }
  points.back() = spline.control.back();
  return points;
}

}  // namespace kerf

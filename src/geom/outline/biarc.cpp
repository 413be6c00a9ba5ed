// Curves through samples as pairs of arcs (biarcs).
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/outline.h"
#include "segment.h"

#include "kerf/base/limits.h"
#include "kerf/geom/outline.h"

namespace kerf {
namespace {

using namespace outline_detail;

constexpr double kMuch = std::numbers::pi / 3.0;  // a heading further off its chord than this gets a warning
/// Below this half angle the two arcs differ from their chord by less than a rounding of its length.
constexpr double kFlatHalfAngle = 0.5 * kFlatArc;

/// Collects the messages of one curve.
class CurveReporter {
 public:
  CurveReporter(const CurveOptions& options, Diagnostics& diagnostics)
      : options_(options), diagnostics_(diagnostics) {}
  void warn(Code code, std::size_t piece, std::string_view what) {
    std::size_t& count = counts_[static_cast<std::size_t>(code) % 8];
    diagnostics_.warning(code, options_.where,
                         count++ < limits::kMaxMessagesPerCode
                             ? fmt::format("{}.{}: {}", options_.name, piece, what)
                             : std::string());
  }
  bool refuse(Code code, std::size_t piece, std::string_view what) {
    diagnostics_.error(code, options_.where, fmt::format("{}.{}: {}", options_.name, piece, what));
    return false;
  }

 private:
  const CurveOptions& options_;
  Diagnostics& diagnostics_;
  std::size_t counts_[8] = {};
};

/// One piece: a chord, and half the tangents of the headings' angles to it.
struct TangentChord {
  Point2 from, chord;  // unit
  double length = 0.0;
  double sine_a = 0.0, cosine_a = 0.0, sine_b = 0.0, cosine_b = 0.0;
};

TangentChord make_piece(Point2 from, Point2 heading_a, Point2 to, Point2 heading_b) {
  TangentChord p;
  p.from = from;
  p.length = norm(to - from);
  if (p.length == 0.0) return p;
  p.chord = (1.0 / p.length) * (to - from);
  p.sine_a = cross(p.chord, heading_a);
  p.cosine_a = dot(p.chord, heading_a);
  p.sine_b = cross(p.chord, heading_b);
  p.cosine_b = dot(p.chord, heading_b);
  return p;
}

/// The midpoint of an arc over a chord of half length `half` (vector), whose tangent is off the chord by an
/// angle with the half tangent `p`, on the side `sign` (+1 left).
Point2 midpoint_over(Point2 start, Point2 half, double p, double sign) {
  const double quarter = p / (1.0 + std::sqrt(1.0 + p * p));  // tangent of half of the half angle
  return start + half + (sign * quarter) * left_of(half);
}

class CurveSmoother {
 public:
  CurveSmoother(const CurveOptions& options, Diagnostics& diagnostics)
      : options_(options),
        reporter_(options, diagnostics),
        half_straight_(std::tan(0.5 * options.straight.rad())) {}
  bool add(std::size_t index, const TangentChord& piece, Point2 to);
  Outline outline;

 private:
  void line(Point2 to) { outline.segments.push_back({to, std::nullopt}); }
  void arcs(std::size_t index, const TangentChord& piece, double p, double q, Point2 to);
  const CurveOptions& options_;
  CurveReporter reporter_;
  double half_straight_;
};

bool CurveSmoother::add(std::size_t index, const TangentChord& piece, Point2 to) {
  static const double kMuchCosine = std::cos(kMuch);
  if (piece.length == 0.0) return reporter_.refuse(codes::curve_malformed, index, "two equal samples");
  constexpr double kRightAngle = -1e-12;  // cosine: a right angle by rounding is one
  if (piece.cosine_a < kRightAngle || piece.cosine_b < kRightAngle)
    return reporter_.refuse(codes::curve_turns_fast, index,
                            "a tangent is more than a right angle off the chord; put samples between");
  if (piece.cosine_a < kMuchCosine || piece.cosine_b < kMuchCosine)
    reporter_.warn(codes::curve_turns_much, index, "a tangent is more than 60 degrees off the chord");
  const double p = std::abs(piece.sine_a) / (1.0 + piece.cosine_a);
  const double q = std::abs(piece.sine_b) / (1.0 + piece.cosine_b);
  if (p < half_straight_ || q < half_straight_ || p < kFlatHalfAngle || q < kFlatHalfAngle) {
    reporter_.warn(codes::curve_piece_straight, index, "nearly straight: a line is made");
    line(to);
  } else if (piece.sine_a * piece.sine_b > 0.0) {
    reporter_.warn(codes::curve_inflexion, index, "an inflexion between the samples: a line is made");
    line(to);
  } else {
    arcs(index, piece, p, q, to);
  }
  return true;
}

/// The arcs meet in the incentre of the triangle of the chord and the tangents, where both run along the
/// chord.
void CurveSmoother::arcs(std::size_t index, const TangentChord& piece, double p, double q, Point2 to) {
  const double sign = piece.sine_a > 0.0 ? 1.0 : -1.0;
  const double x = piece.length * q / (p + q);
  const Point2 to_joint = x * piece.chord + (sign * x * p) * left_of(piece.chord);
  const Point2 joint = piece.from + to_joint;
  const Point2 rest = to - joint;
  outline.segments.push_back({joint, midpoint_over(piece.from, 0.5 * to_joint, p, sign)});
  outline.segments.push_back({to, midpoint_over(joint, 0.5 * rest, q, sign)});
  const double smallest = options_.min_radius.mm();
  if (smallest <= 0.0) return;
  const Point2 chords[2] = {to_joint, rest};
  const double halves[2] = {p, q};
  for (int i = 0; i < 2; ++i) {
    const double radius = norm(chords[i]) * std::sqrt(1.0 + halves[i] * halves[i]) / (2.0 * halves[i]);
    if (radius < smallest)
      reporter_.warn(codes::curve_radius_small, index,
                     fmt::format("an arc of radius {:g} is smaller than {:g}", radius, smallest));
  }
}

bool usable_curve(const Curve& curve, CurveReporter& reporter) {
  if (curve.size() < 2) return reporter.refuse(codes::curve_malformed, 0, "at least two samples are needed");
  for (std::size_t i = 0; i < curve.size(); ++i)
    if (!usable(curve[i].at) || !usable({curve[i].heading.rad(), 0.0}))
      return reporter.refuse(codes::outline_not_finite, i, "a number is not finite or beyond 1e60");
  return true;
}

double wrap(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

double heading_of(Point2 from, Point2 to) { return std::atan2(to.y - from.y, to.x - from.x); }

}  // namespace

std::optional<Outline> smooth_curve(const Curve& curve, const CurveOptions& options,
                                    Diagnostics& diagnostics) {
  CurveReporter reporter(options, diagnostics);
  if (!usable_curve(curve, reporter)) return std::nullopt;
  CurveSmoother smoother(options, diagnostics);
  smoother.outline.start = curve.front().at;
  smoother.outline.segments.reserve(2 * curve.size());
  const auto direction = [](Angle a) { return Point2{std::cos(a.rad()), std::sin(a.rad())}; };
  Point2 heading = direction(curve.front().heading);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const Point2 next = direction(curve[i].heading);
    if (!smoother.add(i - 1, make_piece(curve[i - 1].at, heading, curve[i].at, next), curve[i].at))
      return std::nullopt;
    heading = next;
  }
  return std::move(smoother.outline);
}

std::optional<Curve> guess_headings(const std::vector<Point2>& points, const CurveOptions& options,
                                    Diagnostics& diagnostics) {
  CurveReporter reporter(options, diagnostics);
  Curve curve;
  for (const Point2 p : points) curve.push_back({p, {}});
  if (!usable_curve(curve, reporter)) return std::nullopt;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i + 1 < n; ++i)
    if (points[i] == points[i + 1] || (i + 2 < n && points[i] == points[i + 2] && n != 3))
      return reporter.refuse(codes::curve_malformed, i, "two equal samples have no direction"), std::nullopt;
  for (std::size_t i = 1; i + 1 < n; ++i)
    curve[i].heading = radians(heading_of(points[i - 1], points[i + 1]));
  if (n == 2) {
    curve[0].heading = curve[1].heading = radians(heading_of(points[0], points[1]));
    return curve;
  }
  if (points.front() == points.back()) {
    if (n == 3)
      return reporter.refuse(codes::curve_malformed, 1, "the curve turns back on itself"), std::nullopt;
    curve[0].heading = curve[n - 1].heading = radians(heading_of(points[n - 2], points[1]));
    return curve;
  }
  // An open end: half of what the chord to the neighbour and the one to the next but one differ by.
  const auto end_heading = [&](double near, double far) { return near - 0.5 * wrap(far - near); };
  const double start = heading_of(points[0], points[1]), start_far = heading_of(points[0], points[2]);
  const double end = heading_of(points[n - 2], points[n - 1]),
               end_far = heading_of(points[n - 3], points[n - 1]);
  if (std::abs(wrap(start_far - start)) > kMuch || std::abs(wrap(end_far - end)) > kMuch)
    return reporter.refuse(codes::curve_turns_fast, 0, "an open end turns by more than 60 degrees"),
           std::nullopt;
  curve[0].heading = radians(end_heading(start, start_far));
  curve[n - 1].heading = radians(end_heading(end, end_far));
  return curve;
}

}  // namespace kerf

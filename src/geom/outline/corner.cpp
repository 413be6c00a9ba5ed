// Corners of lines and arcs, smoothed and enlarged.
#include "corner.h"

#include <cmath>
#include <numbers>

namespace kerf::outline_detail {
namespace {

/// A request that fits exactly may miss by rounding: this fraction of a segment's length is permitted.
constexpr double kFit = 1e-9;
/// Where two loci touch, rounding decides whether they meet. A squared distance within this fraction
/// of the squared radius counts as touching; the relative error of the radius is then at most half of it.
constexpr double kTouch = 1e-12;
constexpr double kCusp = 1e-9;  // sine; below it rounding decides to which side a line and an arc fold back
constexpr int kHalvings =
    22;  // of an interval of radii: a largest radius is found within 1e-6 of the request

/// Whether a point of the arc's circle lies on the arc itself.
bool on_arc(const Side& side, Point2 point) {
  const Point2 start = -side.centre, at = point - side.centre, end = side.end - side.centre;
  const bool after_start = side.turn * cross(start, at) >= 0.0,
             before_end = side.turn * cross(at, end) >= 0.0;
  const bool below_half = side.turn * cross(start, end) >= 0.0;
  return below_half ? after_start && before_end : after_start || before_end;
}

/// Moves `point`, which lies on the side's carrier, to the side's end where it is within the tolerance of it.
/// False where it lies outside of the side.
bool snap_to(const Side& side, Point2& point, double weld) {
  const double slack = weld + kFit * (side.is_arc() ? side.radius : side.length);
  if (!side.is_arc()) {
    const double along = dot(point, side.away);
    if (along < -weld || along > side.length + slack) return false;
    if (along > side.length - weld) point = side.end;
    return true;
  }
  const Point2 off_end = point - side.end;
  const double to_end = dot(off_end, off_end);
  const bool inside = on_arc(side, point);
  if (!inside && to_end > slack * slack && dot(point, point) > slack * slack) return false;
  if (to_end <= (inside ? weld * weld : slack * slack)) point = side.end;
  return true;
}

/// Radius of the circle about an arc's centre on which the bit's centre must lie.
double locus_radius(const Side& arc, double r) { return arc.radius - arc.turn * arc.side * r; }

/// Where a circle about `centre` touches the side's carrier.
Point2 foot(const Side& side, Point2 centre, double r) {
  if (!side.is_arc()) return dot(centre, side.away) * side.away;
  return side.centre + (side.radius / locus_radius(side, r)) * (centre - side.centre);
}

/// Centres of the circles of radius r that touch both carriers on the inside; the nearer to the corner first.
struct Centres {
  Point2 at[2];
  int count = 0;
};

Centres centres_of_lines(const Side& in, const Side& out, double r) {
  const Point2 bisector = in.away + out.away;
  // The bisector has the length 2 cos(a/2), and the centre is r / sin(a/2) away.
  const double sine = std::abs(cross(in.away, out.away));
  return {{(r / sine) * bisector, {}}, 1};
}

Centres centres_of_line_and_arc(const Side& line, const Side& arc, double r) {
  if (!(locus_radius(arc, r) > kFit * arc.radius)) return {};
  // The centre is r beside the line and k along it; k solves k^2 - 2 a k + n = 0.
  const double a = dot(arc.centre, line.away);
  const double n =
      2.0 * r * (arc.turn * arc.side * arc.radius - line.side * dot(arc.centre, left_of(line.away)));
  double square = a * a - n;
  if (std::abs(square) <= kTouch * arc.radius * arc.radius) square = 0.0;
  if (square < 0.0) return {};
  const double far = a >= 0.0 ? a + std::sqrt(square) : a - std::sqrt(square);
  if (far == 0.0) return {};
  const Point2 beside = (line.side * r) * left_of(line.away);
  return {{beside + (n / far) * line.away, beside + far * line.away}, square > 0.0 ? 2 : 1};
}

Centres centres_of_arcs(const Side& in, const Side& out, double r) {
  const double r1 = locus_radius(in, r), r2 = locus_radius(out, r);
  if (!(r1 > kFit * in.radius && r2 > kFit * out.radius)) return {};
  const Point2 between = out.centre - in.centre;
  const double distance = norm(between);
  if (!(distance > kFit * std::max(in.radius, out.radius))) return {};
  const Point2 axis = (1.0 / distance) * between;
  const double x = 0.5 * (distance + (r1 - r2) * (r1 + r2) / distance);
  double square = (r1 - x) * (r1 + x);
  const double touch = kTouch * std::max(in.radius, out.radius) * std::max(in.radius, out.radius);
  if (std::abs(square) <= touch) square = 0.0;
  if (square < 0.0) return {};
  // Of the two, the one on the corner's side of the axis is the nearer.
  const double h = cross(in.centre, axis) >= 0.0 ? std::sqrt(square) : -std::sqrt(square);
  const Point2 on_axis = in.centre + x * axis;
  return {{on_axis + h * left_of(axis), on_axis - h * left_of(axis)}, square > 0.0 ? 2 : 1};
}

Centres centres_of(const Side& in, const Side& out, double r) {
  if (!in.is_arc() && !out.is_arc()) return centres_of_lines(in, out, r);
  if (!in.is_arc()) return centres_of_line_and_arc(in, out, r);
  if (!out.is_arc()) return centres_of_line_and_arc(out, in, r);
  return centres_of_arcs(in, out, r);
}

Replacement sharp(SharpReason reason) {
  Replacement none;
  none.reason = reason;
  return none;
}

/// The midpoint of a smoothing arc. That of a short one is computed from its chord, so that its radius stays
/// accurate where the corner is nearly straight.
Point2 smooth_midpoint(Point2 first, Point2 last, Point2 centre, double r, double side) {
  const Point2 half = 0.5 * (last - first);
  const double square = dot(half, half);
  const bool goes_far = side * cross(first - centre, last - centre) <= 0.0 || 2.0 * square >= r * r;
  if (goes_far) return arc_midpoint(first, last, centre, r, side);
  const double depth = std::sqrt(r * r - square);  // of the centre behind the chord
  return first + half - (side * std::sqrt(square) / (r + depth)) * left_of(half);
}

Replacement smooth(const Side& in, const Side& out, double r, double weld) {
  const Centres centres = centres_of(in, out, r);
  for (int i = 0; i < centres.count; ++i) {
    const Point2 centre = centres.at[i];
    Point2 first = foot(in, centre, r), last = foot(out, centre, r);
    if (!snap_to(in, first, weld) || !snap_to(out, last, weld)) continue;
    Replacement made;
    made.first = first;
    made.count = 1;
    made.pieces[0] = {last, smooth_midpoint(first, last, centre, r, out.side)};
    return made;
  }
  return sharp(centres.count > 0 ? SharpReason::short_segment : SharpReason::no_circle);
}

/// Where an enlarged corner leaves one of its sides.
struct Mouth {
  SharpReason reason = SharpReason::none;
  bool channel = false;  // the bit runs along a wall from `on_side` to `on_arc`; else the two are one
  Point2 on_side, on_arc;
};

/// `hole` is the bit's centre, `deep` the unit vector to it from the corner, `smooth_centre` where the bit
/// would smooth the corner. `force` decides about the channel: +1 channel, -1 none, 0 geometry decides.
Mouth mouth_of(const Side& side, Point2 hole, Point2 deep, Point2 smooth_centre, double r, int force,
               double weld) {
  const Point2 wall =
      hole - (side.side * r) * left_of(deep);  // where the channel's wall meets the bit's circle
  double along = 0.0;  // from there to the side, along the wall; below 0 the side cuts into the circle
  if (!side.is_arc()) {
    const double across = cross(deep, side.away);
    if (across == 0.0) return {SharpReason::no_circle, false, {}, {}};
    along = dot((-r * side.side / across) * side.away - wall, deep);
  } else {
    const Point2 to_centre = side.centre - wall;
    const double foot_along = dot(to_centre, deep), aside = cross(deep, to_centre);
    const double square = (side.radius - aside) * (side.radius + aside);
    if (square < 0.0) return {SharpReason::no_circle, false, {}, {}};
    const double half = 0.5 * dot(smooth_centre - wall, deep);
    along = half < foot_along ? foot_along - std::sqrt(square) : foot_along + std::sqrt(square);
  }
  Mouth mouth;
  mouth.channel = force != 0 ? force > 0 : along > weld;
  if (mouth.channel) {
    mouth.on_side = wall + along * deep;
    mouth.on_arc = wall;
  } else if (!side.is_arc()) {
    mouth.on_side = (2.0 * dot(hole, side.away)) * side.away;
  } else {
    // Both circles pass through the corner: they meet again in its mirror image across the line of centres.
    const Point2 between = side.centre - hole;
    const Point2 across = left_of(between);
    mouth.on_side = (2.0 * dot(hole, across) / dot(across, across)) * across;
  }
  if (!mouth.channel) mouth.on_arc = mouth.on_side;
  if (!snap_to(side, mouth.on_side, weld)) mouth.reason = SharpReason::short_segment;
  if (!mouth.channel) mouth.on_arc = mouth.on_side;
  return mouth;
}

Replacement enlarge(const Side& in, const Side& out, double r, const CornerLimits& limits) {
  const Centres centres = centres_of(in, out, r);
  if (centres.count == 0) return sharp(SharpReason::no_circle);
  const Point2 smooth_centre = centres.at[0];
  const double distance = norm(smooth_centre);
  if (!(distance > limits.weld)) return sharp(SharpReason::no_circle);
  const Point2 first = foot(in, smooth_centre, r), last = foot(out, smooth_centre, r);
  const double turned = out.side * cross(first - smooth_centre, last - smooth_centre);
  if (turned < 0.0) return sharp(SharpReason::no_circle);  // more than half a turn
  const Point2 deep = (1.0 / distance) * smooth_centre;
  const Point2 hole = r * deep;
  int force =
      0;  // two lines are alike on both sides, and a right angle within the tolerance needs no channel
  if (!in.is_arc() && !out.is_arc()) force = dot(in.away, out.away) < limits.straight ? -1 : 1;
  const Mouth a = mouth_of(in, hole, deep, smooth_centre, r, force, limits.weld);
  const Mouth b = mouth_of(out, hole, deep, smooth_centre, r, force, limits.weld);
  if (a.reason != SharpReason::none) return sharp(a.reason);
  if (b.reason != SharpReason::none) return sharp(b.reason);
  if (norm(a.on_side - b.on_side) <= limits.weld) return sharp(SharpReason::straight);
  Replacement made;
  made.first = a.on_side;
  if (a.channel) made.pieces[made.count++] = {a.on_arc};
  made.pieces[made.count++] = {b.on_arc, Point2{}};  // through the corner
  if (b.channel) made.pieces[made.count++] = {b.on_side};
  return made;
}

bool has_length(const Side& side, double weld) {
  return side.is_arc() ? dot(side.end, side.end) > weld * weld : side.length > weld;
}

}  // namespace

Replacement solve_corner(Side& in, Side& out, double request, const CornerLimits& limits) {
  const double r = std::abs(request);
  if (dot(in.away, in.away) == 0.0 || dot(out.away, out.away) == 0.0) return sharp(SharpReason::no_neighbour);
  if (r <= limits.weld) return sharp(SharpReason::tiny);
  const double sine = -cross(in.away, out.away);  // of the turn at the corner, and its cosine
  const double cosine = -dot(in.away, out.away);
  // A line and an arc that turn back differ by the arc's curvature; only at an exact cusp is neither side the
  // inside.
  const bool curves_away = in.is_arc() != out.is_arc() && cosine < 0.0;
  if (std::abs(sine) < (curves_away ? kCusp : limits.straight))
    return sharp(cosine > 0.0 ? SharpReason::straight : SharpReason::folded);
  out.side = sine > 0.0 ? 1.0 : -1.0;
  in.side = -out.side;
  if (!has_length(in, limits.weld) || !has_length(out, limits.weld)) return sharp(SharpReason::short_segment);
  return request > 0.0 ? smooth(in, out, r, limits.weld) : enlarge(in, out, r, limits);
}

double largest_radius(Side in, Side out, double request, const CornerLimits& limits, const Room& room) {
  const auto fits = [&](double radius) {
    const Replacement tried = solve_corner(in, out, std::copysign(radius, request), limits);
    return tried.reason == SharpReason::none && taken(in, tried.first) <= room.in &&
           taken(out, tried.pieces[tried.count - 1].to) <= room.out;
  };
  double good = 0.0, bad = std::abs(request);
  for (int i = 0; i < kHalvings; ++i) {
    const double between = 0.5 * (good + bad);
    (fits(between) ? good : bad) = between;
  }
  if (!(good > 0.0)) return 0.0;
  // The bounds of outlines are often round numbers, and the search ends just below them.
  const double step = std::pow(10.0, std::floor(std::log10(bad - good)));
  for (const double coarse : {10.0 * step, step}) {
    const double round = std::ceil(good / coarse) * coarse;
    if (round <= bad && fits(round)) return round;
  }
  return good;
}

double taken(const Side& side, Point2 point) {
  if (!side.is_arc()) return dot(point, side.away);
  const Point2 a = -side.centre, b = point - side.centre;
  double angle = side.turn * std::atan2(cross(a, b), dot(a, b));
  if (angle < 0.0) angle += 2.0 * std::numbers::pi;
  return angle * side.radius;
}

}  // namespace kerf::outline_detail

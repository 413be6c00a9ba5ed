// Crossings of lines and arcs. Ends that touch the other edge are told first, with the tolerance; what
// crosses then crosses well away from them, where signs are safe.
#include "crossing.h"

#include <cmath>

#include "exact.h"

namespace kerf::region_detail {
namespace {

double square(double x) { return x * x; }

/// Twice the radius times the distance of a point (relative to the arc's begin) from the arc's circle, above
/// 0 outside; exact enough near the circle however large it is.
double off_circle(const Edge& arc, Point2 q) { return dot(q, q) - 2.0 * dot(q, arc.centre); }

/// Whether a point of the edge's line or circle lies on the edge itself.
bool within(const Edge& e, Point2 p) {
  const Point2 v = e.chord(), q = p - e.a;
  const double t = dot(q, v);
  if (t < 0.0 || t > dot(v, v)) return false;
  if (!e.is_arc()) return true;
  // On the chord's other side is the rest of the circle.
  return e.turn * cross(v, q) <= 0.5 * std::abs(cross(v, e.centre));
}

/// Points of an arc's circle on a line, which has the direction `v` and the foot of the perpendicular from
/// the arc's begin at `foot` (relative to that begin).
struct CirclePoints {
  int count = 0;
  Point2 at[2];
};
CirclePoints circle_and_line(const Edge& arc, Point2 foot, Point2 v) {
  const double vv = dot(v, v), b = dot(v, arc.centre), c = off_circle(arc, foot);
  const double d = b * b - vv * c;
  CirclePoints found;
  if (!(d >= 0.0) || vv == 0.0) return found;
  const double larger = b + std::copysign(std::sqrt(d), b);
  const double t[2] = {larger / vv, larger != 0.0 ? c / larger : 0.0};
  for (const double at : t) found.at[found.count++] = arc.a + foot + at * v;
  return found;
}

CirclePoints lines_meet(const Edge& e, const Edge& f) {
  CirclePoints found;
  const double a = orientation(e.a, e.b, f.a), b = orientation(e.a, e.b, f.b);
  if (!((a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0))) return found;
  const double c = orientation(f.a, f.b, e.a), d = orientation(f.a, f.b, e.b);
  if (!((c > 0.0 && d < 0.0) || (c < 0.0 && d > 0.0))) return found;
  found.at[0] = f.a + (a / (a - b)) * f.chord();
  found.count = 1;
  return found;
}

CirclePoints arc_meets_line(const Edge& arc, const Edge& line) {
  const Point2 v = line.chord(), n = left_of(v);
  const Point2 foot = (cross(v, line.a - arc.a) / dot(v, v)) * n;
  return circle_and_line(arc, foot, v);
}

/// Two circles meet on a line; the smaller circle places the points better.
CirclePoints arcs_meet(const Edge& e, const Edge& f) {
  if (e.radius > f.radius) return arcs_meet(f, e);
  const Point2 between = f.a - e.a;
  const Point2 m = e.centre - between - f.centre;  // from the second centre to the first
  const double mm = dot(m, m);
  if (mm == 0.0) return {};
  const double k = -0.5 * (dot(between, between) + 2.0 * dot(between, f.centre));
  return circle_and_line(e, (k / mm) * m, left_of(m));
}

CirclePoints carriers_meet(const Edge& e, const Edge& f) {
  if (e.is_arc()) return f.is_arc() ? arcs_meet(e, f) : arc_meets_line(e, f);
  return f.is_arc() ? arc_meets_line(f, e) : lines_meet(e, f);
}

}  // namespace

bool touches(const Edge& e, Point2 p, double weld) {
  const Point2 v = e.chord(), q = p - e.a;
  const double t = dot(q, v), vv = dot(v, v), ww = weld * weld;
  if (t <= 0.0 || t >= vv) return dot(q, q) <= ww || dot(p - e.b, p - e.b) <= ww;
  if (!e.is_arc()) return square(cross(v, q)) <= ww * vv;
  return std::abs(off_circle(e, q)) <= 2.0 * e.radius * weld &&
         e.turn * cross(v, q) <= 0.5 * std::abs(cross(v, e.centre));
}

Meeting meet(const Edge& e, const Edge& f, double weld) {
  Meeting m;
  const bool from_from = e.from == f.from, from_to = e.from == f.to;
  const bool to_from = e.to == f.from, to_to = e.to == f.to;
  m.first_has_from = !from_from && !to_from && touches(e, f.a, weld);
  m.first_has_to = !from_to && !to_to && touches(e, f.b, weld);
  m.second_has_from = !from_from && !from_to && touches(f, e.a, weld);
  m.second_has_to = !to_from && !to_to && touches(f, e.b, weld);
  const bool neighbours = from_from || from_to || to_from || to_to;
  if (neighbours && !e.is_arc() && !f.is_arc()) return m;  // lines meet once
  const CirclePoints found = carriers_meet(e, f);
  const double ww = weld * weld;
  const auto at_end = [&](Point2 p) {
    const auto near = [&](bool asked, Point2 end) { return asked && dot(p - end, p - end) <= ww; };
    return near(m.second_has_from || from_from || from_to, e.a) ||
           near(m.second_has_to || to_from || to_to, e.b) || near(m.first_has_from, f.a) ||
           near(m.first_has_to, f.b);
  };
  for (int i = 0; i < found.count; ++i)
    if (within(e, found.at[i]) && within(f, found.at[i]) && !at_end(found.at[i]))
      m.at[m.crossings++] = found.at[i];
  return m;
}

}  // namespace kerf::region_detail

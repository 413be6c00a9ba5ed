// Contacts of lines and arcs. Ends that touch the other edge are found first, with the tolerance; remaining
// intersections are away from ends, where signs are certain.
#include "crossing.h"

#include <cmath>

#include "geom/base/exact.h"

namespace kerf::region_detail {
namespace {

double square(double x) { return x * x; }

/// Twice the radius times the distance of a point (relative to the arc's start) from the arc's circle, above
/// 0 outside; accurate near the circle for any radius.
double off_circle(const Edge& arc, Point2 q) { return dot(q, q) - 2.0 * dot(q, arc.centre); }

/// Whether a point of the edge's line or circle lies on the edge itself.
bool within(const Edge& e, Point2 p) {
  const Point2 v = e.chord(), q = p - e.from;
  const double t = dot(q, v);
  if (t < 0.0 || t > dot(v, v)) return false;
  if (!e.is_arc()) return true;
  // The rest of the circle is on the other side of the chord.
  return e.turn * cross(v, q) <= 0.5 * std::abs(cross(v, e.centre));
}

Crossings lines_meet(const Edge& e, const Edge& f) {
  Crossings found;
  const double a = orientation(e.from, e.to, f.from), b = orientation(e.from, e.to, f.to);
  if (!((a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0))) return found;
  const double c = orientation(f.from, f.to, e.from), d = orientation(f.from, f.to, e.to);
  if (!((c > 0.0 && d < 0.0) || (c < 0.0 && d > 0.0))) return found;
  found.at[0] = f.from + (a / (a - b)) * f.chord();
  found.count = 1;
  return found;
}

Crossings carriers_meet(const Edge& e, const Edge& f) {
  if (e.is_arc()) return f.is_arc() ? detail::arc_and_arc(e, f, 0.0) : detail::arc_and_line(e, f, 0.0);
  return f.is_arc() ? detail::arc_and_line(f, e, 0.0) : lines_meet(e, f);
}

}  // namespace

double touches(const Edge& e, Point2 p, double weld) {
  const Point2 v = e.chord(), q = p - e.from;
  const double t = dot(q, v), vv = dot(v, v), ww = weld * weld;
  if (t <= 0.0 || t >= vv) {
    const double near = std::min(dot(q, q), dot(p - e.to, p - e.to));
    return near <= ww ? std::sqrt(near) : -1.0;
  }
  if (!e.is_arc()) {
    const double aside = square(cross(v, q));
    return aside <= ww * vv ? std::sqrt(aside / vv) : -1.0;
  }
  const double aside = std::abs(off_circle(e, q));
  return aside <= 2.0 * e.radius * weld && e.turn * cross(v, q) <= 0.5 * std::abs(cross(v, e.centre))
             ? 0.5 * aside / e.radius
             : -1.0;
}

Contacts contacts_of(const Edge& e, const Edge& f, double weld) {
  Contacts m;
  const bool from_from = e.from_point == f.from_point, from_to = e.from_point == f.to_point;
  const bool to_from = e.to_point == f.from_point, to_to = e.to_point == f.to_point;
  const auto has = [&](const Edge& edge, Point2 end) {
    const double off = touches(edge, end, weld);
    if (off < 0.0) return false;
    m.off = std::max(m.off, off);
    return true;
  };
  m.first_has_from = !from_from && !to_from && has(e, f.from);
  m.first_has_to = !from_to && !to_to && has(e, f.to);
  m.second_has_from = !from_from && !from_to && has(f, e.from);
  m.second_has_to = !to_from && !to_to && has(f, e.to);
  const bool neighbours = from_from || from_to || to_from || to_to;
  if (neighbours && !e.is_arc() && !f.is_arc()) return m;  // lines meet once
  const Crossings found = carriers_meet(e, f);
  const double ww = weld * weld;
  const auto at_end = [&](Point2 p) {
    const auto near = [&](bool wanted, Point2 end) { return wanted && dot(p - end, p - end) <= ww; };
    return near(m.second_has_from || from_from || from_to, e.from) ||
           near(m.second_has_to || to_from || to_to, e.to) || near(m.first_has_from, f.from) ||
           near(m.first_has_to, f.to);
  };
  for (int i = 0; i < found.count; ++i)
    if (within(e, found.at[i]) && within(f, found.at[i]) && !at_end(found.at[i]))
      m.at[m.crossings++] = found.at[i];
  return m;
}

}  // namespace kerf::region_detail

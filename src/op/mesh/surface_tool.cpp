// Convex profiles, and their contact with lines.
#include "op/mesh/surface_tool.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tool/arc.h"

namespace kerf::op_detail {
namespace {

constexpr double kSame = 1e-6;  // mm: rounding of the dimensions of a silhouette
constexpr double kRounding = 1.0 + 1e-12;
constexpr int kMaxSecants = 50;  // of the contact with a torus
constexpr double kExact = 1e-6;  // mm along a line, of that contact: the error of the height is its square

/// The slope of the tool's height along a line at distance `e` from the axis, `t` from the point nearest to
/// it, on the circle of its profile.
double slope_on_circle(const SurfaceTool& tool, double e, double t) {
  const double r = std::sqrt(e * e + t * t), inward = r - tool.flat;
  const double below = tool.corner * tool.corner - inward * inward;
  if (!(below > 0.0)) return INFINITY;
  return r > 0.0 ? inward / std::sqrt(below) * t / r : 0.0;
}

/// Where that slope is `m`, between `low` and `high`.
double find_on_circle(const SurfaceTool& tool, double e, double m, double low, double high) {
  if (tool.flat == 0.0) {
    const double rho = std::sqrt(std::max(tool.corner * tool.corner - e * e, 0.0));
    return std::clamp(m * rho / std::sqrt(1.0 + m * m), low, high);
  }
  // Below 0 where the slope is less than `m`, without its infinite values.
  const auto excess = [&](double t) {
    const double r = std::sqrt(e * e + t * t), inward = r - tool.flat;
    return inward * t - m * r * std::sqrt(std::max(tool.corner * tool.corner - inward * inward, 0.0));
  };
  // Secants; the value of an end that stays is halved, so that both ends move.
  double below = excess(low), above = excess(high), last = low;
  if (below >= 0.0) return low;
  if (above <= 0.0) return high;
  for (int i = 0; i < kMaxSecants; ++i) {
    const double t = (low * above - high * below) / (above - below), value = excess(t);
    if (std::abs(t - last) < kExact) return t;
    last = t;
    if (value < 0.0)
      low = t, below = value, above *= 0.5;
    else
      high = t, above = value, below *= 0.5;
  }
  return last;
}

double half_chord(double radius, double e) { return std::sqrt(std::max(radius * radius - e * e, 0.0)); }

/// The distance from the foot of the axis at which a line that rises by `m` >= 0 touches the tool.
double find_contact(const SurfaceTool& tool, double e, double m) {
  const double flat = half_chord(tool.flat, e), edge = half_chord(tool.edge, e);
  const double radius = half_chord(tool.radius, e);
  if (e < tool.edge && tool.corner > 0.0) {
    if (m <= slope_on_circle(tool, e, flat)) return flat;
    const double steepest = std::isinf(tool.edge_slope) ? INFINITY : tool.edge_slope * edge / tool.edge;
    if (m < steepest) return find_on_circle(tool, e, m, flat, edge);
  } else if (e < tool.flat && tool.cone == 0.0) {
    return flat;
  }
  if (tool.cone == 0.0) return edge;
  if (edge > 0.0 && m <= tool.cone * edge / tool.edge) return edge;
  if (m * radius >= tool.cone * radius * radius / tool.radius) return radius;
  return std::clamp(m * e / std::sqrt(tool.cone * tool.cone - m * m), edge, radius);
}

}  // namespace

double SurfaceTool::contact(double slope) const {
  if (slope <= 0.0) return 0.0;
  if (slope < edge_slope) return flat + corner * slope / std::sqrt(1.0 + slope * slope);
  return cone > 0.0 && slope > cone ? radius : edge;
}

std::optional<SurfaceTool> surface_tool(const Tool& tool) {
  const Profile& profile = tool.silhouette.cutting;
  if (profile.empty()) return std::nullopt;
  SurfaceTool made;
  made.radius = profile.max_radius();
  if (!(made.radius > 0.0)) return std::nullopt;
  enum class Part { flat, circle, cone } part = Part::flat;
  double r = 0.0;
  for (std::size_t i = 0; i + 1 < profile.knots.size() && r < made.radius - kSame; ++i) {
    const Knot &a = profile.knots[i], &b = profile.knots[i + 1];
    if (i == 0 && a.r > 0.0) made.flat = made.edge = a.r;
    r = b.r;
    const double rise = b.z - a.z;
    if (a.bulge == 0.0 && rise == 0.0 && b.r >= a.r) {
      if (part != Part::flat) return std::nullopt;
      made.flat = made.edge = b.r;
    } else if (a.bulge > 0.0 && part == Part::flat) {
      const detail::ProfileArc arc = detail::profile_arc(a, b);
      const double bottom = arc.z - arc.radius - profile.bottom();
      if (std::abs(arc.r - made.flat) > kSame || std::abs(bottom) > kSame || b.r < a.r) return std::nullopt;
      part = Part::circle;
      made.corner = arc.radius, made.edge = b.r, made.edge_z = b.z - profile.bottom();
      const double inward = b.r - arc.r, below = arc.radius * arc.radius - inward * inward;
      made.edge_slope = below > kSame * kSame ? inward / std::sqrt(below) : INFINITY;
    } else if (a.bulge == 0.0 && part != Part::cone && b.r > a.r + kSame) {
      part = Part::cone;
      made.cone = rise / (b.r - a.r);
      if (made.cone < made.edge_slope - kSame) return std::nullopt;
    } else {
      return std::nullopt;
    }
  }
  if (part == Part::flat) made.edge_slope = 0.0;
  if (made.cone == 0.0) made.radius = made.edge;
  return made;
}

SurfaceTool grown(const SurfaceTool& tool, double by) {
  if (!(by > 0.0)) return tool;
  SurfaceTool made = tool;
  made.corner += by, made.radius += by;
  // The circle ends where the cone starts, or reaches the cylinder.
  const double length = std::sqrt(1.0 + tool.cone * tool.cone);
  const double sine = tool.cone > 0.0 ? tool.cone / length : 1.0,
               cosine = tool.cone > 0.0 ? 1.0 / length : 0.0;
  made.edge = tool.cone > 0.0 ? tool.flat + made.corner * sine : made.radius;
  made.edge_z = made.corner * (1.0 - cosine);
  made.edge_slope = tool.cone > 0.0 ? tool.cone : INFINITY;
  return made;
}

double touch_line(const SurfaceTool& tool, Point3 a, Point3 b) {
  if (a.z > b.z) std::swap(a, b);
  const Point2 along = b.xy() - a.xy();
  const double whole = std::sqrt(dot(along, along));
  if (!(whole > 0.0)) {
    const double r = std::sqrt(dot(b.xy(), b.xy()));
    return r <= tool.radius ? b.z - tool.height(r) : -INFINITY;
  }
  const Point2 unit = (1.0 / whole) * along;
  const double e = std::abs(cross(unit, a.xy())), start = dot(unit, a.xy());
  if (e > tool.radius) return -INFINITY;
  const double slope = (b.z - a.z) / whole;
  // The height above the line decreases towards the contact from both sides, so that an end of the line is
  // the contact where it does not reach so far.
  const double t = std::clamp(find_contact(tool, e, slope), start, start + whole);
  const double r = std::sqrt(e * e + t * t);
  if (r > tool.radius * kRounding) return -INFINITY;
  return a.z + slope * (t - start) - tool.height(std::min(r, tool.radius));
}

}  // namespace kerf::op_detail

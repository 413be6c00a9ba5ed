// Reading a half profile: its radius at a height and its largest radius.
#include <algorithm>
#include <cmath>

#include "tool/arc.h"

#include "kerf/tool/tool.h"

namespace kerf {
namespace {

/// Radius of one segment at height z, which lies within the segment's heights.
double segment_radius(const Knot& a, const Knot& b, double z) {
  if (a.z == b.z) return std::max(a.r, b.r);
  if (z == a.z) return a.r;
  if (z == b.z) return b.r;
  if (a.bulge == 0.0) return a.r + (b.r - a.r) * ((z - a.z) / (b.z - a.z));
  // As z never decreases, a counter-clockwise arc lies right of its centre and a clockwise one left of it.
  const detail::ProfileArc arc = detail::profile_arc(a, b);
  const double height = z - arc.z;
  const double half_chord = std::sqrt(std::max(0.0, (arc.radius - height) * (arc.radius + height)));
  return arc.r + (a.bulge > 0.0 ? half_chord : -half_chord);
}

double segment_max_radius(const Knot& a, const Knot& b) {
  const double ends = std::max(a.r, b.r);
  if (a.bulge <= 0.0) return ends;
  const detail::ProfileArc arc = detail::profile_arc(a, b);
  const bool swells = arc.z > a.z && arc.z < b.z;
  return swells ? std::max(ends, arc.r + arc.radius) : ends;
}

}  // namespace

double Profile::max_radius() const {
  if (empty()) return 0.0;
  double radius = 0.0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    radius = std::max(radius, segment_max_radius(knots[i], knots[i + 1]));
  }
  return radius;
}

double Profile::radius_at(double z) const {
  double radius = 0.0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const Knot& a = knots[i];
    const Knot& b = knots[i + 1];
    if (z >= a.z && z <= b.z) radius = std::max(radius, segment_radius(a, b, z));
  }
  return radius;
}

std::string_view to_string(ToolPart part) {
  switch (part) {
    case ToolPart::neck: return "neck";
    case ToolPart::shank: return "shank";
    case ToolPart::holder: return "holder";
    case ToolPart::cutting: break;
  }
  return "cutting part";
}

const Profile& Silhouette::part(ToolPart p) const {
  switch (p) {
    case ToolPart::neck: return neck;
    case ToolPart::shank: return shank;
    case ToolPart::holder: return holder;
    case ToolPart::cutting: break;
  }
  return cutting;
}

double Silhouette::max_radius() const {
  return std::max({cutting.max_radius(), neck.max_radius(), shank.max_radius(), holder.max_radius()});
}

double Silhouette::top() const { return std::max({cutting.top(), neck.top(), shank.top(), holder.top()}); }

}  // namespace kerf

// Distance to a half outline: the minimum over its segments; the sign from the radius of the outline at the
// point's height.
#include "sim/exact/tool_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/sweep/solid.h"
#include "tool/arc.h"

#include "kerf/geom/geometry.h"

namespace kerf::sim {
namespace {

/// Within this distance, mm, the gradient is the normal of the outline: the difference of the two points is
/// only rounding.
constexpr double kOnOutline = 1e-9;
/// Right turns between segments below this angle, radians, are rounding of their end points.
constexpr double kCollinear = 1e-9;

}  // namespace

struct ToolDistance::NearestOnProfile {
  double distance2 = std::numeric_limits<double>::infinity();
  double r = 0.0, z = 0.0;                // the nearest point
  double normal_r = 0.0, normal_z = 0.0;  // outward normal of the outline there, if it is on an arc
  const ProfileSegment* line = nullptr;   // its segment, if it is on a line
  bool is_end = false;                    // it is an end point of its segment
  double curvature = 0.0;                 // of the distance, unless is_end

  /// Replaces the point by (to_r, to_z) if that is closer; true if so.
  bool update(double from_r, double from_z, double to_r, double to_z) {
    const double dr = from_r - to_r, dz = from_z - to_z;
    const double square = dr * dr + dz * dz;
    if (square >= distance2) return false;
    distance2 = square;
    r = to_r;
    z = to_z;
    return true;
  }
};

ToolDistance::ToolDistance(const Silhouette& tool) {
  const Silhouette whole = held(tool);
  std::vector<Knot> knots;
  for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder}) {
    const Profile& profile = whole.part(part);
    if (profile.empty()) continue;
    // Adjoining parts are one outline: there is no surface between them.
    if (!knots.empty() && profile.bottom() > knots.back().z) {
      add_outline(knots);
      knots.clear();
    }
    if (!knots.empty()) knots.back().bulge = 0.0;
    knots.insert(knots.end(), profile.knots.begin(), profile.knots.end());
    rim_ = std::max(rim_, profile.max_radius());
  }
  add_outline(knots);
  bottom_ = segments_.empty() ? 0.0 : segments_.front().z0;
  is_convex_ = is_outline_convex();
}

double ToolDistance::per_square(const ProfileSegment& segment) {
  const double dr = segment.r1 - segment.r0, dz = segment.z1 - segment.z0;
  return 1.0 / (dr * dr + dz * dz);
}

/// Whether two consecutive segments form one vertical line, as flutes and a shank of the same diameter do.
bool ToolDistance::is_one_vertical(const ProfileSegment& before, const ProfileSegment& next) {
  return before.side == 0.0 && next.side == 0.0 && before.r1 == next.r0 && before.z1 == next.z0 &&
         before.r0 == before.r1 && next.r0 == next.r1;
}

/// Whether the outline is connected, without concave arcs and without right turns.
bool ToolDistance::is_outline_convex() const {
  const auto direction_at = [](const ProfileSegment& segment, double r, double z) {
    return segment.side == 0.0 ? Point2{segment.r1 - segment.r0, segment.z1 - segment.z0}
                               : Point2{segment.centre_z - z, r - segment.centre_r};
  };
  for (std::size_t k = 0; k < segments_.size(); ++k) {
    const ProfileSegment& segment = segments_[k];
    if (segment.side < 0.0) return false;
    if (k == 0) continue;
    const ProfileSegment& before = segments_[k - 1];
    if (before.r1 != segment.r0 || before.z1 != segment.z0) return false;
    const Point2 in = direction_at(before, before.r1, before.z1),
                 out = direction_at(segment, segment.r0, segment.z0);
    if (cross(in, out) < -kCollinear * length(in) * length(out)) return false;
  }
  return !segments_.empty();
}

void ToolDistance::add_outline(const std::vector<Knot>& knots) {
  if (knots.size() < 2) return;
  const auto add = [&](const Knot& a, const Knot& b) {
    if ((a.r == b.r && a.z == b.z) || a.z >= kAboveAll)
      return;  // the upper end of the holder is out of reach
    ProfileSegment segment = segment_between(a, b);
    if (!segments_.empty() && is_one_vertical(segments_.back(), segment)) {
      segment.r0 = segments_.back().r0;
      segment.z0 = segments_.back().z0;
      segment.per_length2 = per_square(segment);
      segments_.pop_back();
    }
    segments_.push_back(segment);
  };
  add({0.0, knots.front().z, 0.0}, knots.front());
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) add(knots[k], knots[k + 1]);
  add({knots.back().r, knots.back().z, 0.0}, {0.0, knots.back().z, 0.0});
}

ToolDistance::ProfileSegment ToolDistance::segment_between(const Knot& a, const Knot& b) {
  ProfileSegment segment{.r0 = a.r, .z0 = a.z, .r1 = b.r, .z1 = b.z};
  segment.per_length2 = per_square(segment);
  if (a.z != b.z) segment.r_per_z = (b.r - a.r) / (b.z - a.z);
  if (a.bulge == 0.0) return segment;
  const detail::ProfileArc arc = detail::profile_arc(a, b);
  segment.side = a.bulge > 0.0 ? 1.0 : -1.0;
  segment.centre_r = arc.r;
  segment.centre_z = arc.z;
  segment.radius = arc.radius;
  return segment;
}

double ToolDistance::radius_at(const ProfileSegment& segment, double z) {
  if (segment.side == 0.0) return segment.r0 + segment.r_per_z * (z - segment.z0);
  const double height = z - segment.centre_z;
  return segment.centre_r +
         segment.side * std::sqrt(std::max(0.0, segment.radius * segment.radius - height * height));
}

bool ToolDistance::is_inside(double rho, double z) const {
  for (const ProfileSegment& segment : segments_)
    if (segment.z0 <= z && z < segment.z1) return rho < radius_at(segment, z);
  return false;
}

void ToolDistance::add_line(const ProfileSegment& segment, double rho, double z, NearestOnProfile& nearest) {
  const double dr = segment.r1 - segment.r0, dz = segment.z1 - segment.z0;
  const double fraction =
      std::clamp(((rho - segment.r0) * dr + (z - segment.z0) * dz) * segment.per_length2, 0.0, 1.0);
  if (!nearest.update(rho, z, segment.r0 + fraction * dr, segment.z0 + fraction * dz)) return;
  nearest.line = &segment;
  nearest.is_end = fraction == 0.0 || fraction == 1.0;
  nearest.curvature = 0.0;
}

void ToolDistance::add_arc(const ProfileSegment& segment, double rho, double z, NearestOnProfile& nearest) {
  const double r = rho - segment.centre_r, h = z - segment.centre_z;
  const double start_r = segment.r0 - segment.centre_r, start_z = segment.z0 - segment.centre_z;
  const double end_r = segment.r1 - segment.centre_r, end_z = segment.z1 - segment.centre_z;
  const double length = std::sqrt(r * r + h * h);
  // z never decreases along a profile, so no arc is longer than a half circle.
  const bool between = segment.side * (start_r * h - start_z * r) >= 0.0 &&
                       segment.side * (r * end_z - h * end_r) >= 0.0 && length > 0.0;
  const auto set_normal = [&] {
    nearest.line = nullptr;
    nearest.is_end = !between;
    nearest.curvature = between ? segment.side / length : 0.0;
    nearest.normal_r = segment.side * (nearest.r - segment.centre_r) / segment.radius;
    nearest.normal_z = segment.side * (nearest.z - segment.centre_z) / segment.radius;
  };
  if (between) {
    const double scale = segment.radius / length;
    if (nearest.update(rho, z, segment.centre_r + scale * r, segment.centre_z + scale * h)) set_normal();
    return;
  }
  if (nearest.update(rho, z, segment.r0, segment.z0)) set_normal();
  if (nearest.update(rho, z, segment.r1, segment.z1)) set_normal();
}

ProfileDistance ToolDistance::at(double rho, double z) const {
  NearestOnProfile nearest;
  for (const ProfileSegment& segment : segments_)
    segment.side == 0.0 ? add_line(segment, rho, z, nearest) : add_arc(segment, rho, z, nearest);
  const double distance = std::sqrt(nearest.distance2);
  const double sign = is_inside(rho, z) ? -1.0 : 1.0;
  const double per_distance = sign / std::max(distance, kOnOutline);
  const double curvature = nearest.is_end ? per_distance : nearest.curvature;
  if (distance >= kOnOutline)
    return {sign * distance, per_distance * (rho - nearest.r), per_distance * (z - nearest.z), curvature};
  if (nearest.line == nullptr) return {sign * distance, nearest.normal_r, nearest.normal_z, curvature};
  const ProfileSegment& line = *nearest.line;
  const double per_length = std::sqrt(line.per_length2);
  return {sign * distance, per_length * (line.z1 - line.z0), per_length * (line.r0 - line.r1), curvature};
}

}  // namespace kerf::sim

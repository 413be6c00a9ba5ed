// The nearest place on the outline of half a tool, and on which side of it a place lies.
#include "sim/exact/tool_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/sweep/solid.h"
#include "tool/arc.h"

#include "kerf/geometry.h"

namespace kerf::sim {
namespace {

/// Nearer to the outline than this its own normal is the direction, mm: a difference of places has none left.
constexpr double kOnOutline = 1e-9;
/// Pieces that turn right by less than this, radians, go on in one direction: rounding of their ends.
constexpr double kSameWay = 1e-9;

}  // namespace

struct ToolDistance::Nearest {
  double distance2 = std::numeric_limits<double>::infinity();
  double r = 0.0, z = 0.0;                // the place
  double normal_r = 0.0, normal_z = 0.0;  // of the outline there, outwards; of an arc
  const ProfileSegment* line = nullptr;   // the segment, if it is a line
  bool is_end = false;                    // the place is an end of its segment
  double bend = 0.0;                      // of the distance, if it is none

  bool take(double from_r, double from_z, double to_r, double to_z) {
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
    // Parts that stand on each other are one outline: there is no surface between them.
    if (!knots.empty() && profile.bottom() > knots.back().z) {
      add_region(knots);
      knots.clear();
    }
    if (!knots.empty()) knots.back().bulge = 0.0;
    knots.insert(knots.end(), profile.knots.begin(), profile.knots.end());
    rim_ = std::max(rim_, profile.max_radius());
  }
  add_region(knots);
  bottom_ = segments_.empty() ? 0.0 : segments_.front().z0;
  is_convex_ = turns_left();
}

double ToolDistance::per_square(const ProfileSegment& segment) {
  const double dr = segment.r1 - segment.r0, dz = segment.z1 - segment.z0;
  return 1.0 / (dr * dr + dz * dz);
}

/// Whether two pieces, one after the other, are one upright line: flutes and shank of one width.
bool ToolDistance::goes_on(const ProfileSegment& before, const ProfileSegment& next) {
  return before.side == 0.0 && next.side == 0.0 && before.r1 == next.r0 && before.z1 == next.z0 &&
         before.r0 == before.r1 && next.r0 == next.r1;
}

/// Whether the outline is one and never turns right.
bool ToolDistance::turns_left() const {
  const auto way_at = [](const ProfileSegment& segment, double r, double z) {
    return segment.side == 0.0 ? Point2{segment.r1 - segment.r0, segment.z1 - segment.z0}
                               : Point2{segment.centre_z - z, r - segment.centre_r};
  };
  for (std::size_t k = 0; k < segments_.size(); ++k) {
    const ProfileSegment& segment = segments_[k];
    if (segment.side < 0.0) return false;
    if (k == 0) continue;
    const ProfileSegment& before = segments_[k - 1];
    if (before.r1 != segment.r0 || before.z1 != segment.z0) return false;
    const Point2 in = way_at(before, before.r1, before.z1), out = way_at(segment, segment.r0, segment.z0);
    if (cross(in, out) < -kSameWay * length(in) * length(out)) return false;
  }
  return !segments_.empty();
}

void ToolDistance::add_region(const std::vector<Knot>& knots) {
  if (knots.size() < 2) return;
  const auto add = [&](const Knot& a, const Knot& b) {
    if ((a.r == b.r && a.z == b.z) || a.z >= kAboveAll)
      return;  // nothing is ever near the end of what holds it
    ProfileSegment segment = segment_between(a, b);
    if (!segments_.empty() && goes_on(segments_.back(), segment)) {
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

void ToolDistance::look_at_line(const ProfileSegment& segment, double rho, double z, Nearest& nearest) {
  const double dr = segment.r1 - segment.r0, dz = segment.z1 - segment.z0;
  const double share =
      std::clamp(((rho - segment.r0) * dr + (z - segment.z0) * dz) * segment.per_length2, 0.0, 1.0);
  if (!nearest.take(rho, z, segment.r0 + share * dr, segment.z0 + share * dz)) return;
  nearest.line = &segment;
  nearest.is_end = share == 0.0 || share == 1.0;
  nearest.bend = 0.0;
}

void ToolDistance::look_at_arc(const ProfileSegment& segment, double rho, double z, Nearest& nearest) {
  const double r = rho - segment.centre_r, h = z - segment.centre_z;
  const double begin_r = segment.r0 - segment.centre_r, begin_z = segment.z0 - segment.centre_z;
  const double end_r = segment.r1 - segment.centre_r, end_z = segment.z1 - segment.centre_z;
  const double length = std::sqrt(r * r + h * h);
  // No arc of a profile is longer than half a circle, as it never goes down.
  const bool between = segment.side * (begin_r * h - begin_z * r) >= 0.0 &&
                       segment.side * (r * end_z - h * end_r) >= 0.0 && length > 0.0;
  const auto set_normal = [&] {
    nearest.line = nullptr;
    nearest.is_end = !between;
    nearest.bend = between ? segment.side / length : 0.0;
    nearest.normal_r = segment.side * (nearest.r - segment.centre_r) / segment.radius;
    nearest.normal_z = segment.side * (nearest.z - segment.centre_z) / segment.radius;
  };
  if (between) {
    const double scale = segment.radius / length;
    if (nearest.take(rho, z, segment.centre_r + scale * r, segment.centre_z + scale * h)) set_normal();
    return;
  }
  if (nearest.take(rho, z, segment.r0, segment.z0)) set_normal();
  if (nearest.take(rho, z, segment.r1, segment.z1)) set_normal();
}

TurnedDistance ToolDistance::at(double rho, double z) const {
  Nearest nearest;
  for (const ProfileSegment& segment : segments_)
    segment.side == 0.0 ? look_at_line(segment, rho, z, nearest) : look_at_arc(segment, rho, z, nearest);
  const double distance = std::sqrt(nearest.distance2);
  const double sign = is_inside(rho, z) ? -1.0 : 1.0;
  const double per_distance = sign / std::max(distance, kOnOutline);
  const double bend = nearest.is_end ? per_distance : nearest.bend;
  if (distance >= kOnOutline)
    return {sign * distance, per_distance * (rho - nearest.r), per_distance * (z - nearest.z), bend};
  if (nearest.line == nullptr) return {sign * distance, nearest.normal_r, nearest.normal_z, bend};
  const ProfileSegment& line = *nearest.line;
  const double per_length = std::sqrt(line.per_length2);
  return {sign * distance, per_length * (line.z1 - line.z0), per_length * (line.r0 - line.r1), bend};
}

}  // namespace kerf::sim

// Validates a half profile drawn by a user.
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "tool/arc.h"
#include "tool/silhouette.h"

#include "kerf/base/limits.h"

namespace kerf::detail {
namespace {

constexpr double kHeading = 1e-9;  // radians: rounding of an arc's heading at its ends

std::string knot_fault(const Knot& knot) {
  if (!std::isfinite(knot.r) || !std::isfinite(knot.z) || !std::isfinite(knot.bulge))
    return "is not a finite number";
  if (knot.r < 0.0) return "lies left of the axis (r below 0)";
  if (knot.r > limits::kMaxToolSize || std::abs(knot.z) > limits::kMaxToolSize)
    return "is farther than 10 m away";
  if (std::abs(knot.bulge) > 1.0) return "has a bulge beyond a half circle (-1 to 1)";
  return "";
}

/// An arc may neither decrease in z nor cross the axis.
std::string arc_fault(const Knot& a, const Knot& b) {
  if (a.r == b.r && a.z == b.z) return "starts an arc of zero length";
  const double half_sweep = 2.0 * std::atan(a.bulge);
  const double heading = std::atan2(b.z - a.z, b.r - a.r);
  for (const double end : {heading - half_sweep, heading + half_sweep}) {
    if (end < -kHeading || end > std::numbers::pi + kHeading) return "starts an arc that decreases in z";
  }
  // A clockwise arc whose ends lie above and below its centre bulges towards the axis.
  const ProfileArc arc = profile_arc(a, b);
  const bool bulges = a.bulge < 0.0 && arc.z > a.z && arc.z < b.z;
  return bulges && arc.r - arc.radius < 0.0 ? "starts an arc that crosses the axis" : "";
}

std::string segment_fault(const Knot& a, const Knot& b) {
  if (b.z < a.z) return "is higher than the next one; a profile goes from the bottom to the top";
  return a.bulge == 0.0 ? "" : arc_fault(a, b);
}

/// The first fault of a point or of the segment after it.
std::string points_fault(const std::vector<Knot>& knots) {
  for (std::size_t i = 0; i < knots.size(); ++i) {
    std::string fault = knot_fault(knots[i]);
    if (fault.empty() && i + 1 < knots.size()) fault = segment_fault(knots[i], knots[i + 1]);
    if (!fault.empty()) return fmt::format("point {} of the profile {}", i + 1, fault);
  }
  return "";
}

}  // namespace

std::string fault_of(const Profile& profile) {
  const std::vector<Knot>& knots = profile.knots;
  if (knots.size() < 2) return "a drawn profile needs at least two points";
  if (knots.size() > limits::kMaxProfilePoints)
    return fmt::format("a drawn profile has at most {} points", limits::kMaxProfilePoints);
  if (std::string fault = points_fault(knots); !fault.empty()) return fault;
  if (knots.front().z != 0.0) return "a drawn profile starts at the tip, z = 0";
  if (!(knots.back().z > 0.0) || !(profile.max_radius() > 0.0)) return "a drawn profile encloses no solid";
  return "";
}

}  // namespace kerf::detail

namespace kerf {

bool is_valid(const Profile& profile) {
  return profile.knots.size() != 1 && profile.knots.size() <= limits::kMaxProfilePoints &&
         detail::points_fault(profile.knots).empty();
}

}  // namespace kerf

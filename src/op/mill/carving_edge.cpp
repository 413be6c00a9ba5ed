// The cutting edge of a tool that increases in diameter upwards.
#include "op/mill/carving_edge.h"

#include <algorithm>
#include <cmath>

#include "tool/arc.h"

namespace kerf::op_detail {
namespace {

constexpr int kArcChords = 512;     // of a quarter circle: within 1.2e-6 of its radius
constexpr double kNarrower = 1e-9;  // mm, rounding of a profile

}  // namespace

std::optional<CarvingEdge> CarvingEdge::of(const Tool& tool) {
  const std::vector<Knot>& knots = tool.silhouette.cutting.knots;
  CarvingEdge edge;
  bool narrows = false;
  const double widest = tool.silhouette.cutting.max_radius();
  const auto add = [&](double r, double z) {
    // A flat tip: the radius counts, not the axis.
    if (edge.points_.empty() || (z <= edge.points_.front().z && r > edge.points_.front().r)) {
      edge.points_ = {{r, z}};
      return;
    }
    const Point last = edge.points_.back();
    if (last.r >= widest - kNarrower) return;
    narrows |= r < last.r - kNarrower;
    if (r > last.r || z > last.z) edge.points_.push_back({std::max(r, last.r), std::max(z, last.z)});
  };
  for (std::size_t i = 0; i < knots.size(); ++i) {
    add(knots[i].r, knots[i].z);
    if (i + 1 == knots.size() || knots[i].bulge == 0.0) continue;
    const detail::ProfileArc arc = detail::profile_arc(knots[i], knots[i + 1]);
    const double start = std::atan2(knots[i].z - arc.z, knots[i].r - arc.r);
    const double sweep = 4.0 * std::atan(knots[i].bulge);
    for (int k = 1; k < kArcChords; ++k) {
      const double angle = start + sweep * k / kArcChords;
      add(arc.r + arc.radius * std::cos(angle), arc.z + arc.radius * std::sin(angle));
    }
  }
  if (narrows || edge.points_.size() < 2) return std::nullopt;
  return edge;
}

double CarvingEdge::height_of(double radius) const {
  const auto above = std::upper_bound(points_.begin(), points_.end(), radius,
                                      [](double r, const Point& p) { return r < p.r; });
  if (above == points_.begin()) return points_.front().z;
  if (above == points_.end()) return points_.back().z;
  const Point a = *(above - 1), b = *above;
  return a.z + (b.z - a.z) * ((radius - a.r) / (b.r - a.r));
}

double CarvingEdge::radius_at(double height) const {
  const auto above = std::upper_bound(points_.begin(), points_.end(), height,
                                      [](double z, const Point& p) { return z < p.z; });
  if (above == points_.begin()) return points_.front().r;
  if (above == points_.end()) return points_.back().r;
  const Point a = *(above - 1), b = *above;
  return a.r + (b.r - a.r) * ((height - a.z) / (b.z - a.z));
}

}  // namespace kerf::op_detail

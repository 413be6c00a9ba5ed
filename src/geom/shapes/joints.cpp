// Slots of finger joints, and reliefs of inner corners.
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/op.h"
#include "base/names.h"

#include "kerf/base/limits.h"
#include "kerf/geom/offset.h"
#include "kerf/geom/shapes.h"

namespace kerf {
namespace {

constexpr double kSpare = 0.002;  // mm by which a relief is wider, so that a path for the tool remains inside
constexpr double kStraight = std::numbers::pi / 180;  // corners that turn by less stay
constexpr int kMaxFingers = 10'000;

Outline box(double x1, double y1, double x2, double y2) {
  return {{x1, y1}, {{{x2, y1}, {}}, {{x2, y2}, {}}, {{x1, y2}, {}}, {{x1, y1}, {}}}};
}

Point2 unit(Point2 from, Point2 to) { return (1 / distance(from, to)) * (to - from); }

/// The path of the centre of a tool that clears the corner between two straight sides; nothing for outer and
/// straight corners. The region is on the left of its loops: corners that turn left are inner ones for the
/// tool.
std::optional<Outline> relief_path(Point2 before, Point2 corner, Point2 after, double radius,
                                   ReliefStyle style) {
  const Point2 back = unit(corner, before), along = unit(corner, after);
  const double turn = std::atan2(cross(along, back), dot(along, back));
  if (turn < kStraight || turn > std::numbers::pi - kStraight) return std::nullopt;
  const Point2 bisector = unit({0, 0}, back + along);
  const double reach = radius / std::sin(turn / 2);  // of the centre of a tool that touches both sides
  Point2 toward = bisector;
  if (style == ReliefStyle::t_bone)
    toward = distance(before, corner) < distance(corner, after) ? back : along;
  return Outline{corner + radius * toward, {{corner + reach * bisector, {}}}};
}

}  // namespace

std::optional<Region> finger_slots(const FingerJoint& joint, const RegionOptions& options,
                                   Diagnostics& diagnostics) {
  const std::size_t errors = diagnostics.errors();
  const auto expect = [&](bool holds, const std::string& rule) {
    if (!holds) diagnostics.error(codes::op_option, options.where, rule);
  };
  const auto size = [](Length l) { return l.mm() > 0.0 && l.mm() <= limits::kMaxCoordinate; };
  expect(size(joint.width), fmt::format("width must be above 0 mm, not {:g}", joint.width.mm()));
  expect(size(joint.depth), fmt::format("depth must be above 0 mm, not {:g}", joint.depth.mm()));
  expect(joint.count >= 3 && joint.count % 2 == 1 && joint.count <= kMaxFingers,
         fmt::format("count must be an odd number of at least 3, not {}", joint.count));
  const double step = joint.width.mm() / std::max(joint.count, 1);
  expect(std::abs(joint.fit.mm()) < step,
         fmt::format("fit must be smaller than a finger of {:g} mm, not {:g}", step, joint.fit.mm()));
  expect(joint.overhang.mm() >= 0.0 && joint.overhang.mm() <= limits::kMaxCoordinate,
         fmt::format("overhang must be 0 mm or more, not {:g}", joint.overhang.mm()));
  if (diagnostics.errors() > errors) return std::nullopt;
  const double over = joint.overhang.mm(), gap = joint.fit.mm() / 2;
  std::vector<Outline> slots;
  for (int i = joint.ends == FingerJoint::Ends::fingers ? 1 : 0; i < joint.count; i += 2) {
    const double low = i == 0 ? -over : i * step - gap;
    const double high = i == joint.count - 1 ? joint.width.mm() + over : (i + 1) * step + gap;
    slots.push_back(box(low, -over, high, joint.depth.mm()));
  }
  return make_region(slots, FillRule::nonzero, options, diagnostics);
}

std::optional<ReliefStyle> relief_style_named(std::string_view name) {
  const std::string folded = fold_name(name);
  if (folded == "dogbone") return ReliefStyle::dog_bone;
  if (folded == "tbone") return ReliefStyle::t_bone;
  return std::nullopt;
}

std::optional<Region> relieve_corners(const Region& region, const ReliefOptions& relief,
                                      const RegionOptions& options, Diagnostics& diagnostics) {
  if (!(relief.diameter.mm() > 0.0 && relief.diameter.mm() <= limits::kMaxToolSize)) {
    diagnostics.error(codes::op_option, options.where,
                      fmt::format("diameter must be above 0 mm, not {:g}", relief.diameter.mm()));
    return std::nullopt;
  }
  const double radius = relief.diameter.mm() / 2 + kSpare;
  std::optional<RegionSearch> limits;
  if (relief.limits != nullptr) limits.emplace(*relief.limits);
  std::vector<Region> all{region};
  for (const Outline& loop : region.loops)
    for (std::size_t i = 0; i < loop.segments.size(); ++i) {
      const std::size_t last = i == 0 ? loop.segments.size() - 1 : i - 1;  // the segment before the corner
      if (loop.segments[last].via || loop.segments[i].via) continue;
      const Point2 corner = loop.point(i);
      if (limits && limits->locate(corner, options.tolerance.weld) == Location::outside) continue;
      const auto path = relief_path(loop.point(last), corner, loop.segments[i].to, radius, relief.style);
      if (!path) continue;
      auto cleared = buffer(*path, mm(radius), PathEnds::round, options, diagnostics);
      if (!cleared) return std::nullopt;
      all.push_back(std::move(*cleared));
    }
  return unite(all, options, diagnostics);
}

}  // namespace kerf

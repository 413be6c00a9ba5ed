// What all operations have in common: options, levels, and joining of their paths.
#include "kerf/op/operation.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "op/base/cutter.h"
#include "op/base/option_check.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace {

constexpr double kLevelSlack = 1e-9;  // of a stepdown: rounding of the depth makes no pass of its own
constexpr int kRadiusSamples = 64;    // of a curved silhouette
constexpr double kMinEntryAngle = 0.5, kMaxEntryAngle = 89.0;  // degrees

}  // namespace

void append(Toolpath& path, const Toolpath& piece) {
  std::optional<Point3> here;
  if (const auto last = path.motion_before(path.size()); last && path[*last].unknown_axes() == 0)
    here = path[*last].to();
  bool first = true;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const Step& s = piece[i];
    const bool rises = first && s.kind() == StepKind::rapid && s.unknown_axes() == 3;
    if (s.is_motion()) first = false;
    if (rises && here) {
      const Point3 to{here->x, here->y, std::max(here->z, s.to().z)};
      if (to != *here) path.add(step::Rapid{to}, path.copy_origin(piece, i));
    } else {
      path.add_copy(piece, i);
    }
  }
}

Length cutting_radius(const Tool& tool, Length depth) {
  const Profile& profile = tool.silhouette.cutting;
  double radius = 0.0;
  for (const Knot& knot : profile.knots)
    if (knot.z <= depth.mm()) radius = std::max(radius, knot.r);
  const double top = std::min(depth.mm(), profile.top());
  for (int i = 0; i <= kRadiusSamples; ++i)
    radius =
        std::max(radius, profile.radius_at(profile.bottom() + (top - profile.bottom()) * i / kRadiusSamples));
  return mm(radius);
}

std::vector<double> pass_levels(double top, Length depth, Length stepdown) {
  double passes = 1.0;
  if (stepdown > Length{}) passes = std::max(std::ceil(depth / stepdown - kLevelSlack), 1.0);
  passes = std::min(passes, limits::kMaxPasses);
  std::vector<double> levels;
  for (double i = 1.0; i < passes; i += 1.0) levels.push_back(top - depth.mm() * (i / passes));
  levels.push_back(top - depth.mm());
  return levels;
}

namespace op_detail {

std::string prefix(const CutOptions& options) { return options.name.empty() ? "" : options.name + ": "; }

bool fail(const CutOptions& options, Code code, const std::string& message, Diagnostics& diagnostics) {
  diagnostics.error(code, options.where, prefix(options) + message);
  return false;
}

bool in_range(Point2 p) {
  return std::abs(p.x) <= limits::kMaxCoordinate && std::abs(p.y) <= limits::kMaxCoordinate;
}

std::optional<Operation> finished(Cutter& cutter, const CutOptions& options, Diagnostics& diagnostics) {
  if (stop_requested(options.progress)) return std::nullopt;
  if (cutter.full()) {
    fail(options, codes::op_limit, fmt::format("more than {} steps", options.max_steps), diagnostics);
    return std::nullopt;
  }
  if (const auto at = cutter.bad_plunge()) {
    const std::string message =
        fmt::format("the tool does not cut at its centre, and there is no room for a ramp at {:.6g}, {:.6g}",
                    at->x, at->y);
    fail(options, codes::op_tool_kind, message, diagnostics);
    return std::nullopt;
  }
  cutter.lift();
  Operation made;
  made.path = cutter.take();
  return made;
}

bool may_plunge(const Tool& tool, std::string_view cannot, const CutOptions& options,
                Diagnostics& diagnostics) {
  return tool.plunges || fail(options, codes::op_tool_kind,
                              fmt::format("tool {} ({}) does not cut at its centre and cannot {}",
                                          tool.number, name_of(tool.shape), cannot),
                              diagnostics);
}

RegionOptions region_options(const CutOptions& options) {
  return {.tolerance = options.tolerance,
          .name = options.name,
          .where = options.where,
          .progress = options.progress};
}

bool within_limits(const std::vector<Outline>& outlines, const CutOptions& options,
                   Diagnostics& diagnostics) {
  const auto good = [](const Outline& outline) {
    return in_range(outline.start) &&
           std::all_of(outline.segments.begin(), outline.segments.end(),
                       [](const Segment& s) { return in_range(s.to) && (!s.via || in_range(*s.via)); });
  };
  return std::all_of(outlines.begin(), outlines.end(), good) ||
         fail(options, codes::op_option,
              fmt::format("an outline extends beyond {:g} mm", limits::kMaxCoordinate), diagnostics);
}

bool valid(const CutOptions& options, const Tool& tool, Diagnostics& diagnostics) {
  OptionCheck check(options, diagnostics);
  const double depth = options.depth.mm(), stepdown = options.stepdown.mm();
  const double feed = options.feed.mm_per_min(), plunge = options.plunge.mm_per_min();
  const double top = options.top, retract = options.retract_plane, clearance = options.clearance.mm();
  check.expect(std::abs(top) <= limits::kMaxCoordinate, "top", top, "a coordinate");
  check.expect(depth > 0.0 && depth <= limits::kMaxCoordinate, "depth", depth, "above 0 mm");
  check.expect(stepdown >= 0.0 && stepdown <= limits::kMaxCoordinate &&
                   !(stepdown > 0.0 && depth / stepdown > limits::kMaxPasses),
               "stepdown", stepdown,
               fmt::format("above 0 mm, and at least depth / {:g}", limits::kMaxPasses));
  check.expect(feed > 0.0 && feed <= limits::kMaxSpeed, "feed", feed, "above 0 mm/min");
  check.expect(plunge >= 0.0 && plunge <= limits::kMaxSpeed, "plunge", plunge, "above 0 mm/min");
  check.expect(clearance >= 0.0 && clearance <= limits::kMaxCoordinate, "clearance", clearance,
               "0 mm or more");
  check.expect(retract >= top + clearance && retract <= limits::kMaxCoordinate, "retract plane", retract,
               fmt::format("at or above Z{:g}, the surface and the clearance", top + clearance));
  const double allowance = options.allowance.mm();
  check.expect(allowance >= 0.0 && allowance <= limits::kMaxCoordinate, "allowance", allowance,
               "0 mm or more");
  const double angle = options.entry.angle.deg(), radius = options.entry.radius.mm();
  check.expect(angle >= kMinEntryAngle && angle <= kMaxEntryAngle, "entry angle", angle,
               fmt::format("from {:g} to {:g} degrees", kMinEntryAngle, kMaxEntryAngle));
  check.expect(radius >= 0.0 && radius <= limits::kMaxToolSize, "helix radius", radius, "0 mm or more");
  const double cutting = cutting_radius(tool, options.depth).mm();
  check.expect(cutting > 0.0 || !(depth > 0.0), "cutting radius of the tool", cutting, "above 0 mm");
  if (check.valid() && tool.flute < options.depth)
    diagnostics.warning(codes::op_flute, options.where,
                        fmt::format("{}depth {:g} mm exceeds the flute length of tool {}, {:g} mm",
                                    prefix(options), depth, tool.number, tool.flute.mm()));
  return check.valid();
}

bool valid_stepover(double stepover, const CutOptions& options, Diagnostics& diagnostics) {
  OptionCheck check(options, diagnostics);
  check.expect(stepover > 0.0 && stepover <= 1.0, "stepover", stepover,
               "above 0 and at most 1 (a fraction of the tool's diameter)");
  return check.valid();
}

}  // namespace op_detail
}  // namespace kerf

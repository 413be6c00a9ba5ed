// Drilled and bored holes.
#include "kerf/op/holes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/op.h"
#include "op/base/cutter.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr double kMaxOrdered = 5000.0;  // points: ordering takes the time of their square
constexpr double kSameRadius = 1e-6;    // mm: rounding of silhouettes
constexpr double kMinAxis = 0.01;  // radius of a helix as a fraction of that of the tool: less is drilling

/// Indices of points, each followed by the nearest of those that are left.
std::vector<std::size_t> nearest_order(const std::vector<Point2>& points) {
  std::vector<std::size_t> order, open;
  for (std::size_t i = 0; i < points.size(); ++i) open.push_back(i);
  if (static_cast<double>(points.size()) > kMaxOrdered) return open;
  std::size_t next = 0;
  while (!open.empty()) {
    const std::size_t index = open[next];
    order.push_back(index);
    open.erase(open.begin() + static_cast<std::ptrdiff_t>(next));
    double shortest = INFINITY;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const double d = distance(points[index], points[open[i]]);
      if (d < shortest) shortest = d, next = i;
    }
  }
  return order;
}

CutOptions frame_of(const DrillOptions& o, const Tool& tool) {
  CutOptions cut;
  cut.top = o.top, cut.feed = o.feed;
  cut.depth = o.depth_of == DrillDepth::diameter ? o.depth + point_length(tool) : o.depth;
  cut.retract_plane = o.retract_plane, cut.clearance = o.clearance;
  cut.name = o.name, cut.where = o.where;
  return cut;
}

class BoreRun {
 public:
  BoreRun(const BoreOptions& options, const Tool& tool)
      : options_(options),
        tool_radius_(cutting_radius(tool, options.cut.depth).mm()),
        cutter_(options.cut, tool, Walls(Walls::Kind::none)) {}
  void hole(const Circle& hole, double axis_radius) {
    const double step = 2.0 * options_.stepover * tool_radius_;
    // The first helix leaves no core, the others are one stepover wider.
    const double first = std::min(axis_radius, 0.9 * tool_radius_);
    const double more = std::ceil((axis_radius - first) / step - 1e-9);
    cutter_.lift();
    for (double k = 0.0; k <= more && !cutter_.full(); k += 1.0)
      helix(hole.centre, k < more ? first + k * step : axis_radius, k > 0.0);
  }
  Cutter& cutter() { return cutter_; }

 private:
  void helix(Point2 centre, double radius, bool inner_cleared) {
    const CutOptions& cut = options_.cut;
    const double bottom = cut.top - cut.depth.mm();
    const Turn turn = cut.direction == CutDirection::climb ? Turn::ccw : Turn::cw;
    const Point2 start = centre + Point2{radius, 0.0};
    if (inner_cleared) {
      // From the end of the last helix straight up, and out over material that is left.
      cutter_.travel(start, cut.top);
    } else {
      cutter_.lift();
      cutter_.travel(start, cut.top);
    }
    cutter_.rapid_down(cut.top + cut.clearance.mm());
    const double drop = cutter_.position()->z - bottom;
    double pitch = 2.0 * std::numbers::pi * radius * std::tan(cut.entry.angle.rad());
    if (cut.stepdown > Length{}) pitch = std::min(pitch, cut.stepdown.mm());
    const double turns = std::clamp(std::ceil(drop / pitch - 1e-9), 1.0, double{limits::kMaxTurns});
    cutter_.arc(start, centre, turn, bottom, static_cast<int>(turns));
    cutter_.arc(start, centre, turn, bottom);
    // Off the wall before the tool rises.
    cutter_.line(centre + (1.0 - kStepOff) * (start - centre));
  }
  static constexpr double kStepOff = 0.1;  // of the helix' radius

  const BoreOptions& options_;
  double tool_radius_;
  Cutter cutter_;
};

}  // namespace

Length point_length(const Tool& tool) {
  const Profile& profile = tool.silhouette.cutting;
  for (const Knot& knot : profile.knots)
    if (knot.r >= profile.max_radius() - kSameRadius) return mm(knot.z);
  return {};
}

std::optional<Operation> drill(const std::vector<Point2>& points, const Tool& tool,
                               const DrillOptions& options, Diagnostics& diagnostics) {
  const CutOptions cut = frame_of(options, tool);
  if (!may_plunge(tool, "drill", cut, diagnostics) || !valid(cut, tool, diagnostics)) return std::nullopt;
  if (points.empty()) {
    diagnostics.error(codes::op_empty, options.where, prefix(cut) + "no points; nothing to drill");
    return std::nullopt;
  }
  DrillCycle cycle;
  cycle.kind = options.kind;
  cycle.retract_plane = options.top + options.clearance.mm();
  cycle.bottom = cut.top - cut.depth.mm();
  cycle.retract = DrillRetract::start;
  cycle.start_level = options.retract_plane;
  cycle.peck = options.peck;
  cycle.dwell = options.dwell;
  const bool supported = cycle.kind == DrillKind::plain || cycle.kind == DrillKind::dwell ||
                         cycle.has_pecks() || cycle.kind == DrillKind::bore ||
                         cycle.kind == DrillKind::dwell_bore;
  std::string fault = supported ? "" : "this cycle needs a spindle that the operation does not control";
  if (supported)
    if (const auto found = fault_of(cycle)) fault = found->message;
  for (const Point2& p : points)
    if (!in_range(p)) fault = fmt::format("a point lies beyond {:g} mm", limits::kMaxCoordinate);
  if (fault.empty() &&
      min_steps(cycle) * static_cast<double>(points.size()) > static_cast<double>(cut.max_steps)) {
    diagnostics.error(codes::op_limit, options.where,
                      fmt::format("{}more than {} steps", prefix(cut), cut.max_steps));
    return std::nullopt;
  }
  if (!fault.empty()) {
    diagnostics.error(codes::op_option, options.where, prefix(cut) + fault);
    return std::nullopt;
  }
  Operation made;
  const OriginId origin = std::holds_alternative<std::monostate>(options.where)
                              ? OriginId::none
                              : made.path.origins().add(options.where);
  made.path.set_unknown_axes(made.path.add(step::Rapid{{0.0, 0.0, options.retract_plane}}, origin), 3);
  Point3 here{0.0, 0.0, options.retract_plane};
  for (const std::size_t i : nearest_order(points)) {
    cycle.at = {points[i].x, points[i].y, 0.0};
    add_cycle(made.path, cycle, here, {options.feed, {}}, origin);
    here = {points[i].x, points[i].y, options.retract_plane};
  }
  return made;
}

std::optional<Operation> bore(const std::vector<Circle>& holes, const Tool& tool, const BoreOptions& options,
                              Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  const bool permitted = valid(cut, tool, diagnostics);
  if (!valid_stepover(options.stepover, cut, diagnostics) || !permitted) return std::nullopt;
  if (holes.empty()) {
    diagnostics.error(codes::op_empty, cut.where, prefix(cut) + "no circles; nothing to bore");
    return std::nullopt;
  }
  const double radius = cutting_radius(tool, cut.depth).mm();
  std::vector<Point2> centres;
  const Circle* least = nullptr;  // of those that do not fit
  std::size_t narrow = 0;
  for (const Circle& hole : holes) {
    centres.push_back(hole.centre);
    const double axis = hole.radius.mm() - radius - cut.allowance.mm();
    if (in_range(hole.centre) && hole.radius.mm() <= limits::kMaxCoordinate && axis >= kMinAxis * radius)
      continue;
    ++narrow;
    if (least == nullptr || hole.radius < least->radius) least = &hole;
  }
  if (least != nullptr) {
    const std::string which = narrow == 1 ? "the hole" : fmt::format("{} holes, the narrowest", narrow);
    diagnostics
        .error(codes::op_tool_wide, cut.where,
               fmt::format("{}tool {} of {:.4g} mm is too wide to bore {} of {:.4g} mm at {:.6g}, {:.6g}",
                           prefix(cut), tool.number, 2.0 * radius, which, 2.0 * least->radius.mm(),
                           least->centre.x, least->centre.y))
        .hint = "drill them, or use a smaller tool";
    return std::nullopt;
  }
  BoreRun run(options, tool);
  for (const std::size_t i : nearest_order(centres)) {
    if (run.cutter().full()) break;
    run.hole(holes[i], holes[i].radius.mm() - radius - cut.allowance.mm());
  }
  return finished(run.cutter(), cut, diagnostics);
}

}  // namespace kerf

// G40 to G42: motions with cutter compensation.
//
// position_ remains the programmed position; the steps are those of the tool axis, offset from it. At an
// inside corner the next motion changes the end point of the last one: then all steps since the last motion
// in the plane get the new end point.
#include "front/gcode/run/compensation.h"

#include <cmath>
#include <fmt/format.h>

#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

constexpr double kMinPlaneMotion = 1e-9;  // mm; a shorter distance is no motion in the plane

}  // namespace

void Compensation::set() {
  const Tenths code = line_.code(Group::compensation);
  const std::optional<double> number = line_.take('D');
  if (code == 400) return end();
  if (cutter_)
    reporter_.unusual(codes::compensation_refused, line_.column(Group::compensation),
                      "cutter compensation is already on; LinuxCNC requires a G40 before it is set again");
  if (modes_.plane == Plane::yz) {
    reporter_.error(codes::compensation_refused, line_.column(Group::compensation),
                    "cutter compensation is possible in the XY and XZ planes only; skipped");
    return;
  }
  const bool is_stated = code == 411 || code == 421;
  const std::optional<double> diameter = is_stated ? given_diameter(number) : diameter_of_tool(number);
  if (!diameter) return;
  if (!is_stated)
    reporter_.note(codes::compensation_radius, line_.column(Group::compensation),
                   fmt::format("{} offsets the path by {:.5g} mm", code_text('G', code), 0.5 * *diameter));
  double to_left = (code < 420 ? 0.5 : -0.5) * *diameter;
  const PlaneAxes axes = axes_of(modes_.plane);
  if (coordinates_.frame().scale[axes.u] * coordinates_.frame().scale[axes.v] < 0.0) to_left = -to_left;
  const bool entered = cutter_ && cutter_->entered();
  if (!entered) reset();
  if (to_left == 0.0)
    cutter_.reset();
  else if (entered)
    cutter_->change(to_left);
  else
    cutter_.emplace(to_left, kMaxCoordinate);
}

/// G41.1 and G42.1: D is the diameter itself.
std::optional<double> Compensation::given_diameter(std::optional<double> number) {
  if (number) return *number * modes_.scale;
  reporter_.error(
      codes::word_missing, line_.column(Group::compensation),
      fmt::format("{} needs D, the tool diameter", code_text('G', line_.code(Group::compensation))));
  return std::nullopt;
}

/// G41 and G42: D is the number of the tool whose diameter is used; without D, the tool in the spindle.
std::optional<double> Compensation::diameter_of_tool(std::optional<double> number) {
  const bool whole = !number || (*number == std::floor(*number) && *number >= 0.0 && *number < 1e9);
  if (!whole) {
    reporter_.error(codes::word_out_of_range, line_.column('D'), "D is a tool number, an integer from 0");
    return std::nullopt;
  }
  if (number == 0.0) return 0.0;
  const std::optional<int> tool = number ? static_cast<int>(*number) : modes_.tool;
  if (const auto set = options_.compensation_radii.find(tool.value_or(0));
      set != options_.compensation_radii.end())
    return 2.0 * set->second;
  const std::optional<double> diameter = tool ? diameters_.of(*tool) : std::nullopt;
  if (diameter) return diameter;
  return assumed_diameter(tool);
}

/// The diameter of an unknown tool: GcodeReadOptions::assumed_diameter, else an error.
std::optional<double> Compensation::assumed_diameter(std::optional<int> tool) {
  const std::string which =
      tool ? fmt::format("tool {}", *tool) : "the tool, but there is no tool change before it";
  if (options_.assumed_diameter) {
    const std::string diameter = fmt::format("{:.5g}", *options_.assumed_diameter);
    program_.assumed_diameter = true;
    reporter_.unusual(
        codes::compensation_no_tool, line_.column(Group::compensation),
        fmt::format("cutter compensation needs the diameter of {}; assuming {} mm", which, diameter),
        tool ? fmt::format(
                   "specify it, e.g. --tool {0}=\"square d={1}\", or the offset alone: --comp D{0}={2:g}",
                   *tool, diameter, 0.5 * *options_.assumed_diameter)
             : std::string("put M6 T... before it, or use G41.1 D6"));
    return options_.assumed_diameter;
  }
  reporter_.error(
      codes::compensation_no_tool, line_.column(Group::compensation),
      fmt::format("cutter compensation needs the diameter of {}; the path is not compensated", which),
      tool ? fmt::format("specify one, e.g. --tool {0}=\"square d=6\", or the offset alone: --comp D{0}=3",
                         *tool)
           : std::string("put M6 T... before it, or use G41.1 D6"));
  return std::nullopt;
}

void Compensation::reset() {
  cutter_.reset();
  leaving_ = false;
  last_step_ = 0;
}

void Compensation::end() {
  const bool leaves = cutter_ && cutter_->entered();
  if (leaves && !cutter_->ends_forward()) report_gouge();
  reset();
  leaving_ = leaves;
}

/// LinuxCNC refuses these codes while compensation is on, because the programmed position is not that of the
/// tool.
void Compensation::end_for_refused_codes() {
  if (!cutter_) return;
  constexpr Group kRefused[] = {Group::coordinates, Group::reference, Group::machine_coordinates,
                                Group::scaling,     Group::rotation,  Group::tool_change,
                                Group::lathe};
  for (const Group group : kRefused) {
    const bool tool_data = group == Group::reference && line_.code(group) == 100 && line_.value('L') == 1.0;
    if (line_.has(group) && !tool_data)
      return refuse(code_text(group == Group::tool_change ? 'M' : 'G', line_.code(group)),
                    line_.column(group));
  }
  if (line_.has(Group::motion) && line_.code(Group::motion) != kNoMotion && line_.code(Group::motion) > 30)
    return refuse(code_text('G', line_.code(Group::motion)), line_.column(Group::motion));
}

void Compensation::refuse(std::string_view what, std::uint32_t column) {
  reporter_.error(
      codes::compensation_refused, column,
      fmt::format("{} is not allowed while cutter compensation is on; compensation ends here", what),
      "put a G40 and a motion away from the part before it");
  end();
}

/// A straight motion with compensation.
void Compensation::line(const ToolPosition& to, MotionKind kind, double feed) {
  const LineArc line = line_between(in_plane(position_.at), in_plane(to.at));
  if (!(distance(line.from, line.to) > kMinPlaneMotion)) return along_third_axis(to, kind, feed);
  const CompensatedElement made = *cutter_->add(line);
  if (made.short_entry)
    reporter_.error(
        codes::compensation_entry, line_.column(),
        fmt::format("the first motion with cutter compensation must be longer than the tool radius; "
                    "{:.4g} mm is not more than {:.4g} mm",
                    distance(line.from, line.to), cutter_->radius()),
        "start farther away from the part");
  if (!add_corner(made, kind, feed)) return;
  add_motion(with_plane_position(to.at, made.axis.to), to, kind, feed);
  last_step_ = path_.size() - 1;
}

/// A motion without a component in the plane: the tool keeps its offset from the programmed path.
void Compensation::along_third_axis(const ToolPosition& to, MotionKind kind, double feed) {
  const CutterCompensation& cutter = *cutter_;
  if (!cutter.entered())
    reporter_.unusual(
        codes::compensation_entry, line_.column(),
        "LinuxCNC requires a motion in the plane to start cutter compensation; this one is not compensated");
  const Point3 at = cutter.entered() ? with_plane_position(to.at, cutter.tool()) : to.at;
  add_motion(at, to, kind, feed);
}

/// Moves the end of the last element and adds the arc around an outside corner. False at the limit of steps.
bool Compensation::add_corner(const CompensatedElement& made, MotionKind kind, double feed) {
  if (made.gouges) report_gouge();
  if (made.previous_end)
    for (std::size_t i = last_step_; i < path_.size(); ++i)
      if (path_[i].is_motion()) path_.set_end(i, with_plane_position(path_[i].to(), *made.previous_end));
  if (!made.corner) return true;
  ToolPosition at = position_;
  at.at = with_plane_position(position_.at, made.corner->to);
  const Point2 corner = made.corner->circle_centre();
  const Turn turn = made.corner->turn > 0.0 ? Turn::ccw : Turn::cw;
  const bool added = kind == MotionKind::rapid ? add(step::Rapid{at.at})
                                               : add(step::Arc{at.at, in_name_order(modes_.plane, corner),
                                                               modes_.plane, turn, 0, mm_per_min(feed)});
  if (!added) return false;
  const Point3 programmed = position_.at;
  mover_.arrive(at);
  position_.at = programmed;
  return true;
}

void Compensation::report_gouge() {
  reporter_.error(
      codes::compensation_gouge, line_.column(),
      fmt::format("a tool of radius {:.4g} mm does not fit into the inside corner before this line "
                  "without cutting into the part",
                  cutter_->radius()),
      "use a smaller tool, or round the corner in the program");
}

/// An arc with compensation.
void Compensation::arc(const ToolPosition& to, Point2 centre, Turn turn, int extra, Feed feed) {
  const LineArc arc =
      arc_about(in_name_order(modes_.plane, centre), in_plane(position_.at), in_plane(to.at), turn);
  CutterCompensation& cutter = *cutter_;
  const bool entry = !cutter.entered();
  const std::optional<CompensatedElement> made = cutter.add(arc);
  if (!made) {
    reporter_.error(
        entry ? codes::compensation_entry : codes::compensation_gouge, line_.column(),
        fmt::format("{} {:.4g} mm is too small for a tool of radius {:.4g} mm; read as a straight cut",
                    entry ? "an arc at the start of cutter compensation with a radius of"
                          : "an inside arc with a radius of",
                    arc.radius, cutter.radius()));
    return line(to, MotionKind::cut, feed.mm_per_min());
  }
  if (!add_corner(*made, MotionKind::cut, feed.mm_per_min())) return;
  const Point2 about = in_name_order(modes_.plane, made->axis.circle_centre());
  const Point3 end = with_plane_position(to.at, made->axis.to);
  if (!reachable(end) || !reachable({about.x, about.y, 0.0})) return;
  if (!add(step::Arc{end, about, modes_.plane, turn, extra, feed})) return;
  mover_.arrive(to);
  last_step_ = path_.size() - 1;
}

void Compensation::add_motion(Point3 at, const ToolPosition& to, MotionKind kind, double feed) {
  if (!reachable(at)) return;
  const bool added = kind == MotionKind::rapid ? add(step::Rapid{at}) : add(step::Cut{at, mm_per_min(feed)});
  if (added) mover_.arrive(to);
}

}  // namespace kerf::gcode

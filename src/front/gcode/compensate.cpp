// G40 to G42: moves while the tool's radius is compensated.
//
// The controller goes on to count in the places that the program tells (here_); the steps lead the tool's
// axis beside them. Where a move ends may change once more with the next one, at an inside corner: then the
// steps since the last move in the plane are led to the new place.
#include <cmath>
#include <fmt/format.h>

#include "front/gcode/interpreter.h"

namespace kerf::gcode {

Point2 Interpreter::in_plane(Point3 p) const {
  const PlaneAxes axes = axes_of(modes_.plane);
  return {p[axes.u], p[axes.v]};
}

Point3 Interpreter::moved_in_plane(Point3 p, Point2 to) const {
  const PlaneAxes axes = axes_of(modes_.plane);
  p[axes.u] = to.x;
  p[axes.v] = to.y;
  return p;
}

void Interpreter::set_compensation() {
  const Tenths code = line_.code(Group::compensation);
  const std::optional<double> number = line_.take('D');
  if (code == 400) return end_compensation();
  if (compensation_.side != Side::none)
    talker_.unusual(Code::compensation_refused, line_.column(Group::compensation),
                    "cutter compensation is on already; LinuxCNC wants a G40 before it is set anew");
  if (modes_.plane == Plane::yz) {
    talker_.error(Code::compensation_refused, line_.column(Group::compensation),
                  "cutter compensation goes with the XY and the XZ plane; it is left out");
    return;
  }
  const std::optional<double> diameter =
      code == 411 || code == 421 ? told_diameter(number) : diameter_for_compensation(number);
  if (!diameter) return;
  Side side = code < 420 ? Side::left : Side::right;
  if (*diameter < 0.0) side = other(side);
  const PlaneAxes axes = axes_of(modes_.plane);
  if (placement_.scale[axes.u] * placement_.scale[axes.v] < 0.0) side = other(side);
  const bool entered = compensation_.entered && compensation_.side != Side::none;
  if (!entered) compensation_ = {};
  compensation_.side = *diameter == 0.0 ? Side::none : side;
  compensation_.radius = 0.5 * std::abs(*diameter);
}

/// G41.1 and G42.1: D is the diameter itself.
std::optional<double> Interpreter::told_diameter(std::optional<double> number) {
  if (number) return *number * modes_.scale;
  talker_.error(
      Code::word_missing, line_.column(Group::compensation),
      fmt::format("{} needs D, the tool's diameter", code_text('G', line_.code(Group::compensation))));
  return std::nullopt;
}

/// G41 and G42: D is the number of the tool whose diameter counts; without it, the tool in the spindle.
std::optional<double> Interpreter::diameter_for_compensation(std::optional<double> number) {
  const bool whole = !number || (*number == std::floor(*number) && *number >= 0.0 && *number < 1e9);
  if (!whole) {
    talker_.error(Code::word_out_of_range, line_.column('D'), "D is a tool's number, whole and from 0");
    return std::nullopt;
  }
  if (number == 0.0) return 0.0;
  const std::optional<int> tool = number ? static_cast<int>(*number) : modes_.tool;
  const std::optional<double> diameter = tool ? diameter_of(*tool) : std::nullopt;
  if (diameter) return diameter;
  const std::string which =
      tool ? fmt::format("tool {}", *tool) : "the tool, no tool change stands before it";
  talker_.error(
      Code::compensation_no_tool, line_.column(Group::compensation),
      fmt::format("cutter compensation needs the diameter of {}; the path is left as it is told", which),
      tool ? fmt::format("tell it, e.g. --tool {}=\"square d=6\", or use G41.1 D6", *tool)
           : std::string("write M6 T... before it, or use G41.1 D6"));
  return std::nullopt;
}

void Interpreter::end_compensation() {
  const bool leaves = compensation_.side != Side::none && compensation_.entered;
  if (leaves && !runs_forward(compensation_.last, compensation_.direction, compensation_.last.to))
    tell_gouge();
  compensation_ = {};
  compensation_.leaving = leaves;
}

/// Codes that LinuxCNC refuses while compensation is on, because the program's place and the tool's differ.
void Interpreter::guard_compensation() {
  if (compensation_.side == Side::none) return;
  constexpr Group kRefused[] = {Group::coordinates, Group::reference, Group::machine_coordinates,
                                Group::scaling,     Group::rotation,  Group::tool_change,
                                Group::lathe};
  for (const Group group : kRefused) {
    const bool tool_data = group == Group::reference && line_.code(group) == 100 && line_.value('L') == 1.0;
    if (line_.has(group) && !tool_data)
      return refuse_compensated(code_text(group == Group::tool_change ? 'M' : 'G', line_.code(group)),
                                line_.column(group));
  }
  if (line_.has(Group::motion) && line_.code(Group::motion) != kNoMotion && line_.code(Group::motion) > 30)
    return refuse_compensated(code_text('G', line_.code(Group::motion)), line_.column(Group::motion));
}

void Interpreter::refuse_compensated(std::string_view what, std::uint32_t column) {
  talker_.error(Code::compensation_refused, column,
                fmt::format("{} cannot stand while cutter compensation is on, which ends here", what),
                "put a G40 and a move away from the part before it");
  end_compensation();
}

/// A straight move with compensation.
void Interpreter::compensated_line(const Place& to, MoveKind kind, double feed) {
  const Piece piece{in_plane(here_.at), in_plane(to.at), std::nullopt, Turn::ccw};
  if (!(distance(piece.from, piece.to) > kNoWay)) return along_third_axis(to, kind, feed);
  const bool entry = !compensation_.entered;
  if (entry && distance(piece.from, piece.to) <= compensation_.radius)
    talker_.error(
        Code::compensation_entry, line_.column(),
        fmt::format("the first move of a cutter compensation must be longer than the tool's radius; "
                    "{:.4g} mm is not more than {:.4g} mm",
                    distance(piece.from, piece.to), compensation_.radius),
        "begin farther away from the part");
  const Piece axis = *offset(piece, compensation_.side, compensation_.radius);
  if (entry)
    compensation_.tool = piece.from;
  else if (!turn_corner(piece.from, axis, kind, feed))
    return;
  const Point2 from = compensation_.tool;
  compensation_.direction = piece.direction_at_end();
  add_compensated(moved_in_plane(to.at, axis.to), to, kind, feed);
  remember_piece({from, axis.to, std::nullopt, Turn::ccw});
}

/// The tool stays where it is beside the program's path.
void Interpreter::along_third_axis(const Place& to, MoveKind kind, double feed) {
  if (!compensation_.entered)
    talker_.unusual(
        Code::compensation_entry, line_.column(),
        "LinuxCNC wants a move in the plane to begin a cutter compensation; this one is left as it is");
  const Point3 at = compensation_.entered ? moved_in_plane(to.at, compensation_.tool) : to.at;
  add_compensated(at, to, kind, feed);
}

/// Leads the tool from the end of one piece to the begin of the next. False where no more steps are taken.
bool Interpreter::turn_corner(Point2 corner, const Piece& next, MoveKind kind, double feed) {
  Compensation& c = compensation_;
  Corner which = corner_between(c.direction, next.direction_at_begin(), c.side);
  if (which == Corner::cusp) which = corner_of_cusp(c.last, next, c.side);
  if (which == Corner::smooth) return true;
  if (which == Corner::inside) {
    retreat(corner, next);
    return true;
  }
  if (!runs_forward(c.last, c.direction, c.last.to)) tell_gouge();
  Place at = here_;
  at.at = moved_in_plane(here_.at, next.from);
  const Turn turn = c.side == Side::left ? Turn::cw : Turn::ccw;
  const Point2 centre = modes_.plane == Plane::xz ? Point2{corner.y, corner.x} : corner;
  const bool added = kind == MoveKind::rapid
                         ? add(step::Rapid{at.at})
                         : add(step::Arc{at.at, centre, modes_.plane, turn, 0, mm_per_min(feed)});
  if (!added) return false;
  arrive(at);
  here_.at = moved_in_plane(here_.at, corner);
  c.tool = next.from;
  return true;
}

/// Ends the last piece where the next one begins at an inside corner.
void Interpreter::retreat(Point2 corner, const Piece& next) {
  Compensation& c = compensation_;
  const std::optional<Point2> end = meeting(c.last, c.direction, next, corner);
  if (!end || !reachable({end->x, end->y, 0.0})) return tell_gouge();
  for (std::size_t i = c.last_step; i < path_.size(); ++i)
    if (path_[i].is_motion()) path_.set_end(i, moved_in_plane(path_[i].to(), *end));
  c.last.to = c.tool = *end;
}

void Interpreter::tell_gouge() {
  talker_.error(Code::compensation_gouge, line_.column(),
                fmt::format("a tool of radius {:.4g} mm does not fit into the inside corner before this line "
                            "without cutting into the part",
                            compensation_.radius),
                "use a thinner tool, or round the corner in the program");
}

/// An arc with compensation.
void Interpreter::compensated_arc(const Place& to, Point2 centre, Turn turn, int extra, Feed feed) {
  const Point2 middle = modes_.plane == Plane::xz ? Point2{centre.y, centre.x} : centre;
  const Piece piece{in_plane(here_.at), in_plane(to.at), middle, turn};
  Compensation& c = compensation_;
  const bool entry = !c.entered;
  std::optional<Piece> axis = entry ? entry_arc(piece, c.side, c.radius) : offset(piece, c.side, c.radius);
  const bool too_short = entry && distance(piece.from, piece.to) <= c.radius;
  if (too_short) axis.reset();
  if (!axis) {
    talker_.error(
        entry ? Code::compensation_entry : Code::compensation_gouge, line_.column(),
        fmt::format("{} {:.4g} mm is too small for a tool of radius {:.4g} mm; read as a straight cut",
                    entry ? "an arc that begins a cutter compensation with a radius of"
                          : "an arc that is cut from inside with a radius of",
                    piece.radius(), c.radius));
    return compensated_line(to, MoveKind::cut, feed.mm_per_min());
  }
  if (entry)
    c.tool = piece.from;
  else if (!turn_corner(piece.from, *axis, MoveKind::cut, feed.mm_per_min()))
    return;
  const Point2 from = c.tool;
  c.direction = piece.direction_at_end();
  const Point2 about = modes_.plane == Plane::xz ? Point2{axis->centre->y, axis->centre->x} : *axis->centre;
  const Point3 end = moved_in_plane(to.at, axis->to);
  if (!reachable(end) || !reachable({about.x, about.y, 0.0})) return;
  if (!add(step::Arc{end, about, modes_.plane, turn, extra, feed})) return;
  arrive(to);
  remember_piece({from, axis->to, axis->centre, turn});
}

void Interpreter::add_compensated(Point3 at, const Place& to, MoveKind kind, double feed) {
  if (!reachable(at)) return;
  const bool added = kind == MoveKind::rapid ? add(step::Rapid{at}) : add(step::Cut{at, mm_per_min(feed)});
  if (added) arrive(to);
}

void Interpreter::remember_piece(const Piece& piece) {
  compensation_.entered = true;
  compensation_.last = piece;
  compensation_.tool = piece.to;
  compensation_.last_step = path_.size() - 1;
}

}  // namespace kerf::gcode

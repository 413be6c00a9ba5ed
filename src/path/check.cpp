// The checks of a toolpath by itself: one small function per rule, applied to all motions in one pass.
#include "kerf/path/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <utility>

#include "base/codes/path.h"
#include "base/number.h"
#include "path/check_beam.h"

#include "kerf/path/report.h"

namespace kerf {
namespace {

constexpr int kShownDecimals = 4;
constexpr double kRounding = 1e-6;  // mm that rounding may move a position beyond a limit

/// Facts of the whole toolpath, and the state after the motions so far.
struct Setting {
  const CheckOptions& options;
  const Toolpath& path;
  bool touches = false;   // a probe's contact holds the tool: nothing has raised it since
  Box3 reached;           // in work coordinates, where the machine's travel allows it
  bool laser = false;     // the beam is the tool: no spindle needed
  bool printing = false;  // beads are laid: neither spindle nor tool needed
};

Setting setting_of(const Toolpath& path, const CheckOptions& options) {
  Setting setting{.options = options, .path = path, .reached = {}};
  for (const Step& s : path.steps()) {
    setting.laser = setting.laser || s.kind() == StepKind::laser_power;
    setting.printing = setting.printing || s.kind() == StepKind::extrude;
  }
  return setting;
}

bool needs_feed(const Step& s) {
  return s.is_cutting() || s.kind() == StepKind::probe || s.kind() == StepKind::extrude;
}

// ---- the rules: the message of a hazard, or nothing

using Message = std::optional<std::string>;

Message no_feed(const Step& s, const MotionContext&, Setting&) {
  if (!needs_feed(s) || s.feed().mm_per_min() != 0.0) return std::nullopt;
  return "a cut without a feed: no F is in effect, or it is F0";
}

Message negative_feed(const Step& s, const MotionContext&, Setting&) {
  if (!needs_feed(s) || s.feed().mm_per_min() >= 0.0) return std::nullopt;
  return fmt::format("a feed of {} mm/min; a feed must be above 0",
                     number_text(s.feed().mm_per_min(), kShownDecimals));
}

Message no_tool(const Step& s, const MotionContext& context, Setting& setting) {
  if (!s.is_cutting() || context.tool || setting.laser || setting.printing) return std::nullopt;
  return "a cut before the first tool change: the tool is unknown";
}

constexpr unsigned kAxisZ = 4, kAxesXY = 3;  // in masks of axes

Box3 box_of(const Step& s, const MotionContext& context) {
  Box3 box;
  box.add(s.to());
  if (s.kind() == StepKind::arc && context.unknown_from == 0) box.add(walk_of(s, context.from).bounds());
  return box;
}

const Tool* known_tool(std::optional<int> number, const Setting& setting) {
  return setting.options.tools != nullptr && number ? setting.options.tools->find(*number) : nullptr;
}

/// Radius of the tool, mm; 0 if unknown.
double radius_of(std::optional<int> number, const Setting& setting) {
  const Tool* tool = known_tool(number, setting);
  return tool != nullptr ? 0.5 * tool->diameter.mm() : 0.0;
}

/// Whether a tool whose tip is somewhere in the box can be in the stock's block; true without a stock.
bool can_be_in_stock(const Box3& tip, double radius, const Setting& setting) {
  if (!setting.options.stock) return true;
  const Box3& stock = *setting.options.stock;
  return tip.low.z < stock.high.z - kRounding && tip.low.x <= stock.high.x + radius &&
         tip.high.x >= stock.low.x - radius && tip.low.y <= stock.high.y + radius &&
         tip.high.y >= stock.low.y - radius;
}

Message spindle_off(const Step& s, const MotionContext& context, Setting& setting) {
  if (!s.is_cutting() || setting.laser || setting.printing) return std::nullopt;
  if (context.spindle.turn != SpindleTurn::off) return std::nullopt;  // 0 rpm: the speed is set manually
  if (setting.options.manual_spindle && !context.spindle_stated) return std::nullopt;
  if ((s.unknown_axes() | context.unknown_from) == 0) {
    Box3 way = box_of(s, context);
    way.add(context.from);
    if (!can_be_in_stock(way, radius_of(context.tool, setting), setting)) return std::nullopt;
  }
  if (!context.spindle_stated) return "a cut, and the program has not started the spindle";
  return "a cut while the spindle is stopped";
}

Message arc_radii(const Step& s, const MotionContext& context, Setting& setting) {
  if (s.kind() != StepKind::arc) return std::nullopt;
  const ArcWalk walk = walk_of(s, context.from);
  if (setting.options.arc_radii.permits(walk.start_radius, walk.end_radius)) return std::nullopt;
  return fmt::format("an arc that starts {} mm from its centre and ends {} mm from it: controllers refuse it",
                     number_text(walk.start_radius, kShownDecimals),
                     number_text(walk.end_radius, kShownDecimals));
}

/// The ends of an axis' travel in work coordinates. Without a work zero, the ends that the motions so far
/// permit.
AxisTravel open_travel(const AxisTravel& travel, const Setting& setting, int axis) {
  if (const auto& zero = setting.options.machine->work_zero)
    return {travel.low - (*zero)[axis], travel.high - (*zero)[axis]};
  if (setting.reached.low[axis] > setting.reached.high[axis])
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  return {setting.reached.high[axis] - travel.length(), setting.reached.low[axis] + travel.length()};
}

/// The exceeded limit: an end of the travel if the position in machine coordinates is known (`zero` is that
/// of the work), otherwise its length.
std::string message_outside(const Box3& box, const AxisTravel& travel, const std::optional<Point3>& zero,
                            int axis) {
  const auto text = [](double v) { return number_text(v, kShownDecimals); };
  const char name = "XYZ"[axis];
  if (!zero)
    return fmt::format(
        "outside of the machine's travel: its {} axis is {} mm long, and the motions so far span more", name,
        text(travel.length()));
  const double low = box.low[axis] + (*zero)[axis], high = box.high[axis] + (*zero)[axis];
  const bool above = high > travel.high + kRounding;
  return fmt::format(
      "outside of the machine's travel: {}{} in machine coordinates, {} the end of the axis at {}", name,
      text(above ? high : low), above ? "above" : "below", text(above ? travel.high : travel.low));
}

/// Axes of the motion's end that are given in machine coordinates.
unsigned machine_axes(const Step& s) { return s.reference() == Reference::machine ? s.reference_axes() : 0u; }

Message outside_machine(const Step& s, const MotionContext& context, Setting& setting) {
  if (setting.options.machine == nullptr) return std::nullopt;
  const Box3 box = box_of(s, context);
  Message message;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& travel = setting.options.machine->travel[static_cast<std::size_t>(axis)];
    const bool in_machine = (machine_axes(s) >> axis & 1u) != 0;
    if (!travel || (!in_machine && (s.unknown_axes() >> axis & 1u) != 0)) continue;
    const AxisTravel open = in_machine ? *travel : open_travel(*travel, setting, axis);
    const bool longer = box.high[axis] - box.low[axis] > travel->length() + kRounding;
    if (longer || box.low[axis] < open.low - kRounding || box.high[axis] > open.high + kRounding) {
      message =
          message_outside(box, *travel, in_machine ? Point3{} : setting.options.machine->work_zero, axis);
      continue;
    }
    if (in_machine) continue;
    setting.reached.low[axis] = std::min(setting.reached.low[axis], box.low[axis]);
    setting.reached.high[axis] = std::max(setting.reached.high[axis], box.high[axis]);
  }
  return message;
}

/// Whether a motion goes straight down, also from an unknown height.
bool goes_down(const Step& s, const MotionContext& context) {
  const Point3 way = s.to() - context.from;
  for (int axis = 0; axis < 2; ++axis)
    if (((s.unknown_axes() ^ context.unknown_from) >> axis & 1u) != 0 || way[axis] != 0.0) return false;
  if ((s.unknown_axes() & kAxisZ) != 0) return false;
  return (context.unknown_from & kAxisZ) != 0 || way.z < 0.0;
}

/// Whether the tool at `at` is, or may be, in the stock's block; false without a stock.
bool may_be_in_stock(Point3 at, unsigned unknown, const MotionContext& context, const Setting& setting) {
  if (!setting.options.stock || setting.laser || setting.printing) return false;
  if ((unknown & kAxisZ) != 0 || at.z >= setting.options.stock->high.z - kRounding) return false;
  Box3 tip;
  tip.add(at);
  return (unknown & kAxesXY) != 0 || can_be_in_stock(tip, radius_of(context.tool, setting), setting);
}

Message plunge(const Step& s, const MotionContext& context, Setting& setting) {
  if (s.kind() != StepKind::cut || !goes_down(s, context)) return std::nullopt;
  if (setting.options.stock && !may_be_in_stock(s.to(), s.unknown_axes(), context, setting))
    return std::nullopt;
  const Tool* tool = known_tool(context.tool, setting);
  if (tool == nullptr || tool->plunges) return std::nullopt;
  return fmt::format("tool {} does not cut at its centre, and plunges here", *context.tool);
}

/// Where such a motion ends is unknown, so the material on its way cannot be examined.
Message machine_move_low(const Step& s, const MotionContext& context, Setting& setting) {
  if (s.reference() == Reference::work || (s.reference_axes() & kAxesXY) == 0) return std::nullopt;
  if (!may_be_in_stock(context.from, context.unknown_from, context, setting)) return std::nullopt;
  return fmt::format(
      "a motion to a machine position starts at Z {}, below the stock's top, and moves sideways",
      number_text(context.from.z, kShownDecimals));
}

Message rapid_unknown(const Step& s, const MotionContext& context, Setting& setting) {
  const unsigned unknown = s.unknown_axes();
  if (s.kind() != StepKind::rapid || (unknown & kAxesXY) == 0) return std::nullopt;
  const bool down = (context.unknown_from & kAxisZ) != 0 || s.to().z < context.from.z;
  if (!down || !may_be_in_stock(s.to(), unknown, context, setting)) return std::nullopt;
  return fmt::format("a rapid down to Z {}, below the stock's top, where X or Y is unknown",
                     number_text(s.to().z, kShownDecimals));
}

Message chip_load(const Step& s, const MotionContext& context, Setting& setting) {
  const Material* material = setting.options.material;
  const Tool* tool = known_tool(context.tool, setting);
  const double speed = context.spindle.speed.rpm();
  const bool is_limit = context.spindle.surface_speed > Feed{};
  const bool turns = context.spindle.turn != SpindleTurn::off && speed > 0.0 && !is_limit;
  if (!s.is_cutting() || material == nullptr || tool == nullptr || !turns || tool->teeth < 1)
    return std::nullopt;
  const Length load = s.feed() / context.spindle.speed / static_cast<double>(tool->teeth);
  const Length highest = highest_chip_load(*material, tool->diameter);
  if (load <= highest) return std::nullopt;
  return fmt::format("{} mm per tooth ({} mm/min, {} rpm, {}): the maximum of a tool of {} mm in {} is {} mm",
                     number_text(load.mm(), kShownDecimals), number_text(s.feed().mm_per_min(), 1),
                     number_text(speed, 0), teeth_text(*tool), number_text(tool->diameter.mm(), 3),
                     material->name, number_text(highest.mm(), kShownDecimals));
}

/// A tool that has touched the work from above scrapes over it, or breaks its probe.
Message sideways_in_contact(const Step& s, const MotionContext& context, Setting& setting) {
  const Point3 way = s.to() - context.from;
  const bool sideways = way.x != 0.0 || way.y != 0.0;
  const bool touched = std::exchange(setting.touches, false);
  if (s.kind() == StepKind::probe) {
    const bool on_contact =
        s.probe().kind == ProbeKind::contact || s.probe().kind == ProbeKind::contact_or_error;
    setting.touches = on_contact && !sideways && way.z < 0.0;
    return std::nullopt;
  }
  if (!touched || way.z > 0.0 || s.reference() != Reference::work) return std::nullopt;
  setting.touches = !sideways;
  if (!sideways) return std::nullopt;
  return "the tool touches the work where a probe has ended, and moves sideways";
}

/// Whether a thread or a tap ties the motion to the spindle.
bool is_locked(const MotionContext& context, const Setting& setting) {
  const MotionExtra* extra = setting.path.extra(context.index);
  return extra != nullptr && extra->lock != SpindleLock::none;
}

/// No tool advances by its own diameter in a turn: F was meant in another feed mode, or S in another unit.
Message feed_per_turn(const Step& s, const MotionContext& context, Setting& setting) {
  constexpr Length kSmallest = mm(1);  // engraving tools are thin
  const Tool* tool = known_tool(context.tool, setting);
  const SpindleSpeed speed = context.spindle.speed;
  const bool turns = context.spindle.turn != SpindleTurn::off && speed > SpindleSpeed{} &&
                     !(context.spindle.surface_speed > Feed{});
  if (!s.is_cutting() || tool == nullptr || !turns || is_locked(context, setting)) return std::nullopt;
  const Length advance = s.feed() / speed;
  if (advance <= std::max(tool->diameter, kSmallest)) return std::nullopt;
  return fmt::format("a feed of {} mm in a turn of the spindle: more than the diameter of tool {}",
                     number_text(advance.mm(), kShownDecimals), *context.tool);
}

/// Mills and drills cut clockwise, seen from above; only taps and threads turn both ways.
Message wrong_turn(const Step& s, const MotionContext& context, Setting& setting) {
  if (!s.is_cutting() || setting.laser || context.spindle.turn != SpindleTurn::ccw) return std::nullopt;
  if (is_locked(context, setting)) return std::nullopt;
  return "a cut with the spindle turning counter-clockwise (M4): mills and drills cut clockwise (M3)";
}

struct Rule {
  Code code;
  Message (*test)(const Step&, const MotionContext&, Setting&);
  std::string_view hint;
};
constexpr Rule kRules[] = {
    {codes::path_no_feed, no_feed, "add an F word before the first cut"},
    {codes::path_negative_feed, negative_feed, "remove the sign of the feed"},
    {codes::path_no_tool, no_tool,
     "add a tool change (T1 M6), or specify the tool with --tool SPEC, without a number"},
    {codes::path_spindle_off, spindle_off, "start the spindle (S10000 M3) before the cut"},
    {codes::path_arc_radii, arc_radii, "write the arc's end and centre with more decimals"},
    {codes::path_outside_machine, outside_machine, "move the work zero, or turn or split the part"},
    {codes::path_plunge, plunge, "ramp or spiral into the cut, or drill that position first"},
    {codes::path_machine_move_low, machine_move_low, "retract (G0 Z...) before it"},
    {codes::path_rapid_unknown, rapid_unknown, "move to a known X and Y first"},
    {codes::path_chip_load, chip_load, "lower the feed or raise the spindle speed"},
    {codes::path_sideways_in_contact, sideways_in_contact, "raise the tool before it moves on"},
    {codes::path_feed_per_turn, feed_per_turn, "check F with the feed mode (G94, G95) and S"},
    {codes::path_wrong_turn, wrong_turn, "start the spindle with M3, unless the tool is left-handed"},
};

// ---- the rules for steps without motion

using StepMessage = std::optional<PathHazard>;

StepMessage spindle_range(const Step& s, const Setting& setting) {
  const Machine* machine = setting.options.machine;
  if (s.kind() != StepKind::spindle || machine == nullptr || s.spindle().turn == SpindleTurn::off)
    return std::nullopt;
  if (s.spindle().surface_speed > Feed{}) return std::nullopt;  // the controller keeps to its own limits
  const SpindleSpeed speed = s.spindle().speed;
  const bool slow = machine->slowest_spindle && speed < *machine->slowest_spindle;
  const bool fast = machine->fastest_spindle && speed > *machine->fastest_spindle;
  if (!slow && !fast) return std::nullopt;
  const SpindleSpeed limit = slow ? *machine->slowest_spindle : *machine->fastest_spindle;
  PathHazard hazard;
  hazard.code = codes::path_spindle_range;
  hazard.message = fmt::format("{} rpm; the machine's spindle has {} {}", number_text(speed.rpm(), 1),
                               slow ? "at least" : "at most", number_text(limit.rpm(), 1));
  hazard.hint = "change S, and the feed in proportion";
  return hazard;
}

/// The position of the tool between two motions.
struct Rest : PathPosition {
  std::optional<int> tool;
  bool spindle_on = false;
};

/// Depth of the tip below the stock's top, mm, if the tool is in the stock's block, or may be there because X
/// or Y is unknown.
std::optional<double> depth_in_stock(const Rest& rest, const Setting& setting) {
  const auto& stock = setting.options.stock;
  if (!stock || (rest.unknown & kAxisZ) != 0 || setting.laser || setting.printing) return std::nullopt;
  if (rest.at.z >= stock->high.z || rest.at.z < stock->low.z) return std::nullopt;
  Box3 tip;
  tip.add(rest.at);
  if (rest.unknown == 0 && !can_be_in_stock(tip, radius_of(rest.tool, setting), setting)) return std::nullopt;
  return stock->high.z - rest.at.z;
}

StepMessage low_tool_change(const Step& s, const Setting& setting, const Rest& rest) {
  if (s.kind() != StepKind::tool_change) return std::nullopt;
  const auto depth = depth_in_stock(rest, setting);
  if (!depth) return std::nullopt;
  PathHazard hazard;
  hazard.code = codes::path_tool_change_low;
  hazard.message = fmt::format("the tool is changed at Z {}, {} mm below the stock's top",
                               number_text(rest.at.z, kShownDecimals), number_text(*depth, kShownDecimals));
  hazard.hint = "retract (G0 Z...) before the tool change";
  return hazard;
}

/// The hazard of a spindle stop or program end with the tool in the stock.
StepMessage low_stop(const Rest& rest, const Setting& setting, std::string_view what) {
  const auto depth = rest.spindle_on ? depth_in_stock(rest, setting) : std::nullopt;
  if (!depth) return std::nullopt;
  PathHazard hazard;
  hazard.code = codes::path_stop_low;
  hazard.message = fmt::format("{} at Z {}, with the tool {} mm deep in the stock", what,
                               number_text(rest.at.z, kShownDecimals), number_text(*depth, kShownDecimals));
  hazard.hint = "retract (G0 Z...) before that";
  return hazard;
}

StepMessage low_spindle_stop(const Step& s, const Setting& setting, const Rest& rest) {
  if (s.kind() != StepKind::spindle || s.spindle().turn != SpindleTurn::off) return std::nullopt;
  return low_stop(rest, setting, "the spindle stops");
}

void follow(const Step& s, Rest& rest) {
  rest.pass(s);
  if (s.kind() == StepKind::tool_change) rest.tool = s.tool_change().tool;
  if (s.kind() == StepKind::spindle) rest.spindle_on = s.spindle().turn != SpindleTurn::off;
}

void check_other_steps(const Toolpath& path, const Setting& setting, std::vector<PathHazard>& found) {
  Rest rest;
  const auto keep = [&](StepMessage message, std::size_t step) {
    if (!message) return;
    message->step = static_cast<std::uint32_t>(step);
    message->at = rest.at;
    found.push_back(std::move(*message));
  };
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& s = path[i];
    keep(spindle_range(s, setting), i);
    keep(low_tool_change(s, setting, rest), i);
    keep(low_spindle_stop(s, setting, rest), i);
    follow(s, rest);
  }
  if (path.size() > 0) keep(low_stop(rest, setting, "the program ends"), path.size() - 1);
  for (PathHazard& hazard : check_beam(path, setting.options)) found.push_back(std::move(hazard));
  std::stable_sort(found.begin(), found.end(),
                   [](const PathHazard& a, const PathHazard& b) { return a.step < b.step; });
}

constexpr double kTravel = 1e-3;  // mm sideways from which on a rapid is a travel

/// Heights of cuts, and of rapids between positions.
struct Levels {
  Range cuts, rapids;
  std::size_t highest_rapid = 0;  // step
};

Levels levels_of(const Toolpath& path) {
  Levels levels;
  for_each_motion(path, [&](const Step& s, const MotionContext& context) {
    if (((s.unknown_axes() | context.unknown_from) & kAxisZ) != 0) return;
    const Point3 way = s.to() - context.from;
    if (s.is_cutting()) {
      levels.cuts.add(s.to().z);
    } else if (s.kind() == StepKind::rapid && std::hypot(way.x, way.y) > kTravel) {
      if (s.to().z > levels.rapids.high) levels.highest_rapid = context.index;
      levels.rapids.add(s.to().z);
    }
  });
  return levels;
}

/// "Z -5 to 3"
std::string heights_text(const Range& range) {
  const std::string low = number_text(range.low, kShownDecimals);
  if (range.low == range.high) return "Z " + low;
  return fmt::format("Z {} to {}", low, number_text(range.high, kShownDecimals));
}

/// Whether a motion takes part in runs of a rule: rapids between cuts do not end a run of cuts.
bool ends_runs(const Step& s) { return needs_feed(s); }

}  // namespace

std::string_view kind_of(const PathHazard& hazard) {
  constexpr std::string_view kPrefix = "path_";  // distinguishes these codes from those of readers
  return name_of(hazard.code).substr(kPrefix.size());
}

std::optional<PathHazard> find_z_downwards(const Toolpath& path) {
  if (path.has(StepKind::extrude)) return std::nullopt;  // the table is below the rapids of a print
  const Levels levels = levels_of(path);
  if (levels.cuts.empty() || levels.rapids.empty()) return std::nullopt;
  const bool below = levels.rapids.high <= levels.cuts.low + kRounding &&
                     levels.rapids.low < levels.cuts.low - kRounding &&
                     levels.cuts.high > levels.rapids.high + kRounding;
  if (!below) return std::nullopt;
  PathHazard hazard;
  hazard.code = codes::path_z_downwards;
  hazard.step = static_cast<std::uint32_t>(levels.highest_rapid);
  hazard.at = path[levels.highest_rapid].to();
  hazard.message = fmt::format(
      "the program seems to count Z downwards: its rapids run at {}, its cuts at {}; with Z upwards, "
      "as usual, the rapids go through the stock",
      heights_text(levels.rapids), heights_text(levels.cuts));
  hazard.hint = "regenerate the program with positive Z upwards (a setting of the CAM program)";
  return hazard;
}

std::vector<PathHazard> check_path(const Toolpath& path, const CheckOptions& options) {
  Setting setting = setting_of(path, options);
  std::vector<PathHazard> found;
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::array<std::size_t, std::size(kRules)> open;  // the entry of each rule that the next motion may join
  open.fill(kNone);
  for_each_motion(path, [&](const Step& s, const MotionContext& context) {
    for (std::size_t r = 0; r < open.size(); ++r) {
      Message message = kRules[r].test(s, context, setting);
      if (!message) {
        if (ends_runs(s)) open[r] = kNone;
      } else if (open[r] != kNone && found[open[r]].message == *message) {
        ++found[open[r]].steps;
      } else {
        open[r] = found.size();
        found.push_back({kRules[r].code, static_cast<std::uint32_t>(context.index), 1, s.to(),
                         std::move(*message), std::string(kRules[r].hint)});
      }
    }
  });
  if (auto downwards = find_z_downwards(path)) found.push_back(std::move(*downwards));
  check_other_steps(path, setting, found);
  if (options.end == ProgramEnd::missing && path.size() > 0) {
    const auto last = static_cast<std::uint32_t>(path.size() - 1);
    Point3 at;
    for_each_motion(path, [&](const Step& s, const MotionContext&) { at = s.to(); });
    found.push_back({codes::path_no_program_end, last, 1, at,
                     "the program ends here without M2, M30 or a closing %: the file may be truncated",
                     "check the end of the file, and add M2 there"});
  }
  return found;
}

}  // namespace kerf

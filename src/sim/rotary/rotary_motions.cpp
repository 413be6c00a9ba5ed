// Reads the motions of a toolpath for the rotary simulator.
#include "sim/rotary/rotary_motions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

#include "base/codes/sim.h"
#include "sim/sweep/solid.h"

namespace kerf::sim {
namespace {

constexpr double kMaxPositions = 1e8;  // a run of hours
constexpr double kPieceTurn = std::numbers::pi / 6.0;
constexpr double kPieceRays = 4.0;           // pieces are at least as long as this many distances of rays
constexpr Length kProfileChord = mm(0.001);  // frusta for arcs of a tool
constexpr Length kArcChord = mm(0.002);      // chords for arcs of the path
constexpr double kClearance = 1e-4;          // mm, shallower sideways contacts are rounding

RotaryTool make_rotary_tool(const Silhouette& tool) {
  RotaryTool out;
  const Length none, clearance = mm(kClearance);
  out.cutting = Frusta(tool.cutting, kProfileChord, none);
  const Silhouette whole = held(tool);
  const Profile* parts[] = {&whole.cutting, &whole.neck, &whole.shank, &whole.holder};
  for (int k = 0; k < 4; ++k) out.touching[k] = Frusta(*parts[k], kProfileChord, clearance);
  out.over_flute = Frusta(radius_above_flutes(tool) - kClearance, out.cutting.top(), kAboveAll);
  return out;
}

}  // namespace

RotaryMotion RotaryMotion::piece(int number) const {
  if (pieces == 1) return *this;
  const double low = static_cast<double>(number) / pieces, high = (number + 1.0) / pieces;
  RotaryMotion part = *this;
  part.from = at(low);
  part.to = at(high);
  part.turn_from = turn(low);
  part.turn_to = turn(high);
  part.start_fraction = fraction(low);
  part.end_fraction = fraction(high);
  part.pieces = 1;
  part.continues = continues || number > 0;
  return part;
}

bool RotaryMotionReader::run() {
  bool has_spindle = false, has_laser = false;
  for (const Step& step : path_.steps()) {
    has_spindle = has_spindle || step.kind() == StepKind::spindle;
    has_laser = has_laser || step.kind() == StepKind::laser_power;
  }
  judges_spindle_ = has_spindle && !has_laser;
  const std::size_t errors = diagnostics_.errors();
  for_each_motion(path_, [&](const Step& step, const MotionContext& context) { add(step, context); });
  if (positions_ > kMaxPositions)
    diagnostics_
        .error(codes::rotary_limit, {},
               fmt::format("the job needs {:.0f} tool positions; the limit is {:.0f}", positions_,
                           kMaxPositions))
        .hint = "use a coarser resolution";
  return diagnostics_.errors() == errors;
}

double RotaryMotionReader::turn_at(const MotionExtra* extra, const MotionContext& context) {
  if (extra == nullptr || !extra->abc) return turn_;
  const auto& abc = *extra->abc;
  if ((abc[1] != 0.0 || abc[2] != 0.0) && !std::exchange(reported_other_axes_, true))
    diagnostics_.warning(codes::rotary_not_simulated, path_.origin_of(context.index),
                         "the axes B and C are not simulated; only A turns the bar");
  return degrees(abc[0]).rad();
}

std::optional<std::uint32_t> RotaryMotionReader::tool_of(const Step& step, const MotionContext& context) {
  std::optional<int> number = context.tool;
  if (!number && table_.tools().size() == 1) number = table_.tools().begin()->first;
  if (!number) {
    if (step.is_cutting() && !std::exchange(reported_no_tool_, true))
      diagnostics_.error(codes::no_tool_chosen, path_.origin_of(context.index),
                         "cut before the first tool change");
    return std::nullopt;
  }
  if (const auto it = index_.find(*number); it != index_.end()) return it->second;
  const Tool* tool = table_.find(*number);
  if (tool == nullptr) {
    if (step.is_cutting() && !std::exchange(reported_missing_[*number], true))
      diagnostics_.error(codes::no_such_tool, path_.origin_of(context.index),
                         fmt::format("tool {} cuts here, but has no shape", *number));
    return std::nullopt;
  }
  const auto index = static_cast<std::uint32_t>(tools.size());
  tools.push_back(make_rotary_tool(tool->silhouette));
  return index_[*number] = index;
}

void RotaryMotionReader::push(RotaryMotion motion) {
  if (!(length(motion.from) < kMaxReach) || !(length(motion.to) < kMaxReach)) {
    diagnostics_.error(codes::motion_out_of_range, path_.origin_of(motion.step),
                       "the motion goes too far from the work zero");
    return;
  }
  const double way =
      std::max(distance(motion.from, motion.to), std::abs(motion.turned()) * 0.5 * bar_.diameter);
  positions_ += std::ceil(2.0 * way / ray_distance_) + 1.0;
  const double piece = std::max(2.0 * tools[motion.tool].cutting.rim(), kPieceRays * ray_distance_);
  const double count = std::max(std::ceil(way / piece), std::ceil(std::abs(motion.turned()) / kPieceTurn));
  motion.pieces = static_cast<int>(std::clamp(count, 1.0, kMaxPositions));
  if (!motions.empty()) {
    const RotaryMotion& last = motions.back();
    motion.continues = last.tool == motion.tool && last.cuts == motion.cuts && last.to == motion.from &&
                       last.turn_to == motion.turn_from;
  }
  motions.push_back(motion);
}

void RotaryMotionReader::add(const Step& step, const MotionContext& context) {
  const double turn_from = turn_;
  turn_ = turn_at(path_.extra(context.index), context);
  if (step.kind() == StepKind::probe || step.kind() == StepKind::extrude) return;
  const auto tool = tool_of(step, context);
  if (!tool) return;
  RotaryMotion motion;
  motion.from = context.from;
  motion.to = step.to();
  motion.turn_from = turn_from;
  motion.turn_to = turn_;
  motion.step = static_cast<std::uint32_t>(context.index);
  motion.tool = *tool;
  motion.cuts = step.is_cutting();
  motion.spindle_off = judges_spindle_ && spindle_stopped(context);
  // Motions to unknown positions neither cut nor are reported, as in the simulator for three axes.
  constexpr unsigned kZ = 4;
  if ((step.unknown_axes() & kZ) != 0 || (!motion.cuts && step.unknown_axes() != 0)) return;
  if ((context.unknown_from & kZ) != 0)
    motion.from.z = std::max(motion.to.z, bar_.axis_z + 0.5 * bar_.diameter);
  const bool walked = step.kind() == StepKind::arc && is_walked(context);
  const unsigned needed = motion.cuts ? 3u : 7u;  // a rapid is only certain at its end
  if ((context.unknown_from & needed) != 0 && !walked)
    motion.from = {motion.to.x, motion.to.y, motion.from.z};
  if (!walked) return push(motion);
  const ArcWalk walk = walk_of(step, context.from);
  const int count = walk.chords(kArcChord);
  for (int k = 0; k < count; ++k) {
    RotaryMotion chord = motion;
    chord.start_fraction = static_cast<double>(k) / count;
    chord.end_fraction = (k + 1.0) / count;
    chord.from = walk.at(chord.start_fraction);
    chord.to = walk.at(chord.end_fraction);
    chord.turn_from = turn_from + chord.start_fraction * (turn_ - turn_from);
    chord.turn_to = turn_from + chord.end_fraction * (turn_ - turn_from);
    push(chord);
  }
}

}  // namespace kerf::sim

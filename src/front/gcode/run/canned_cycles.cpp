// The words of canned cycles G73, G74 and G81 to G89; kerf/op/holes.h computes their motions.
#include "front/gcode/run/canned_cycles.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

#include "base/codes/gcode.h"

#include "kerf/base/limits.h"

namespace kerf::gcode {
namespace {

DrillKind kind_of(Tenths cycle) {
  switch (cycle) {
    case 730: return DrillKind::chip_break;
    case 740: return DrillKind::left_tap;
    case 820: return DrillKind::dwell;
    case 830: return DrillKind::peck;
    case 840: return DrillKind::tap;
    case 850: return DrillKind::bore;
    case 860: return DrillKind::stopped_bore;
    case 870: return DrillKind::back_bore;
    case 880: return DrillKind::manual_bore;
    case 890: return DrillKind::dwell_bore;
    default: return DrillKind::plain;
  }
}

// Words that a cycle needs besides R and the bottom.
bool needs_dwell(Tenths cycle) { return cycle == 820 || cycle == 860 || cycle == 880 || cycle == 890; }
bool takes_dwell(Tenths cycle) { return needs_dwell(cycle) || cycle == 740 || cycle == 840; }
constexpr std::uint32_t kFirstAndLess = LineWords::bit('I') | LineWords::bit('J');  // pecks, on Haas

bool needs_peck(Tenths cycle) { return cycle == 730 || cycle == 830; }

}  // namespace

/// Adds the motions of a cycle to the path.
class CannedCycles::CycleSink final : public DrillSink {
 public:
  /// `at_holes` has the axes that are unknown at the holes.
  CycleSink(CannedCycles& cycles, const DrillCycle& cycle, const ToolPosition& at_holes, double feed)
      : cycles_(cycles), next_(at_holes), at_holes_(at_holes), feed_(feed) {
    if (cycle.kind == DrillKind::tap || cycle.kind == DrillKind::left_tap) lock_ = SpindleLock::tap;
    if (!rises_first(cycle)) return;
    const unsigned third = 1u << axes_of(cycle.plane).w;
    next_.unknown = (cycles.position_.unknown & ~third) | (at_holes.unknown & third);
    next_.reference_axes = 0;
  }
  void rapid(Point3 to) override { cycles_.mover_.rapid(position_of(to)); }
  void cut(Point3 to) override { cycles_.mover_.tapping_cut(position_of(to), feed_, lock_); }
  void dwell(Duration time) override { cycles_.add(step::Dwell{time}); }
  void spindle(SpindleTurn turn) override { cycles_.spindle_.turn(turn); }
  void pause() override { cycles_.add(step::Pause{}); }
  bool is_full() const override { return cycles_.steps_.full(); }

 private:
  ToolPosition position_of(Point3 to) {
    ToolPosition position = next_;
    position.at = to;
    next_ = at_holes_;
    return position;
  }
  CannedCycles& cycles_;
  ToolPosition next_;            // of the next motion
  const ToolPosition at_holes_;  // after the first motion
  double feed_;                  // mm/min
  SpindleLock lock_ = SpindleLock::none;
};

/// Takes the words of a cycle; false with an error if it cannot run.
bool CannedCycles::start(Tenths motion) {
  if (cycle_.motion != motion) {
    // Another cycle of the series inherits only the level at the start of the series.
    const std::optional<double> level = cycle_.start_level;
    cycle_ = {};
    cycle_.motion = motion;
    cycle_.start_level = level;
  }
  if (refuse_pecks(motion) || !take_words(motion)) {
    line_.use(kAllLetters);
    return false;
  }
  report_wrong_turn(motion);
  return true;
}

void CannedCycles::cycle(Tenths motion) {
  if (!start(motion)) return;
  const int holes = repeats();
  if (holes == 0) return line_.use(kAllLetters);
  ToolPosition to;
  std::optional<DrillCycle> cycle = plan(motion, to);
  if (!cycle) return;
  cycle->holes = reachable_holes(*cycle, holes);
  if (cycle->holes == 0 || !room_for(min_steps(*cycle))) return;
  mover_.set_named(0);
  const bool polar = line_.polar_radius() || line_.polar_angle();
  if (polar && !modes_.absolute && cycle->holes > 1) return repeat_on_circle(*cycle, to);
  CycleSink sink(*this, *cycle, to, feeds_.cycle_feed());
  expand(*cycle, position_.at, sink);
}

/// I is the radius about the position or X and Y, J the angle of the first hole, L the number of holes, K the
/// angle between the holes of an arc. Source: Haas, Mill Operator's Manual, "G70 Bolt Hole Circle", "G71 Bolt
/// Hole Arc".
void CannedCycles::pattern(Tenths code, Tenths motion) {
  const auto refuse = [&](std::string_view what) {
    reporter_.error(codes::word_out_of_range, line_.column(Group::reference),
                    fmt::format("{} {}; the line is skipped", code_text('G', code), what));
    line_.use(kAllLetters);
  };
  if (!is_cycle(motion)) return refuse("needs a drilling cycle (G81 to G89)");
  if (modes_.plane != Plane::xy) return refuse("is read in the XY plane only");
  const double radius = line_.take('I').value_or(0.0) * modes_.scale;
  const double first = line_.take('J').value_or(0.0), count = line_.take('L').value_or(0.0);
  const bool is_whole = count == std::floor(count) && count >= 1.0 && count <= limits::kMaxHoles;
  if (!is_whole || !(radius > 0.0)) return refuse("needs I, a radius, and L, the number of holes");
  const double spacing = code == 700 ? 360.0 / count : line_.take('K').value_or(0.0);
  if (!start(motion)) return;
  ToolPosition to;
  std::optional<DrillCycle> cycle = plan(motion, to);
  if (!cycle) return;
  mover_.set_named(0);
  const double feed = feeds_.cycle_feed();
  const Point3 centre = coordinates_.frame().to_program(cycle->at);
  cycle->increment = {};
  for (double i = 0.0; i < count && !steps_.full(); i += 1.0) {
    const double angle = (first + i * spacing) * std::numbers::pi / 180.0;
    cycle->at = coordinates_.frame().to_path(
        {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle), centre.z});
    if (!reachable(cycle->at) || !room_for(min_steps(*cycle))) return;
    CycleSink sink(*this, *cycle, to, feed);
    expand(*cycle, position_.at, sink);
    cycle->start_level = std::max(cycle->start_level, cycle->retract_plane);
  }
}

/// Repeats of incremental polar words: each hole has another radius and angle, not another X and Y.
void CannedCycles::repeat_on_circle(DrillCycle cycle, const ToolPosition& to) {
  const double feed = feeds_.cycle_feed();
  for (int left = std::exchange(cycle.holes, 1); left > 0 && !steps_.full(); --left) {
    CycleSink sink(*this, cycle, to, feed);
    expand(cycle, position_.at, sink);
    cycle.start_level = std::max(cycle.start_level, cycle.retract_plane);
    const Point3 hole = coordinates_.frame().to_program(cycle.at);
    const double radius = std::hypot(hole.x, hole.y) + mover_.polar_step().first;
    const double angle = std::atan2(hole.y, hole.x) + mover_.polar_step().second * std::numbers::pi / 180.0;
    cycle.at = coordinates_.frame().to_path({radius * std::cos(angle), radius * std::sin(angle), hole.z});
    if (!reachable(cycle.at)) return;
  }
}

/// mm of a unit of Q. Without a decimal point it counts 0.001 mm or 0.0001 inch on Fanuc's and Haas'
/// controls; fewer than 100 of them are no peck, but the number of a control set to read X10 as 10 mm.
double CannedCycles::unit_of_peck() {
  constexpr double kMinIncrements = 100.0, kMm = 0.001, kInch = 0.0001;
  if (!is_fanuc(program_.dialect) || !line_.is_integer_text('Q')) return modes_.scale;
  if (line_.value('Q') >= kMinIncrements) return modes_.scale == 1.0 ? kMm : kInch * modes_.scale;
  reporter_.note(
      codes::word_out_of_range, line_.column('Q'),
      "Q without a decimal point is too small to count thousandths; read in the unit of the program");
  return modes_.scale;
}

/// Takes R, the bottom, P and Q, which are modal within a cycle.
bool CannedCycles::take_words(Tenths motion) {
  const PlaneAxes axes = axes_of(modes_.plane);
  const auto take = [this](std::optional<double>& stored, char letter, double scale) {
    if (const auto value = line_.take(letter)) stored = *value * scale;
  };
  const char bottom_letter = static_cast<char>('X' + axes.w);
  if (line_.unused('R')) cycle_.is_plane_measured = (line_.unknown_letters() & LineWords::bit('R')) != 0;
  take(cycle_.r, 'R', modes_.scale);
  take(cycle_.bottom, bottom_letter, modes_.scale);
  if (takes_dwell(motion)) take(cycle_.dwell, 'P', dwells_.seconds_of_p(1.0));
  if (needs_peck(motion)) take(cycle_.peck, 'Q', unit_of_peck());
  if (needs_peck(motion) && program_.dialect == GcodeDialect::haas && line_.has_unused(kFirstAndLess)) {
    take(cycle_.peck, 'I', modes_.scale);
    take(cycle_.peck_less, 'J', modes_.scale);
    take(cycle_.peck_least, 'K', modes_.scale);
  }
  if (motion == 870) {
    take(cycle_.aside_u, static_cast<char>('I' + axes.u), modes_.scale);
    take(cycle_.aside_v, static_cast<char>('I' + axes.v), modes_.scale);
    take(cycle_.back_level, static_cast<char>('I' + axes.w), modes_.scale);
  }
  const auto missing = [&](char letter, std::string_view what) {
    reporter_.error(
        codes::word_missing, line_.column(),
        fmt::format("{} needs {} ({}); the line is skipped", code_text('G', motion), letter, what));
    return false;
  };
  if (!cycle_.r) return missing('R', "the retract plane");
  if (!cycle_.bottom) return missing(bottom_letter, "the bottom of the hole");
  if (needs_peck(motion) && !(cycle_.peck.value_or(0.0) > 0.0))
    return missing('Q', "the depth of a peck, above 0");
  if (motion == 870 && !cycle_.back_level)
    return missing(static_cast<char>('I' + axes.w), "the level to which it bores back");
  if (cycle_.dwell.value_or(0.0) < 0.0) {
    reporter_.error(codes::word_out_of_range, line_.column(), "a dwell time cannot be negative");
    cycle_.dwell.reset();
  }
  dwells_.report_long(cycle_.dwell.value_or(0.0), 'P');
  if (needs_dwell(motion) && !cycle_.dwell) {
    reporter_.unusual(codes::word_missing, line_.column(),
                      fmt::format("{} without a P word; assuming no dwell", code_text('G', motion)));
    cycle_.dwell = 0.0;
  }
  return true;
}

/// Taps need the sense of the thread, and G86 a spindle that it can stop.
void CannedCycles::report_wrong_turn(Tenths motion) {
  if (motion == 860 && modes_.spindle == SpindleTurn::off)
    reporter_.unusual(codes::modal_conflict, line_.column(),
                      "G86 with the spindle stopped; LinuxCNC refuses it", "start it with M3 or M4");
  if (motion != 740 && motion != 840) return;
  const SpindleTurn wanted = motion == 840 ? SpindleTurn::cw : SpindleTurn::ccw;
  if (modes_.spindle == wanted) return;
  reporter_.unusual(
      codes::modal_conflict, line_.column(),
      fmt::format("{} with the spindle {}; LinuxCNC refuses it", code_text('G', motion),
                  modes_.spindle == SpindleTurn::off ? "stopped" : "turning the other way"),
      motion == 840 ? "G84 taps right-hand threads, with M3" : "G74 taps left-hand threads, with M4");
}

/// Haas' G73 and G83 have pecks that become smaller (I J K); its G73 with K and Q returns to the retract
/// plane each time that the pecks reach K. Fanuc's have Q alone. Source: Haas, Mill Operator's Manual, "G73
/// High-Speed Peck Drilling Canned Cycle", "G83 Normal Peck Drilling Canned Cycle".
bool CannedCycles::refuse_pecks(Tenths motion) {
  if (!needs_peck(motion) || !is_fanuc(program_.dialect)) return false;
  const bool smaller = line_.has_unused(kFirstAndLess), haas = program_.dialect == GcodeDialect::haas;
  const bool returns = haas && motion == 730 && !smaller && line_.unused('K') && !cycle_.peck_less;
  if (!returns && (haas || !smaller)) return false;
  reporter_.error(codes::code_unsupported, line_.column(),
                  fmt::format("{} with {} is not supported; the line is skipped", code_text('G', motion),
                              returns ? "K and Q" : "I J K, pecks that become smaller,"),
                  "use Q, the depth of each peck");
  return true;
}

/// L, or K on Fanuc's controls, where 0 only stores the words of the cycle.
int CannedCycles::repeats() {
  const bool fanuc = is_fanuc(program_.dialect);
  std::optional<double> count = line_.take('L');
  if (!count && fanuc) count = line_.take('K');
  if (!count) return 1;
  if (fanuc && *count == 0.0) return 0;
  if (*count >= 1.0 && *count <= limits::kMaxHoles && *count == std::floor(*count))
    return static_cast<int>(*count);
  reporter_.error(
      codes::word_out_of_range, line_.column('L'),
      fmt::format("the repeats of a cycle (L) are an integer from 1 to {}; assuming 1", limits::kMaxHoles));
  return 1;
}

/// The cycle of a line, and the target of its words; nothing after an error.
std::optional<DrillCycle> CannedCycles::plan(Tenths motion, ToolPosition& target_position) {
  const int axis = axes_of(modes_.plane).w;
  const double level = cycle_.start_level.value_or(position_.at[axis]);
  const bool rises = program_.dialect != GcodeDialect::rs274 && modes_.absolute;  // to R, from anywhere
  const bool is_known = cycle_.start_level || !rises || (position_.unknown & 1u << axis) == 0;
  const std::optional<ToolPosition> to = mover_.target();  // the word of the third axis has been taken
  if (!to) return std::nullopt;
  target_position = *to;
  DrillCycle cycle;
  cycle.kind = kind_of(motion);
  cycle.plane = modes_.plane;
  cycle.at = to->at;
  cycle.retract_plane = modes_.absolute ? *cycle_.r + coordinates_.frame().shift[axis] : level + *cycle_.r;
  cycle.bottom = modes_.absolute ? *cycle_.bottom + coordinates_.frame().shift[axis]
                                 : cycle.retract_plane + *cycle_.bottom;
  cycle.retract = modes_.retract_to_start && is_known ? DrillRetract::start : DrillRetract::plane;
  cycle.start_level = level;
  cycle.peck = mm(cycle_.peck.value_or(0.0));
  cycle.peck_less = mm(cycle_.peck_less.value_or(0.0));
  cycle.peck_least = mm(cycle_.peck_least.value_or(0.0));
  cycle.dwell = seconds(cycle_.dwell.value_or(0.0));
  cycle.turn = modes_.spindle;
  if (cycle.kind == DrillKind::back_bore) plan_back_bore(cycle);
  if (const std::optional<DrillFault> fault = fault_of(cycle)) {
    const bool is_readable = fault->code != codes::cycle_upside_down;
    reporter_.error(
        fault->code, line_.column(),
        fmt::format("{}; {}", fault->message, is_readable ? "drilled without pecks" : "the line is skipped"));
    if (!is_readable) return std::nullopt;
    cycle.kind = DrillKind::plain;
  }
  if (!reachable({cycle.retract_plane, cycle.bottom, cycle.back_level})) return std::nullopt;
  const unsigned third = 1u << axis;  // its word is the bottom, not a target
  target_position.reference_axes &= ~third;
  if (modes_.absolute) target_position.unknown &= ~third;
  if (cycle_.is_plane_measured) target_position.unknown |= third;
  if (!modes_.absolute) {  // each repeat advances by the words of the line
    cycle.increment = to->at - position_.at;
    cycle.at = position_.at + cycle.increment;
  }
  cycle_.start_level = is_known ? level : cycle.retract_plane;
  return cycle;
}

void CannedCycles::plan_back_bore(DrillCycle& cycle) const {
  const PlaneAxes axes = axes_of(modes_.plane);
  cycle.back_level = modes_.absolute ? *cycle_.back_level + coordinates_.frame().shift[axes.w]
                                     : cycle.bottom + *cycle_.back_level;
  cycle.aside[axes.u] = cycle_.aside_u.value_or(0.0);
  cycle.aside[axes.v] = cycle_.aside_v.value_or(0.0);
}

/// The number of holes before the first one that is too far away; an error if that is not all.
int CannedCycles::reachable_holes(const DrillCycle& cycle, int holes) {
  Point3 at = cycle.at;
  for (int i = 0; i < holes; ++i) {
    if (!reachable(at) || !reachable(at + cycle.aside)) return i;
    at = at + cycle.increment;
  }
  return holes;
}

}  // namespace kerf::gcode

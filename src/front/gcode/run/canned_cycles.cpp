// The words of canned cycles G73, G74 and G81 to G89; kerf/drill.h makes their motions.
#include <cmath>
#include <fmt/format.h>

#include "front/gcode/run/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr int kMostRepeats = 10'000;

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

/// What a cycle needs besides R and the bottom.
bool needs_dwell(Tenths cycle) { return cycle == 820 || cycle == 860 || cycle == 880 || cycle == 890; }
bool needs_peck(Tenths cycle) { return cycle == 730 || cycle == 830; }

}  // namespace

/// Adds the motions of a cycle to the program's path.
class Interpreter::CycleSink final : public DrillSink {
 public:
  /// `there` has the axes that are unknown at the holes.
  CycleSink(Interpreter& interpreter, const DrillCycle& cycle, const Place& there, double feed)
      : interpreter_(interpreter), place_(there), unknown_(there.unknown), feed_(feed) {
    if (!rises_first(cycle)) return;
    place_.unknown = interpreter.here_.unknown;
    if (interpreter.modes_.absolute) place_.unknown &= ~(1u << axes_of(cycle.plane).w);
  }
  void rapid(Point3 to) override { interpreter_.rapid(place(to)); }
  void cut(Point3 to) override { interpreter_.cut(place(to), feed_); }
  void dwell(Duration time) override { interpreter_.add(step::Dwell{time}); }
  void spindle(SpindleTurn turn) override { interpreter_.spin(turn); }
  void pause() override { interpreter_.add(step::Pause{}); }
  bool is_full() const override { return interpreter_.full_; }

 private:
  Place place(Point3 to) {
    Place next = place_;
    next.at = to;
    place_.unknown = unknown_;
    return next;
  }
  Interpreter& interpreter_;
  Place place_;
  unsigned unknown_;  // after the first motion
  double feed_;       // mm/min
};

void Interpreter::cycle(Tenths motion) {
  if (cycle_.motion != motion) {
    // Another cycle of the same series knows only the level where the series began.
    const std::optional<double> level = cycle_.start_level;
    cycle_ = {};
    cycle_.motion = motion;
    cycle_.start_level = level;
  }
  if (!take_cycle_words(motion)) {
    line_.use((1u << 26) - 1);
    return;
  }
  const int holes = repeats();
  Place to;
  std::optional<DrillCycle> cycle = plan_cycle(motion, to);
  if (!cycle) return;
  cycle->holes = reachable_holes(*cycle, holes);
  if (cycle->holes == 0 || !room_for(min_steps(*cycle))) return;
  CycleSink sink(*this, *cycle, to, cycle_feed());
  expand(*cycle, here_.at, sink);
}

/// Takes R, the bottom, P and Q, which hold until they are given anew.
bool Interpreter::take_cycle_words(Tenths motion) {
  const PlaneAxes axes = axes_of(modes_.plane);
  const auto keep = [this](std::optional<double>& kept, char letter, double scale) {
    if (const auto value = line_.take(letter)) kept = *value * scale;
  };
  const char bottom_letter = static_cast<char>('X' + axes.w);
  keep(cycle_.r, 'R', modes_.scale);
  keep(cycle_.bottom, bottom_letter, modes_.scale);
  keep(cycle_.dwell, 'P', 1.0);
  keep(cycle_.peck, 'Q', modes_.scale);
  if (motion == 870) {
    keep(cycle_.aside_u, static_cast<char>('I' + axes.u), modes_.scale);
    keep(cycle_.aside_v, static_cast<char>('I' + axes.v), modes_.scale);
    keep(cycle_.back_level, static_cast<char>('I' + axes.w), modes_.scale);
  }
  const auto missing = [&](char letter, std::string_view what) {
    talker_.error(
        Code::word_missing, line_.column(),
        fmt::format("{} needs {} ({}); the line is left out", code_text('G', motion), letter, what));
    return false;
  };
  if (!cycle_.r) return missing('R', "the retract plane");
  if (!cycle_.bottom) return missing(bottom_letter, "the bottom of the hole");
  if (needs_peck(motion) && !(cycle_.peck.value_or(0.0) > 0.0))
    return missing('Q', "the depth of a peck, above 0");
  if (motion == 870 && !cycle_.back_level)
    return missing(static_cast<char>('I' + axes.w), "the level to bore back to");
  if (cycle_.dwell.value_or(0.0) < 0.0) {
    talker_.error(Code::word_out_of_range, line_.column(), "a dwell time cannot be negative");
    cycle_.dwell.reset();
  }
  tell_long_dwell(cycle_.dwell.value_or(0.0), 'P');
  if (needs_dwell(motion) && !cycle_.dwell) {
    talker_.unusual(Code::word_missing, line_.column(),
                    fmt::format("{} without a P word; read without a dwell", code_text('G', motion)));
    cycle_.dwell = 0.0;
  }
  return true;
}

int Interpreter::repeats() {
  const std::optional<double> count = line_.take('L');
  if (!count) return 1;
  if (*count >= 1.0 && *count <= kMostRepeats && *count == std::floor(*count))
    return static_cast<int>(*count);
  talker_.error(
      Code::word_out_of_range, line_.column('L'),
      fmt::format("the repeats of a cycle are a whole number from 1 to {}; read as 1", kMostRepeats));
  return 1;
}

/// The cycle of a line, and the target of its words; nothing (said) where it has none.
std::optional<DrillCycle> Interpreter::plan_cycle(Tenths motion, Place& place) {
  const int axis = axes_of(modes_.plane).w;
  const double level = cycle_.start_level.value_or(here_.at[axis]);
  const std::optional<Place> to = target();  // the word of the third axis is taken already
  if (!to) return std::nullopt;
  place = *to;
  DrillCycle cycle;
  cycle.kind = kind_of(motion);
  cycle.plane = modes_.plane;
  cycle.at = to->at;
  cycle.retract_plane = modes_.absolute ? *cycle_.r + placement_.shift[axis] : level + *cycle_.r;
  cycle.bottom =
      modes_.absolute ? *cycle_.bottom + placement_.shift[axis] : cycle.retract_plane + *cycle_.bottom;
  cycle.retract = modes_.retract_to_start ? DrillRetract::start : DrillRetract::plane;
  cycle.start_level = level;
  cycle.peck = mm(cycle_.peck.value_or(0.0));
  cycle.dwell = seconds(cycle_.dwell.value_or(0.0));
  cycle.turn = modes_.spindle;
  if (cycle.kind == DrillKind::back_bore) plan_back_bore(cycle);
  if (const std::optional<DrillFault> fault = fault_of(cycle)) {
    const bool is_readable = fault->code != Code::cycle_upside_down;
    talker_.error(
        fault->code, line_.column(),
        fmt::format("{}; {}", fault->message, is_readable ? "drilled without pecks" : "the line is skipped"));
    if (!is_readable) return std::nullopt;
    cycle.kind = DrillKind::plain;
  }
  if (!reachable({cycle.retract_plane, cycle.bottom, cycle.back_level})) return std::nullopt;
  if (modes_.absolute) place.unknown &= ~(1u << axis);
  if (!modes_.absolute) {  // each repeat goes on by the words of the line
    cycle.increment = to->at - here_.at;
    cycle.at = here_.at + cycle.increment;
  }
  cycle_.start_level = level;
  return cycle;
}

void Interpreter::plan_back_bore(DrillCycle& cycle) const {
  const PlaneAxes axes = axes_of(modes_.plane);
  cycle.back_level =
      modes_.absolute ? *cycle_.back_level + placement_.shift[axes.w] : cycle.bottom + *cycle_.back_level;
  cycle.aside[axes.u] = cycle_.aside_u.value_or(0.0);
  cycle.aside[axes.v] = cycle_.aside_v.value_or(0.0);
}

/// How many of the holes lie within reach; an error where not all do.
int Interpreter::reachable_holes(const DrillCycle& cycle, int holes) {
  Point3 at = cycle.at;
  for (int i = 0; i < holes; ++i) {
    if (!reachable(at) || !reachable(at + cycle.aside)) return i;
    at = at + cycle.increment;
  }
  return holes;
}

/// Feed of a cycle in mm/min; 0 where there is none.
double Interpreter::cycle_feed() {
  if (modes_.feed_mode != FeedMode::inverse_time) return feed_for(0.0);
  if (!no_feed_said_)
    talker_.unusual(Code::no_feed, line_.column(),
                    "inverse time feeds mean nothing in a canned cycle; it has no feed");
  no_feed_said_ = true;
  return 0.0;
}

}  // namespace kerf::gcode

// Canned cycles G73, G74 and G81 to G89 as the rapids, cuts and dwells they stand for, in the order and with
// the clearances that LinuxCNC's interpreter gives them.
#include <cmath>
#include <fmt/format.h>

#include "front/gcode/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr double kPeckClearance = 0.254;  // mm (0.010 in) above the depth reached, where a peck slows to feed
constexpr double kMostPecks = 100'000;    // in one hole
constexpr int kMostRepeats = 10'000;

/// What a cycle needs besides R and the bottom.
bool needs_dwell(Tenths cycle) { return cycle == 820 || cycle == 860 || cycle == 880 || cycle == 890; }
bool needs_peck(Tenths cycle) { return cycle == 730 || cycle == 830; }

}  // namespace

/// One hole: where it is in the plane, and its levels along the third axis in mm.
struct Interpreter::Hole {
  Place place;     // the third axis is set by each move
  int axis = 2;    // index of the third axis
  double r = 0.0;  // from here on at feed
  double bottom = 0.0;
  double travel = 0.0;  // level of the way to the hole
  double clear = 0.0;   // level after the hole
  Point3 increment;     // to the next repeat, in the plane
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
  const int count = repeats();
  std::optional<Hole> hole = plan_hole();
  if (!hole || !room_for(count * steps_of(motion, *hole)) || !approach(*hole)) return;
  for (int i = 0; i < count && !full_; ++i) {
    hole->place.at = hole->place.at + hole->increment;
    if (!reachable(hole->place.at)) return;
    cycle_rapid(*hole, hole->travel);
    if (hole->travel != hole->r) cycle_rapid(*hole, hole->r);
    drill(motion, *hole);
    hole->travel = hole->clear;
  }
}

/// How many steps a hole takes, at least: known before any of them is made.
double Interpreter::steps_of(Tenths motion, const Hole& hole) const {
  if (!needs_peck(motion)) return 1.0;
  const double pecks = (hole.r - hole.bottom) / *cycle_.peck;
  return pecks > kMostPecks ? 1.0 : pecks * (motion == 830 ? 3.0 : 2.0);
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
  if (!cycle_.r) return missing('R', "the clearance plane");
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

std::optional<Interpreter::Hole> Interpreter::plan_hole() {
  const PlaneAxes axes = axes_of(modes_.plane);
  Hole hole;
  hole.axis = axes.w;
  const double level = cycle_.start_level.value_or(here_.at[axes.w]);
  const std::optional<Place> to = target();  // the third axis' word is taken already
  if (!to) return std::nullopt;
  hole.place = *to;
  hole.r = modes_.absolute ? *cycle_.r + placement_.shift[axes.w] : level + *cycle_.r;
  hole.bottom = modes_.absolute ? *cycle_.bottom + placement_.shift[axes.w] : hole.r + *cycle_.bottom;
  if (hole.r < hole.bottom) {
    talker_.error(
        Code::cycle_upside_down, line_.column(),
        fmt::format("the clearance plane R lies {:.4g} mm below the bottom of the hole; the line is left out",
                    hole.bottom - hole.r));
    return std::nullopt;
  }
  Point3 levels;
  levels[0] = hole.r;
  levels[1] = hole.bottom;
  if (!reachable(levels)) return std::nullopt;
  if (modes_.absolute) hole.place.unknown &= ~(1u << axes.w);
  if (!modes_.absolute) {  // each repeat goes on by the words of the line
    hole.increment = to->at - here_.at;
    hole.place.at = here_.at;
  }
  cycle_.start_level = level;
  const double begin = std::max(level, hole.r);
  hole.clear = modes_.retract_to_start ? begin : hole.r;
  const double now = level < hole.r ? hole.r : here_.at[axes.w];  // after the approach
  hole.travel = std::max(now, hole.clear);
  return hole;
}

/// A tool that stands below the clearance plane rises to it first.
bool Interpreter::approach(const Hole& hole) {
  if (!(*cycle_.start_level < hole.r)) return true;
  Place up = here_;
  up.at[hole.axis] = hole.r;
  if (modes_.absolute) up.unknown &= ~(1u << hole.axis);
  rapid(up);
  return !full_;
}

/// From the clearance plane to the bottom and back to the level that is clear.
void Interpreter::drill(Tenths motion, const Hole& hole) {
  if (needs_peck(motion)) return peck(motion, hole);
  if (motion == 740) return tap(hole, SpindleTurn::ccw);
  if (motion == 840) return tap(hole, SpindleTurn::cw);
  if (motion == 870) return back_bore(hole);
  cycle_cut(hole, hole.bottom);
  if (needs_dwell(motion)) cycle_dwell();
  const SpindleTurn turn = modes_.spindle;
  switch (motion) {
    case 850: cycle_cut(hole, hole.r); return cycle_rapid(hole, hole.clear);
    case 860:
      spin(SpindleTurn::off);
      cycle_rapid(hole, hole.clear);
      return spin(turn);
    case 880:  // the operator retracts by hand; the rapid stands for that
      spin(SpindleTurn::off);
      add(step::Verbatim{"M0"});
      cycle_rapid(hole, hole.clear);
      return spin(turn);
    case 890: return cycle_cut(hole, hole.clear);
    default: return cycle_rapid(hole, hole.clear);
  }
}

/// G83 clears the hole after each peck, G73 only breaks the chip.
void Interpreter::peck(Tenths motion, const Hole& hole) {
  const double depth = *cycle_.peck;
  if ((hole.r - hole.bottom) / depth > kMostPecks) {
    talker_.error(
        Code::word_out_of_range, line_.column(),
        fmt::format("pecks of {:g} mm make more than {:g} in one hole; read as one", depth, kMostPecks));
    cycle_cut(hole, hole.bottom);
    return cycle_rapid(hole, hole.clear);
  }
  for (double level = hole.r - depth; level > hole.bottom && !full_; level -= depth) {
    cycle_cut(hole, level);
    if (motion == 830) cycle_rapid(hole, hole.r);
    cycle_rapid(hole, level + kPeckClearance);
  }
  cycle_cut(hole, hole.bottom);
  cycle_rapid(hole, hole.clear);
}

/// The spindle turns back on the way out.
void Interpreter::tap(const Hole& hole, SpindleTurn forward) {
  const SpindleTurn back = forward == SpindleTurn::cw ? SpindleTurn::ccw : SpindleTurn::cw;
  cycle_cut(hole, hole.bottom);
  spin(back);
  cycle_dwell();
  cycle_cut(hole, hole.clear);
  spin(forward);
}

/// In beside the hole with the spindle stopped, then bored upwards.
void Interpreter::back_bore(const Hole& hole) {
  const PlaneAxes axes = axes_of(modes_.plane);
  const double back_level =
      modes_.absolute ? *cycle_.back_level + placement_.shift[axes.w] : hole.bottom + *cycle_.back_level;
  Hole aside = hole;
  aside.place.at[axes.u] += cycle_.aside_u.value_or(0.0);
  aside.place.at[axes.v] += cycle_.aside_v.value_or(0.0);
  if (!reachable(aside.place.at) || !reachable({back_level, 0.0, 0.0})) return;
  const SpindleTurn turn = modes_.spindle;
  cycle_rapid(aside, hole.r);
  spin(SpindleTurn::off);
  cycle_rapid(aside, hole.bottom);
  cycle_rapid(hole, hole.bottom);
  spin(turn);
  cycle_cut(hole, back_level);
  cycle_cut(hole, hole.bottom);
  spin(SpindleTurn::off);
  cycle_rapid(aside, hole.bottom);
  cycle_rapid(aside, hole.clear);
  cycle_rapid(hole, hole.clear);
  spin(turn);
}

void Interpreter::cycle_rapid(const Hole& hole, double level) {
  Place to = hole.place;
  to.at[hole.axis] = level;
  rapid(to);
}

void Interpreter::cycle_cut(const Hole& hole, double level) {
  Place to = hole.place;
  to.at[hole.axis] = level;
  const bool inverse_time = modes_.feed_mode == FeedMode::inverse_time;
  if (inverse_time && !no_feed_said_)
    talker_.unusual(Code::no_feed, line_.column(),
                    "inverse time feeds mean nothing in a canned cycle; it has no feed");
  if (inverse_time) no_feed_said_ = true;
  cut(to, inverse_time ? 0.0 : feed_for(0.0));
}

void Interpreter::cycle_dwell() {
  const double time = cycle_.dwell.value_or(0.0);
  if (time > 0.0) add(step::Dwell{seconds(time)});
}

}  // namespace kerf::gcode

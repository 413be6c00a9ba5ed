// Straight moves, machine coordinates, homes and shifts of zero; and which motion a line's words mean.
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "front/gcode/run/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kPolarZero = 1e-9;  // mm
constexpr std::uint32_t kArcLetters = Line::bit('I') | Line::bit('J') | Line::bit('K') | Line::bit('R');

bool is_arc(Tenths motion) { return motion == 20 || motion == 30; }
bool is_probe(Tenths motion) { return motion >= 382 && motion <= 385; }
bool is_cycle(Tenths motion) { return motion == 730 || motion == 740 || (motion >= 810 && motion <= 890); }

}  // namespace

void Interpreter::move() {
  const bool stated = line_.has(Group::motion);
  if (stated) {
    const Tenths code = line_.code(Group::motion);
    const CodeEntry* entry = find_g_code(code);
    modes_.motion = entry->support == Support::read ? code : kMotionNotRead;
    if (!is_cycle(modes_.motion)) cycle_ = {};
    if (modes_.motion != 50) last_curve_handle_.reset();
    if (modes_.motion == kMotionNotRead) return line_.use(kAllLetters);
  }
  if (stated && (modes_.motion == 52 || modes_.motion == 53)) return curve(modes_.motion);
  const bool axes = line_.has_unused(kAxisLetters | kRotaryLetters);
  const bool filament = line_.unused('E') && (modes_.motion == 0 || modes_.motion == 10);
  if (axes || filament || (is_arc(modes_.motion) && line_.has_unused(kArcLetters)))
    return move_in(modes_.motion);
  if (!stated || line_.has(Group::reference)) return;
  if (modes_.motion == 0 || modes_.motion == 10) {
    // A move of length 0, as LinuxCNC makes it; in a program's header, where nothing has moved yet, only the
    // mode.
    if (moved_ && (modes_.motion == 0 || modes_.feed > 0.0)) straight(modes_.motion);
    return;
  }
  if (modes_.motion != kNoMotion)
    talker_.unusual(Code::word_missing, line_.column(Group::motion),
                    fmt::format("{} without axis words makes no move here", code_text('G', modes_.motion)));
}

void Interpreter::move_in(Tenths motion) {
  if (motion == kMotionNotSaid) {
    talker_.unusual(Code::no_motion_mode, line_.column(),
                    "axis words before any motion code; read as rapid moves");
    motion = modes_.motion = 0;
  }
  const bool in_machine = line_.has(Group::machine_coordinates);
  const bool straight_motion = motion == 0 || motion == 10;
  if (motion == kNoMotion || motion == kMotionNotRead || (in_machine && !straight_motion)) {
    const std::string_view why = motion == kNoMotion ? "axis words while no motion is in force (after G80)"
                                 : in_machine        ? "G53 goes with G0 and G1 only"
                                                     : "axis words in a motion that is not read yet";
    talker_.error(Code::no_motion_mode, line_.column(), fmt::format("{}; the move is left out", why));
    return line_.use(kAllLetters);
  }
  if (straight_motion) return straight(motion);
  if (is_arc(motion)) return arc(motion == 20 ? Turn::cw : Turn::ccw);
  if (is_probe(motion)) return probe(motion);
  if (motion >= 50 && motion <= 53) return curve(motion);
  if (motion == 330 || motion == 331) return spindle_move(motion);
  if (motion == 760) return thread_cycle();
  cycle(motion);
}

void Interpreter::straight(Tenths motion) {
  const std::optional<Place> to = line_.has(Group::machine_coordinates) ? machine_target() : target();
  if (!to) return;
  if (line_.unused('E')) return extrude(*to, motion == 0 ? modes_.feed : feed_for(straight_length(*to)));
  compensation_.leaving = false;
  const double feed = motion == 0 ? 0.0 : feed_for(straight_length(*to));
  if (compensation_.cutter) return compensated_line(*to, motion == 0 ? MoveKind::rapid : MoveKind::cut, feed);
  if (motion == 0) return rapid(*to);
  cut(*to, feed);
}

void Interpreter::probe(Tenths motion) {
  constexpr ProbeKind kKinds[] = {ProbeKind::contact_or_error, ProbeKind::contact,
                                  ProbeKind::release_or_error, ProbeKind::release};
  const std::optional<Place> to = target();
  if (!to) return;
  const double feed = feed_for(straight_length(*to));
  if (add(step::Probe{to->at, mm_per_min(feed), kKinds[motion - 382]})) arrive(*to);
}

/// Where the line's axis words lead in work coordinates; marks them as used. Nothing (said) if it is out of
/// reach.
std::optional<Place> Interpreter::target() {
  Place to = here_;
  if (placement_.plain && !modes_.diameters) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
      if (!word) continue;
      const double value = *word * modes_.scale;
      to.at[axis] = modes_.absolute ? value + placement_.shift[axis] : here_.at[axis] + value;
      if (modes_.absolute) to.unknown &= ~(1u << axis);
    }
  } else {
    to = placed_target();
  }
  if (line_.has_unused(kRotaryLetters)) {
    rotary_used_ = true;
    for (int axis = 0; axis < 3; ++axis)
      if (const auto word = line_.take(static_cast<char>('A' + axis)))
        rotary_[static_cast<std::size_t>(axis)] =
            modes_.absolute ? *word : rotary_[static_cast<std::size_t>(axis)] + *word;
  }
  if (!reachable(to.at)) return std::nullopt;
  return to;
}

/// The same where coordinates are turned or scaled, or X words are diameters.
Place Interpreter::placed_target() {
  Place to = here_;
  Point3 program = placement_.to_program(here_.at);
  bool any = false;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    const double value = *word * modes_.scale * (axis == 0 && modes_.diameters ? 0.5 : 1.0);
    program[axis] = modes_.absolute ? value : program[axis] + value;
    if (modes_.absolute) to.unknown &= ~(1u << axis);
    any = true;
  }
  if (any) to.at = placement_.to_path(program);
  return to;
}

/// "@10 ^45": distance from the zero point and angle in place of X and Y.
void Interpreter::polar() {
  const Point3 from = placement_.to_program(here_.at);
  double radius = std::hypot(from.x, from.y);
  const bool at_zero = radius < kPolarZero;
  if (at_zero && (!line_.polar_radius() || !modes_.absolute)) {
    talker_.error(Code::polar_from_zero, line_.column(),
                  "polar coordinates from the zero point have no direction; the line is left out");
    return line_.use(kAllLetters);
  }
  double angle = at_zero ? 0.0 : std::atan2(from.y, from.x) / kDegree;
  if (line_.polar_radius()) radius = *line_.polar_radius() * modes_.scale + (modes_.absolute ? 0.0 : radius);
  if (line_.polar_angle()) angle = *line_.polar_angle() + (modes_.absolute ? 0.0 : angle);
  const Point3 base = modes_.absolute ? Point3{} : from;
  line_.put('X', (radius * std::cos(angle * kDegree) - base.x) / modes_.scale);
  line_.put('Y', (radius * std::sin(angle * kDegree) - base.y) / modes_.scale);
}

/// As target(), in machine coordinates: where that is in work coordinates is not known.
std::optional<Place> Interpreter::machine_target() {
  if (!modes_.absolute)
    talker_.unusual(Code::g53_incremental, line_.column(Group::machine_coordinates),
                    "machine coordinates are absolute, G91 does not count for them");
  Place to = here_;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    to.at[axis] = *word * modes_.scale;
    to.unknown |= 1u << axis;
    to.reference_axes |= 1u << axis;
    to.reference = Reference::machine;
  }
  if (!reachable(to.at)) return std::nullopt;
  return to;
}

bool Interpreter::reachable(Point3 p) {
  if (is_near(p)) return true;
  talker_.error(
      Code::position_too_far, line_.column(),
      fmt::format("a position lies farther than {:g} mm from zero; the move is left out", kFarthest));
  line_.use(kAllLetters);
  return false;
}

/// What the feed of an inverse time move is worked out from: its mm; 0 in the other
/// feed modes, which do not ask.
double Interpreter::straight_length(const Place& to) const {
  if (modes_.feed_mode != FeedMode::inverse_time) return 0.0;
  return distance(here_.at, to.at);
}

/// Feed in mm/min of a move of `length` mm; 0, said once, where the program gives none.
double Interpreter::feed_for(double length) {
  const bool inverse = modes_.feed_mode == FeedMode::inverse_time;
  const double given = inverse && !line_.has('F') ? 0.0 : modes_.feed;  // in inverse time F is not modal
  const double feed = feed_per_minute(modes_.feed_mode, given, length, modes_.speed);
  if (!(feed > 0.0)) {
    if (!no_feed_said_)
      talker_.unusual(Code::no_feed, line_.column(),
                      inverse
                          ? "in inverse time (G93) each cutting line needs an F of its own; this one has none"
                          : "a cutting move without a feed; the program gives no F for it",
                      inverse ? "put an F word on the line" : "put an F word before the first G1");
    no_feed_said_ = true;
    return 0.0;
  }
  no_feed_said_ = false;
  return feed;
}

// ---- codes that use the axis words themselves

void Interpreter::use_reference() {
  const bool printer = program_.dialect == GcodeDialect::marlin || program_.dialect == GcodeDialect::klipper;
  if (printer) return printer_reference();
  switch (line_.code(Group::reference)) {
    case 100: return set_data();
    case 280: return go_home(home_28_, Reference::home);
    case 300: return go_home(home_30_, Reference::second_home);
    case 281: return set_home(kHome28, home_28_);
    case 301: return set_home(kHome30, home_30_);
    case 520: return shift_locally();
    case 920: return shift_zero();
    case 921: local_shift_ = kept_local_shift_ = {}; break;
    case 922:
      kept_local_shift_ = local_shift_;
      local_shift_ = {};
      break;
    case 923: local_shift_ = kept_local_shift_; break;
    default: line_.use(kAllLetters); return;
  }
  refresh_placement();
}

/// Controllers come to rest where a zero is shifted: whenever G10 or G92 stand there, and where G54 to G59.3
/// name another one.
void Interpreter::note_rest() {
  if (line_.has(Group::coordinates) && line_.code(Group::coordinates) != work_offset_) {
    work_offset_ = line_.code(Group::coordinates);
    rests_ = true;
  }
  if (!line_.has(Group::reference)) return;
  const Tenths code = line_.code(Group::reference);
  rests_ = rests_ || code == 100 || code == 520 || (code >= 920 && code <= 923);
}

/// Through the intermediate point to the home; only the axes that are named, all where none is.
void Interpreter::go_home(const Place& home, Reference reference) {
  unsigned axes = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (line_.unused(static_cast<char>('X' + axis))) axes |= 1u << axis;
  if (axes == 0) axes = kAllAxes;
  std::optional<Place> to = target();
  if (!to) return;
  rapid(*to);
  Point3 end = placement_.to_program(to->at);  // where coordinates are turned, axes are the program's
  const Point3 home_in_program = placement_.to_program(home.at);
  for (int axis = 0; axis < 3; ++axis) {
    const unsigned bit = 1u << axis;
    if ((axes & bit) == 0) continue;
    end[axis] = home_in_program[axis];
    if (placement_.plain) to->at[axis] = home.at[axis];
    to->unknown = (to->unknown & ~bit) | (home.unknown & bit);
  }
  if (!placement_.plain) to->at = placement_.to_path(end);
  to->reference = reference;
  to->reference_axes = axes & to->unknown;
  rapid(*to);
}

// ---- steps

void Interpreter::rapid(const Place& to) {
  if (add(step::Rapid{to.at})) arrive(to);
}

void Interpreter::cut(const Place& to, double feed) {
  if (add(step::Cut{to.at, mm_per_min(feed)})) arrive(to);
}

void Interpreter::arrive(const Place& to) {
  if (to.unknown != 0) path_.set_unknown_axes(path_.size() - 1, to.unknown);
  if (to.reference_axes != 0) path_.set_reference(path_.size() - 1, to.reference, to.reference_axes);
  if (rotary_used_) path_.set_extra(path_.size() - 1, {rotary_, {}});
  if (rests_) path_.set_rests_before(path_.size() - 1);
  rests_ = false;
  here_ = to;
  here_.reference_axes = 0;
  tool_comments_.motion();
  if (moved_) return;
  moved_ = true;
  use_waiting_remarks();
  program_.inch = modes_.scale != 1.0;
}

}  // namespace kerf::gcode

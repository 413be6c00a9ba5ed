// Straight moves, machine coordinates, homes and shifts of zero; and which motion a line's words mean.
#include <cmath>
#include <fmt/format.h>

#include "front/gcode/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr double kFarthest = 1e7;  // mm; 10 km
constexpr double kSlowestInverse =
    0.1;  // mm/min; what LinuxCNC takes for a move of no length in inverse time
constexpr std::uint32_t kArcLetters = Line::bit('I') | Line::bit('J') | Line::bit('K') | Line::bit('R');
constexpr std::uint32_t kAllLetters = (1u << 26) - 1;

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
    if (modes_.motion == kMotionNotRead) return line_.use(kAllLetters);
  }
  const bool axes = line_.has_unused(kAxisLetters | kRotaryLetters);
  if (axes || (is_arc(modes_.motion) && line_.has_unused(kArcLetters))) return move_in(modes_.motion);
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
  cycle(motion);
}

void Interpreter::straight(Tenths motion) {
  const std::optional<Place> to = line_.has(Group::machine_coordinates) ? machine_target() : target();
  if (!to) return;
  if (motion == 0) return rapid(*to);
  cut(*to, feed_for(straight_length(*to)));
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
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    const double value = *word * modes_.scale;
    to.at[axis] = modes_.absolute ? value + shift_[axis] : here_.at[axis] + value;
    if (modes_.absolute) to.unknown &= ~(1u << axis);
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
  }
  if (!reachable(to.at)) return std::nullopt;
  return to;
}

bool Interpreter::reachable(Point3 p) {
  if (std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest) return true;
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
  if (modes_.feed_mode == FeedMode::inverse_time && !line_.has('F') && modes_.feed > 0.0)
    talker_.unusual(Code::word_missing, line_.column(),
                    "in inverse time each cutting line needs its F; the last one is kept");
  double feed = modes_.feed;
  if (modes_.feed_mode == FeedMode::per_turn) feed *= modes_.speed;
  if (!(feed > 0.0)) {
    if (!no_feed_said_)
      talker_.unusual(Code::no_feed, line_.column(),
                      "a cutting move without a feed; the program gives no F for it",
                      "put an F word before the first G1");
    no_feed_said_ = true;
    return 0.0;
  }
  no_feed_said_ = false;
  if (modes_.feed_mode != FeedMode::inverse_time) return feed;
  return std::max(feed * length, kSlowestInverse);
}

// ---- codes that use the axis words themselves

void Interpreter::use_reference() {
  switch (line_.code(Group::reference)) {
    case 280: return go_home(home_28_);
    case 300: return go_home(home_30_);
    case 281: home_28_ = here_; return;
    case 301: home_30_ = here_; return;
    case 920: return shift_zero();
    case 921: shift_ = kept_shift_ = {}; return;
    case 922:
      kept_shift_ = shift_;
      shift_ = {};
      return;
    case 923: shift_ = kept_shift_; return;
    default: line_.use(kAllLetters); return;  // G10, G52: said when the words were sorted
  }
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
void Interpreter::go_home(const Place& home) {
  unsigned axes = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (line_.unused(static_cast<char>('X' + axis))) axes |= 1u << axis;
  if (axes == 0) axes = kAllAxes;
  std::optional<Place> to = target();
  if (!to) return;
  rapid(*to);
  for (int axis = 0; axis < 3; ++axis) {
    const unsigned bit = 1u << axis;
    if ((axes & bit) == 0) continue;
    to->at[axis] = home.at[axis];
    to->unknown = (to->unknown & ~bit) | (home.unknown & bit);
  }
  rapid(*to);
}

/// G92: the place where the tool stands gets new coordinates. Where the place was not known, they are simply
/// its coordinates from now on.
void Interpreter::shift_zero() {
  if (!line_.has_unused(kAxisLetters | kRotaryLetters)) {
    talker_.error(Code::word_missing, line_.column(Group::reference), "G92 needs the coordinates to set");
    return;
  }
  Place now = here_;
  Point3 shift = shift_;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    const double value = *word * modes_.scale;
    const bool known = (here_.unknown & (1u << axis)) == 0;
    shift[axis] = known ? here_.at[axis] - value : 0.0;
    if (!known) now.at[axis] = value;
    now.unknown &= ~(1u << axis);
  }
  line_.use(kRotaryLetters);
  if (!reachable(now.at) || !reachable(shift)) return;
  here_ = now;
  shift_ = shift;
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
  if (rotary_used_) path_.set_extra(path_.size() - 1, {rotary_, {}});
  if (rests_) path_.set_rests_before(path_.size() - 1);
  rests_ = false;
  here_ = to;
  undescribed_tool_.reset();
  if (moved_) return;
  moved_ = true;
  program_.inch = modes_.scale != 1.0;
}

}  // namespace kerf::gcode

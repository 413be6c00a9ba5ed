// Which motion the words of a line are; straight motions, machine coordinates, homes.
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

#include "base/codes/gcode.h"
#include "front/gcode/run/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kPolarZero = 1e-9;  // mm
constexpr std::uint32_t kArcLetters =
    LineWords::bit('I') | LineWords::bit('J') | LineWords::bit('K') | LineWords::bit('R');

bool is_arc(Tenths motion) { return motion == 20 || motion == 30; }
bool is_probe(Tenths motion) { return motion >= 382 && motion <= 385; }
constexpr Tenths kSkip = 310;                         // G31
constexpr int kContact = 5061, kProbeSuccess = 5070;  // parameters with the result of a probe
constexpr int kMachContact = 2000;                    // of Mach3
bool is_cycle(Tenths motion) { return motion == 730 || motion == 740 || (motion >= 810 && motion <= 890); }

/// Whether G31 is a probe: on Fanuc's and Haas' controls, and Mach3.
bool has_skip(GcodeDialect dialect) {
  return dialect == GcodeDialect::fanuc || dialect == GcodeDialect::mach3;
}

}  // namespace

void Interpreter::run_line_motion() {
  const bool stated = line_.has(Group::motion);
  if (stated) {
    const Tenths code = line_.code(Group::motion);
    const CodeEntry* entry = find_g_code(code);
    if (code == kSkip && !has_skip(program_.dialect)) {
      reporter_.unusual(codes::unknown_g_code, line_.column(Group::motion), "unknown code G31; skipped",
                        "it is a probe on Mach3, Fanuc and Haas: --dialect");
      line_.leave_out("G31", line_.column(Group::motion));
      return leave_out();
    }
    const bool cancels = code == kNoMotion;
    const bool was_straight = modes_.motion == 0 || modes_.motion == 10;
    if ((is_cycle(code) && !is_cycle(modes_.motion)) || (cancels && was_straight))
      motion_before_cycle_ = modes_.motion;
    if (!cancels && !is_cycle(code)) motion_before_cycle_ = kMotionNotGiven;
    modes_.motion = entry->support == Support::read ? code : kMotionUnsupported;
    if (!is_cycle(modes_.motion)) cycle_ = {};
    if (modes_.motion != 50) last_control_point_.reset();
    if (modes_.motion == kMotionUnsupported) return line_.use(kAllLetters);
  }
  if (stated && (modes_.motion == 52 || modes_.motion == 53)) return curve(modes_.motion);
  const bool axes = line_.has_unused(kAxisLetters | kRotaryLetters);
  const bool filament = line_.unused('E') && (modes_.motion == 0 || modes_.motion == 10);
  if (axes || filament || (is_arc(modes_.motion) && line_.has_unused(kArcLetters)))
    return run_motion(modes_.motion);
  if (!stated || line_.has(Group::reference)) return;
  if (modes_.motion == 0 || modes_.motion == 10) {
    // LinuxCNC makes a motion of length 0. Before the first motion (in a header) the code only sets the mode.
    if (moved_ && (modes_.motion == 0 || modes_.feed > 0.0)) straight(modes_.motion);
    return;
  }
  if (modes_.motion != kNoMotion)
    reporter_.unusual(codes::word_missing, line_.column(Group::motion),
                      fmt::format("{} without axis words is no motion here", code_text('G', modes_.motion)));
}

void Interpreter::run_motion(Tenths motion) {
  if (motion == kMotionNotGiven) {
    reporter_.unusual(codes::no_motion_mode, line_.column(),
                      "axis words before any motion code; read as rapids");
    motion = modes_.motion = 0;
  }
  if (motion == kNoMotion && may_move_after_cancel()) motion = modes_.motion = motion_before_cycle_;
  const bool in_machine = line_.has(Group::machine_coordinates);
  const bool straight_motion = motion == 0 || motion == 10;
  if (motion == kNoMotion || motion == kMotionUnsupported || (in_machine && !straight_motion)) {
    const std::string_view why = motion == kNoMotion ? "axis words after G80, which ends the modal motion"
                                 : in_machine        ? "G53 is allowed with G0 and G1 only"
                                                     : "axis words after a motion code that is not supported";
    reporter_.error(codes::no_motion_mode, line_.column(), fmt::format("{}; the motion is skipped", why),
                    motion == kNoMotion
                        ? "Fanuc and Haas continue with the motion before the cycle: --dialect fanuc"
                        : "");
    return line_.use(kAllLetters);
  }
  if (straight_motion) return straight(motion);
  if (is_arc(motion)) return arc(motion == 20 ? Turn::cw : Turn::ccw);
  if (is_probe(motion)) return probe(static_cast<ProbeKind>(motion - 382));
  if (motion == kSkip) return probe(ProbeKind::contact);
  if (motion >= 50 && motion <= 53) return curve(motion);
  if (motion == 330 || motion == 331) return spindle_motion(motion);
  if (motion == 760) return thread_cycle();
  cycle(motion);
}

/// On Fanuc's and Haas' controls cycles are a modal group of their own: after G80 the motion before the cycle
/// is in force again. Fusion's programs for other controllers rely on it too.
bool Interpreter::may_move_after_cancel() {
  const bool known = motion_before_cycle_ == 0 || motion_before_cycle_ == 10;
  if (!known) return false;
  if (program_.dialect == GcodeDialect::fanuc) return true;
  if (program_.dialect != GcodeDialect::grbl && options_.dialect) return false;
  reporter_.unusual(
      codes::no_motion_mode, line_.column(),
      fmt::format("axis words after G80, which {} refuses; read with the {} before it, as Fanuc and Haas do",
                  to_string(program_.dialect), code_text('G', motion_before_cycle_)),
      "put G0 or G1 on the line, or read the program with --dialect fanuc");
  return true;
}

void Interpreter::straight(Tenths motion) {
  const std::optional<ToolPosition> to = line_.has(Group::machine_coordinates) ? machine_target() : target();
  if (!to) return;
  const double feed = motion == 0 ? 0.0 : straight_feed(*to);
  if (line_.unused('E')) return extrude(*to, motion == 0 ? speed_factor_ * modes_.feed : feed);
  compensation_.leaving = false;
  if (compensation_.cutter) {
    named_ = 0;
    return compensated_line(*to, motion == 0 ? MotionKind::rapid : MotionKind::cut, feed);
  }
  if (motion == 0) return rapid(*to);
  cut(*to, feed);
}

/// Where the probe touches is unknown.
void Interpreter::probe(ProbeKind kind) {
  std::optional<ToolPosition> to = target();
  if (!to) return;
  const double feed = straight_feed(*to);
  unsigned moved = position_.unknown & ~to->unknown;
  for (int axis = 0; axis < 3; ++axis)
    if (to->at[axis] != position_.at[axis]) moved |= 1u << axis;
  moved |= to->reference_axes;
  if (to->reference_axes != 0) add(step::Unresolved{"the target of a probe"});
  to->reference_axes = 0;
  const unsigned known = kAllAxes & ~to->unknown;
  const Point3 target = frame_.to_program(to->at);
  if (!add(step::Probe{to->at, mm_per_min(feed), kind})) return;
  path_.set_probed_axes(path_.size() - 1, moved, known, to->unknown);
  to->unknown |= moved;
  arrive(*to);
  for (int axis = 0; axis < 3; ++axis) {
    const bool unknown = (to->unknown >> axis & 1u) != 0;
    const ParameterValue contact{target[axis] / modes_.scale, unknown};
    parameters_.set_number(kContact + axis, contact);
    if (program_.dialect == GcodeDialect::mach3) parameters_.set_number(kMachContact + axis, contact);
  }
  const bool may_miss = kind == ProbeKind::contact || kind == ProbeKind::release;
  parameters_.set_number(kProbeSuccess, {1.0, may_miss});
}

/// The target of the line's axis words, which are marked as used. Nothing with an error if it is too far
/// away.
std::optional<ToolPosition> Interpreter::target() {
  ToolPosition to = position_;
  if (frame_.only_shifted && !modes_.diameters) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
      if (!word) continue;
      const double value = *word * modes_.scale;
      to.at[axis] = modes_.absolute ? value + frame_.shift[axis] : position_.at[axis] + value;
      if (modes_.absolute) to.unknown &= ~(1u << axis);
      named_ |= 1u << axis;
    }
  } else {
    to = target_in_frame();
  }
  named_ |= take_rotary_words() << 3;
  if (line_.unknown_letters() != 0) mark_measured(to);
  if (!reachable(to.at)) return std::nullopt;
  return to;
}

/// The axes whose words depend on values known only at run time are unknown.
void Interpreter::mark_measured(ToolPosition& to) const {
  for (int axis = 0; axis < 3; ++axis)
    if ((line_.unknown_letters() & LineWords::bit(static_cast<char>('X' + axis))) != 0)
      to.reference_axes |= 1u << axis;
  if (to.reference_axes == 0) return;
  to.reference = Reference::measured;
  to.unknown |= to.reference_axes;
}

/// Takes A, B and C; returns which of them the line has, as bits.
unsigned Interpreter::take_rotary_words() {
  rotary_from_ = rotary_;
  rotary_unknown_from_ = rotary_unknown_;
  if (!line_.has_unused(kRotaryLetters)) return 0;
  rotary_used_ = true;
  unsigned named = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto word = line_.take(static_cast<char>('A' + axis));
    if (!word) continue;
    named |= 1u << axis;
    rotary_axes_ |= 1u << axis;
    rotary_[axis] = modes_.absolute ? *word : rotary_[axis] + *word;
    if (modes_.absolute) rotary_unknown_ &= ~(1u << axis);
  }
  return named;
}

/// The same for rotated or scaled coordinates and for X words that are diameters.
ToolPosition Interpreter::target_in_frame() {
  ToolPosition to = position_;
  Point3 program = frame_.to_program(position_.at);
  bool any = false;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    const double value = *word * modes_.scale * (axis == 0 && modes_.diameters ? 0.5 : 1.0);
    program[axis] = modes_.absolute ? value : program[axis] + value;
    if (modes_.absolute) to.unknown &= ~(1u << axis);
    named_ |= 1u << axis;
    any = true;
  }
  if (any) to.at = frame_.to_path(program);
  if ((named_ & 3u) != 0 && frame_.rotation != 0.0) named_ |= 3u;
  return to;
}

/// "@10 ^45": radius and angle about the work zero instead of X and Y.
void Interpreter::polar() {
  const Point3 from = frame_.to_program(position_.at);
  double radius = std::hypot(from.x, from.y);
  const bool at_zero = radius < kPolarZero;
  if (at_zero && (!line_.polar_angle() || !modes_.absolute)) {
    reporter_.error(codes::polar_from_zero, line_.column(),
                    "polar coordinates have no angle at the work zero; the line is skipped");
    return line_.use(kAllLetters);
  }
  double angle = at_zero ? 0.0 : std::atan2(from.y, from.x) / kDegree;
  polar_step_ = {line_.polar_radius().value_or(0.0) * modes_.scale, line_.polar_angle().value_or(0.0)};
  if (line_.polar_radius()) radius = *line_.polar_radius() * modes_.scale + (modes_.absolute ? 0.0 : radius);
  if (line_.polar_angle()) angle = *line_.polar_angle() + (modes_.absolute ? 0.0 : angle);
  const Point3 base = modes_.absolute ? Point3{} : from;
  line_.set('X', (radius * std::cos(angle * kDegree) - base.x) / modes_.scale);
  line_.set('Y', (radius * std::sin(angle * kDegree) - base.y) / modes_.scale);
}

/// As target(), in machine coordinates; the position in work coordinates is unknown after it.
std::optional<ToolPosition> Interpreter::machine_target() {
  if (!modes_.absolute)
    reporter_.unusual(codes::g53_incremental, line_.column(Group::machine_coordinates),
                      "machine coordinates are absolute; G91 does not apply to them");
  ToolPosition to = position_;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    to.at[axis] = *word * modes_.scale;
    to.unknown |= 1u << axis;
    to.reference_axes |= 1u << axis;
    to.reference = Reference::machine;
    named_ |= 1u << axis;
  }
  named_ |= take_rotary_words() << 3;
  if (line_.unknown_letters() != 0) mark_measured(to);
  if (!reachable(to.at)) return std::nullopt;
  return to;
}

bool Interpreter::reachable(Point3 p) {
  if (within_limit(p)) return true;
  reporter_.error(codes::position_too_far, line_.column(),
                  fmt::format("a position is farther than {:g} mm from the work zero; the motion is skipped",
                              kMaxCoordinate));
  line_.use(kAllLetters);
  return false;
}

/// Length in mm, from which an inverse time feed is computed; 0 in the other feed modes.
double Interpreter::straight_length(const ToolPosition& to) const {
  if (modes_.feed_mode != FeedMode::inverse_time) return 0.0;
  return distance(position_.at, to.at);
}

/// Feed of a straight motion. If only rotary axes move, it is in degrees per minute, whatever the unit of
/// lengths; in inverse time it is unknown (0) if the angle is.
double Interpreter::straight_feed(const ToolPosition& to) {
  double square = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    square += (rotary_[axis] - rotary_from_[axis]) * (rotary_[axis] - rotary_from_[axis]);
  const bool from_unknown = (rotary_unknown_from_ & ~rotary_unknown_) != 0;
  const bool turns = square > 0.0 || from_unknown;
  if (!turns || !(to.at == position_.at) || to.unknown != position_.unknown)
    return feed_for(straight_length(to));
  if (modes_.feed_mode == FeedMode::per_minute) return feed_for(0.0) / modes_.scale;
  if (!from_unknown || modes_.feed_mode == FeedMode::per_turn) return feed_for(std::sqrt(square));
  reporter_.unusual(codes::no_feed, line_.column(),
                    "an inverse time feed (G93) from an unknown angle: the feed is unknown",
                    "move the rotary axis to a known angle first (G0 A0)");
  no_feed_reported_ = true;
  return 0.0;
}

/// Feed in mm/min of a motion of `length` mm; 0 with a single warning if the program has none.
double Interpreter::feed_for(double length) {
  const bool inverse = modes_.feed_mode == FeedMode::inverse_time;
  const double given = inverse && !line_.has('F') ? 0.0 : modes_.feed;  // in inverse time F is not modal
  const double feed = feed_per_minute(modes_.feed_mode, given, length, modes_.speed);
  if (!(feed > 0.0)) {
    if (!no_feed_reported_)
      reporter_.unusual(codes::no_feed, line_.column(),
                        inverse ? "in inverse time (G93) each cut needs an F word on its own line"
                                : "a cut before any feed",
                        inverse ? "put an F word on the line" : "put an F word before the first G1");
    no_feed_reported_ = true;
    return 0.0;
  }
  no_feed_reported_ = false;
  if (std::exchange(feed_mode_repeated_, false) && !inverse)
    reporter_.unusual(codes::word_missing, line_.column(),
                      "a cut without an F word since the last G94 or G95, after which LinuxCNC has no feed",
                      "put an F word on the line of the G94");
  return speed_factor_ * feed;
}

// ---- codes that use the axis words themselves

void Interpreter::use_reference() {
  const bool printer = is_printer();
  if (printer) return printer_reference();
  switch (line_.code(Group::reference)) {
    case 100: return set_data();
    case 280: return go_home(home_28_, Reference::home);
    case 300: return go_home(home_30_, Reference::second_home);
    case 281:
      if (program_.dialect == GcodeDialect::mach3) return reference_axes();
      return set_home(kHome28, home_28_);
    case 301: return set_home(kHome30, home_30_);
    case 520: return shift_locally();
    case 920: return shift_zero();
    case 921:
    case 922:
    case 923: return end_shift(line_.code(Group::reference));
    default: line_.use(kAllLetters); return;
  }
}

/// Mach3's G28.1 runs the named axes to their switches; where these are in work coordinates is unknown.
void Interpreter::reference_axes() {
  const bool all = !line_.has_any(kAxisLetters | kRotaryLetters);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (all ? (rotary_axes_ >> axis & 1u) != 0 : line_.has(static_cast<char>('A' + axis)))
      rotary_unknown_ |= 1u << axis;
  if (all || line_.has_any(kAxisLetters)) run_to_end_switches();
  line_.use(kAxisLetters | kRotaryLetters);
}

/// Controllers stop where the work zero is shifted: at G10, G52 and G92, and where G54 to G59.3 select
/// another system.
void Interpreter::note_stop() {
  if (line_.has(Group::coordinates) && line_.code(Group::coordinates) != work_offset_) {
    work_offset_ = line_.code(Group::coordinates);
    starts_at_rest_ = true;
  }
  if (!line_.has(Group::reference)) return;
  const Tenths code = line_.code(Group::reference);
  starts_at_rest_ = starts_at_rest_ || code == 100 || code == 520 || (code >= 920 && code <= 923);
}

/// Through the intermediate point to the home; the named axes, or all. Homes of rotary axes are unknown.
void Interpreter::go_home(const ToolPosition& home, Reference reference) {
  unsigned axes = 0, rotary = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (line_.unused(static_cast<char>('X' + axis))) axes |= 1u << axis;
    if (line_.unused(static_cast<char>('A' + axis))) rotary |= 1u << axis;
  }
  if (axes == 0 && rotary == 0) {
    axes = kAllAxes;
    rotary = rotary_axes_;
  }
  std::optional<ToolPosition> to = target();
  if (!to) return;
  rapid(*to);
  Point3 end = frame_.to_program(to->at);  // axes are those of the program
  const Point3 home_in_program = frame_.to_program(home.at);
  for (int axis = 0; axis < 3; ++axis) {
    const unsigned bit = 1u << axis;
    if ((axes & bit) == 0) continue;
    end[axis] = home_in_program[axis];
    if (frame_.only_shifted) to->at[axis] = home.at[axis];
    to->unknown = (to->unknown & ~bit) | (home.unknown & bit);
  }
  if (!frame_.only_shifted) to->at = frame_.to_path(end);
  to->reference = reference;
  to->reference_axes = axes & to->unknown;
  take_assigned_home(reference == Reference::home ? kHome28 : kHome30, axes, rotary, *to);
  rotary_unknown_ |= rotary;
  rotary_reference_ = rotary;
  rapid(*to);
}

/// Homes that the program has assigned to parameters are machine coordinates, as after G53. A home of which
/// only some axes were assigned, or from probed values, is known to the controller alone.
void Interpreter::take_assigned_home(int first, unsigned axes, unsigned rotary, ToolPosition& to) const {
  const unsigned moved = axes | rotary << 3;
  unsigned assigned = 0, measured = 0;
  for (int axis = 0; axis < 6; ++axis) {
    const unsigned bit = 1u << axis & moved;
    if (bit == 0 || !parameters_.is_assigned(first + axis)) continue;
    assigned |= bit;
    if (parameters_.number(first + axis)->unknown) measured |= bit;
    if (axis < 3) to.at[axis] = parameters_.slot(first + axis);
  }
  if (assigned == 0) return;
  to.unknown |= axes;
  to.reference_axes = axes;
  to.reference = assigned == moved && rotary == 0 && measured == 0 ? Reference::machine : Reference::measured;
}

// ---- steps

void Interpreter::rapid(const ToolPosition& to) {
  if (add(step::Rapid{to.at})) arrive(to);
}

void Interpreter::cut(const ToolPosition& to, double feed) {
  if (add(step::Cut{to.at, mm_per_min(feed)})) arrive(to);
}

void Interpreter::set_motion_extra() {
  MotionExtra extra;
  if (rotary_used_)
    extra = {.abc = rotary_, .unknown_abc = rotary_unknown_, .reference_abc = rotary_reference_};
  extra.lock = lock_;
  const double feed = path_[path_.size() - 1].feed().mm_per_min();
  if (lock_ != SpindleLock::none && modes_.speed > 0.0) extra.per_turn = feed / modes_.speed;
  path_.set_extra(path_.size() - 1, std::move(extra));
}

/// A cut that depends on the spindle's angle.
void Interpreter::locked_cut(const ToolPosition& to, double feed, SpindleLock lock) {
  lock_ = lock;
  cut(to, feed);
  lock_ = SpindleLock::none;
}

void Interpreter::arrive(const ToolPosition& to) {
  if (to.unknown != 0) path_.set_unknown_axes(path_.size() - 1, to.unknown);
  if (to.reference_axes != 0 || rotary_reference_ != 0)
    path_.set_reference(path_.size() - 1, to.reference, to.reference_axes);
  if (named_ != 0) path_.set_named_axes(path_.size() - 1, named_);
  if (rotary_used_ || lock_ != SpindleLock::none) set_motion_extra();
  rotary_reference_ = 0;
  if (starts_at_rest_) path_.set_rests_before(path_.size() - 1);
  starts_at_rest_ = false;
  position_ = to;
  position_.reference_axes = 0;
  tool_comments_.motion();
  change_at_pause_.reset();
  changed_without_motion_ = false;
  if (described_ && path_[path_.size() - 1].is_cutting()) assign_description(modes_.tool.value_or(0));
  if (moved_) return;
  moved_ = true;
  use_pending_comments();
  program_.inch = modes_.scale != 1.0;
}

}  // namespace kerf::gcode

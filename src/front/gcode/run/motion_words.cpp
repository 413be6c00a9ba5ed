// Which motion the words of a line are; straight motions and probes.
#include "front/gcode/run/motion_words.h"

#include <cmath>
#include <fmt/format.h>

#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

constexpr std::uint32_t kArcLetters =
    LineWords::bit('I') | LineWords::bit('J') | LineWords::bit('K') | LineWords::bit('R');

constexpr int kContact = 5061, kProbeSuccess = 5070;  // parameters with the result of a probe
constexpr int kMachContact = 2000;                    // of Mach3

}  // namespace

void MotionWords::run_line() {
  const bool stated = line_.has(Group::motion);
  if (stated) {
    const Tenths code = line_.code(Group::motion);
    const CodeEntry* entry = find_g_code(code);
    const bool cancels = code == kNoMotion;
    const bool was_straight = modes_.motion == 0 || modes_.motion == 10;
    if ((is_cycle(code) && !is_cycle(modes_.motion)) || (cancels && was_straight))
      motion_before_cycle_ = modes_.motion;
    if (!cancels && !is_cycle(code)) motion_before_cycle_ = kMotionNotGiven;
    modes_.motion = entry->support == Support::read ? code : kMotionUnsupported;
    if (!is_cycle(modes_.motion)) cycles_.end();
    if (modes_.motion != 50) splines_.forget_tangent();
    if (modes_.motion == kMotionUnsupported) return line_.use(kAllLetters);
  }
  if (stated && (modes_.motion == 52 || modes_.motion == 53)) return splines_.curve(modes_.motion);
  if (line_.has(Group::reference)) {
    const Tenths code = line_.code(Group::reference);
    if (is_circular_pocket(code)) return pockets_.mill();
    if (is_hole_pattern(code)) return cycles_.pattern(code, modes_.motion);
  }
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

void MotionWords::run_motion(Tenths motion) {
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
  if (is_arc(motion)) return arcs_.arc(motion == 20 ? Turn::cw : Turn::ccw);
  if (is_probe(motion)) return probe(static_cast<ProbeKind>(motion - 382));
  if (motion == kSkip) return probe(ProbeKind::contact);
  if (is_spline(motion)) return splines_.curve(motion);
  if (is_thread(motion)) return threads_.spindle_motion(motion);
  if (motion == kThreadCycle) return threads_.cycle();
  cycles_.cycle(motion);
}

/// On Fanuc's and Haas' controls cycles are a modal group of their own: after G80 the motion before the cycle
/// is in force again. Fusion's programs for other controllers rely on it too.
bool MotionWords::may_move_after_cancel() {
  const bool known = motion_before_cycle_ == 0 || motion_before_cycle_ == 10;
  if (!known) return false;
  if (is_fanuc(program_.dialect)) return true;
  if (program_.dialect != GcodeDialect::grbl && options_.dialect) return false;
  reporter_.unusual(
      codes::no_motion_mode, line_.column(),
      fmt::format("axis words after G80, which {} refuses; read with the {} before it, as Fanuc and Haas do",
                  to_string(program_.dialect), code_text('G', motion_before_cycle_)),
      "put G0 or G1 on the line, or read the program with --dialect fanuc");
  return true;
}

void MotionWords::straight(Tenths motion) {
  const std::optional<ToolPosition> to =
      line_.has(Group::machine_coordinates) ? mover_.machine_target() : mover_.target();
  if (!to) return;
  const double feed = motion == 0 ? 0.0 : feeds_.straight_feed(*to);
  if (line_.unused('E')) return printer_.extrude(*to, motion == 0 ? feeds_.factor() * modes_.feed : feed);
  compensation_.stop_leaving();
  corners_.turn_to(*to);
  if (motion == 10 && corners_.hold(*to, feed)) return;
  if (compensation_.is_on()) {
    mover_.set_named(0);
    return compensation_.line(*to, motion == 0 ? MotionKind::rapid : MotionKind::cut, feed);
  }
  if (motion == 0) return mover_.rapid(*to);
  mover_.cut(*to, feed);
}

/// Where the probe touches is unknown.
void MotionWords::probe(ProbeKind kind) {
  std::optional<ToolPosition> to = mover_.target();
  if (!to) return;
  const double feed = feeds_.straight_feed(*to);
  unsigned moved = position_.unknown & ~to->unknown;
  for (int axis = 0; axis < 3; ++axis)
    if (to->at[axis] != position_.at[axis]) moved |= 1u << axis;
  moved |= to->reference_axes;
  if (to->reference_axes != 0) add(step::Unresolved{"the target of a probe"});
  to->reference_axes = 0;
  const unsigned known = kAllAxes & ~to->unknown;
  const Point3 target = coordinates_.frame().to_program(to->at);
  if (!add(step::Probe{to->at, mm_per_min(feed), kind})) return;
  path_.set_probed_axes(path_.size() - 1, moved, known, to->unknown);
  to->unknown |= moved;
  mover_.arrive(*to);
  for (int axis = 0; axis < 3; ++axis) {
    const bool unknown = (to->unknown >> axis & 1u) != 0;
    const ParameterValue contact{target[axis] / modes_.scale, unknown};
    parameters_.set_number(kContact + axis, contact);
    if (program_.dialect == GcodeDialect::mach3) parameters_.set_number(kMachContact + axis, contact);
  }
  const bool may_miss = kind == ProbeKind::contact || kind == ProbeKind::release;
  parameters_.set_number(kProbeSuccess, {1.0, may_miss});
}

/// Words whose value is known only at run time. The targets of straight motions are unknown
/// then (see mover_.target()); anything else cannot be represented.
void MotionWords::note_unknown_words() {
  const std::uint32_t letters = line_.unknown_letters();
  std::uint32_t column = line_.column();
  std::string which;
  for (char letter = 'A'; letter <= 'Z'; ++letter) {
    if ((letters & LineWords::bit(letter)) == 0) continue;
    if (which.empty() && line_.has(letter)) column = line_.column(letter);
    which += fmt::format("{}{}", which.empty() ? "" : ", ", letter);
  }
  reporter_.unusual(
      codes::value_unknown, column,
      fmt::format("{} depends on a value known only at run time, such as a probed position", which));
  const Tenths motion = line_.has(Group::motion) ? line_.code(Group::motion) : modes_.motion;
  const bool straight = motion == 0 || motion == 10 || is_probe(motion);
  if ((letters & ~kAxisLetters) != 0 || !straight || line_.has(Group::reference) ||
      !coordinates_.frame().only_shifted)
    add(step::Unresolved{fmt::format("the value of {}", which)});
}

/// A code that is not known may be a motion: the words of its line belong to it, and the tool may be anywhere
/// after it.
void MotionWords::leave_out_motion() {
  line_.use(kAllLetters);
  leave_out(line_.unknown_g_code());
}

/// An M code that is not known may run a macro; the motion of its line follows.
void MotionWords::leave_out(const std::string& code) {
  add(step::Unresolved{code, UnresolvedKind::code});
  coordinates_.lose(kAllAxes);
  rotary_.lose(kAllAxes);
}

}  // namespace kerf::gcode

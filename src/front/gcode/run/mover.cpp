// Targets of axis words, and the motions to them.
#include "front/gcode/run/mover.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kPolarZero = 1e-9;  // mm

}  // namespace

/// The target of the line's axis words, which are marked as used. Nothing with an error if it is too far
/// away.
std::optional<ToolPosition> Mover::target() {
  ToolPosition to = position_;
  if (coordinates_.frame().only_shifted && !modes_.diameters) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
      if (!word) continue;
      const double value = *word * modes_.scale;
      to.at[axis] = modes_.absolute ? value + coordinates_.frame().shift[axis] : position_.at[axis] + value;
      if (modes_.absolute) to.unknown &= ~(1u << axis);
      named_ |= 1u << axis;
    }
  } else {
    to = target_in_frame();
  }
  named_ |= rotary_.take_words() << 3;
  if (line_.unknown_letters() != 0) mark_measured(to);
  if (!reachable(to.at)) return std::nullopt;
  return to;
}

/// The axes whose words depend on values known only at run time are unknown.
void Mover::mark_measured(ToolPosition& to) const {
  for (int axis = 0; axis < 3; ++axis)
    if ((line_.unknown_letters() & LineWords::bit(static_cast<char>('X' + axis))) != 0)
      to.reference_axes |= 1u << axis;
  if (to.reference_axes == 0) return;
  to.reference = Reference::measured;
  to.unknown |= to.reference_axes;
}

/// The same for rotated or scaled coordinates and for X words that are diameters.
ToolPosition Mover::target_in_frame() {
  ToolPosition to = position_;
  Point3 program = coordinates_.frame().to_program(position_.at);
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
  if (any) to.at = coordinates_.frame().to_path(program);
  if ((named_ & 3u) != 0 && coordinates_.frame().rotation != 0.0) named_ |= 3u;
  return to;
}

/// "@10 ^45": radius and angle about the work zero instead of X and Y.
void Mover::use_polar_words() {
  const Point3 from = coordinates_.frame().to_program(position_.at);
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

void Mover::use_polar_mode() {
  const bool both = line_.has('X') && line_.has('Y');
  if (modes_.plane != Plane::xy || !modes_.absolute) {
    reporter_.error(
        codes::code_unsupported, line_.column(),
        "polar coordinates (G16) are read in the XY plane and with G90 only; the line is skipped");
    return line_.use(kAllLetters);
  }
  const Point2 centre = *modes_.polar_centre;
  const Point2 from = coordinates_.frame().to_program(position_.at).xy() - centre;
  constexpr unsigned kPlaneAxes = 3;
  if (!both && (position_.unknown & kPlaneAxes) != 0) {
    reporter_.error(codes::polar_from_zero, line_.column(),
                    "the radius or the angle of the position is unknown; the line is skipped",
                    "write both words");
    return line_.use(kAllLetters);
  }
  const double radius = line_.has('X') ? line_.value('X') * modes_.scale : std::hypot(from.x, from.y);
  const double angle = line_.has('Y') ? line_.value('Y') * kDegree : std::atan2(from.y, from.x);
  line_.set('X', (centre.x + radius * std::cos(angle)) / modes_.scale);
  line_.set('Y', (centre.y + radius * std::sin(angle)) / modes_.scale);
}

/// As target(), in machine coordinates; the position in work coordinates is unknown after it.
std::optional<ToolPosition> Mover::machine_target() {
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
  named_ |= rotary_.take_words() << 3;
  if (line_.unknown_letters() != 0) mark_measured(to);
  if (!reachable(to.at)) return std::nullopt;
  return to;
}

/// Controllers stop where the work zero is shifted: at G10, G52 and G92, and where G54 to G59.3 select
/// another system.
void Mover::note_stop() {
  if (line_.has(Group::coordinates) && line_.code(Group::coordinates) != work_offset_) {
    work_offset_ = line_.code(Group::coordinates);
    starts_at_rest_ = true;
  }
  if (!line_.has(Group::reference)) return;
  const Tenths code = line_.code(Group::reference);
  starts_at_rest_ = starts_at_rest_ || code == 100 || code == 520 || (code >= 920 && code <= 923);
}

void Mover::rapid(const ToolPosition& to) {
  if (add(step::Rapid{to.at})) arrive(to);
}

void Mover::cut(const ToolPosition& to, double feed) {
  if (add(step::Cut{to.at, mm_per_min(feed)})) arrive(to);
}

void Mover::set_extra() {
  MotionExtra extra;
  rotary_.set_extra(extra);
  extra.lock = lock_;
  extra.per_turn = per_turn_;
  path_.set_extra(path_.size() - 1, std::move(extra));
}

/// A cut that depends on the spindle's angle: its feed follows from the speed of the spindle, if that is
/// known.
void Mover::locked_cut(const ToolPosition& to, double per_turn, SpindleLock lock) {
  lock_ = lock;
  per_turn_ = per_turn;
  cut(to, per_turn * modes_.rpm());
  lock_ = SpindleLock::none;
  per_turn_ = 0.0;
}

/// A cut of a tapping cycle, whose feed is given; without a lock a plain cut.
void Mover::tapping_cut(const ToolPosition& to, double feed, SpindleLock lock) {
  lock_ = lock;
  if (lock != SpindleLock::none && modes_.rpm() > 0.0) per_turn_ = feed / modes_.rpm();
  cut(to, feed);
  lock_ = SpindleLock::none;
  per_turn_ = 0.0;
}

void Mover::arrive(const ToolPosition& to) {
  if (to.unknown != 0) path_.set_unknown_axes(path_.size() - 1, to.unknown);
  if (to.reference_axes != 0 || rotary_.reference() != 0)
    path_.set_reference(path_.size() - 1, to.reference, to.reference_axes);
  if (named_ != 0) path_.set_named_axes(path_.size() - 1, named_);
  if (rotary_.used() || lock_ != SpindleLock::none) set_extra();
  rotary_.arrive();
  if (starts_at_rest_) path_.set_rests_before(path_.size() - 1);
  starts_at_rest_ = false;
  position_ = to;
  position_.reference_axes = 0;
  comments_.motion();
  if (moved_) return;
  moved_ = true;
  comments_.first_motion();
  program_.inch = modes_.scale != 1.0;
}

}  // namespace kerf::gcode

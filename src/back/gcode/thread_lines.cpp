// Motions that depend on the spindle's angle: G33, G33.1, and tapping cycles.
#include "back/gcode/thread_lines.h"

#include <cmath>
#include <fmt/format.h>

#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

/// G codes in tenths.
constexpr int kThread = 330, kRigidTap = 331, kTap = 840, kLeftTap = 740, kReturnToStart = 980;

}  // namespace

SpindleLock ThreadLines::lock_of(std::size_t i) const {
  const MotionExtra* extra = path_.extra(i);
  return extra != nullptr ? extra->lock : SpindleLock::none;
}

/// The steps of a tap that starts with the cut `i`: reversal, dwell, the cut back to `start`, reversal.
/// Nothing if the steps are others.
std::optional<ThreadLines::Tap> ThreadLines::tap_at(std::size_t i, Point3 start) const {
  Tap tap;
  for (std::size_t k = i + 1; k < path_.size(); ++k) {
    const Step& s = path_[k];
    if (s.kind() == StepKind::dwell) {
      tap.dwell = s.dwell().time;
    } else if (s.kind() == StepKind::cut) {
      if (lock_of(k) != lock_of(i) || !(s.to() == start)) return std::nullopt;
      tap.end = k + 1;
      if (tap.end < path_.size() && path_[tap.end].kind() == StepKind::spindle) ++tap.end;
      return tap;
    } else if (s.kind() != StepKind::spindle) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

/// Writes a motion that depends on the spindle's angle; false if it is an ordinary cut.
bool ThreadLines::locked_motion(std::size_t i) {
  const SpindleLock lock = lock_of(i);
  if (lock == SpindleLock::none) return false;
  if (lock == SpindleLock::tap) return tapping_cycle(i);
  const bool rigid = lock == SpindleLock::rigid_tap;
  const std::optional<Tap> tap = rigid ? tap_at(i, position_.at) : std::nullopt;
  const Counts to = axes_.counts(path_[i].to());
  const auto pitch = std::llround(path_.extra(i)->per_turn * units_.grid.counts_per_mm);
  const unsigned axes = axes_.to_write(i, to);
  if (!profile_.has_g(rigid ? kRigidTap : kThread) || (rigid && !tap) || pitch <= 0 || axes == 0 ||
      axes_.by_distance(i, to) != 0) {
    report_unsupported(i, "the feed follows the angle of the spindle (a thread), which cannot be written");
    return true;
  }
  lines_.start_line();
  lines_.code('G', rigid ? kRigidTap : kThread);
  axes_.put(to, axes);
  lines_.word('K', pitch, units_.decimals);
  lines_.end_line(i);
  words_.forget_motion();
  if (tap)
    skip_to_ = tap->end;  // the controller returns to the start
  else
    axes_.arrive(i, to, axes);
  return true;
}

int ThreadLines::cycle() const { return spindle_.turn() == SpindleTurn::ccw ? kLeftTap : kTap; }

/// Whether cut `i`, from here, can be the way down of the controller's own cycle.
bool ThreadLines::can_cycle(std::size_t i, Point3 from) const {
  const Point3 way = path_[i].to() - from;
  return way.x == 0.0 && way.y == 0.0 && way.z < 0.0 && profile_.has_g(cycle()) && profile_.has_g(800) &&
         position_.unknown == 0 && path_[i].unknown_axes() == 0;
}

bool ThreadLines::tap_from_above(std::size_t i) {
  const Step& s = path_[i];
  const Point3 way = s.to() - position_.at;
  if (s.kind() != StepKind::rapid || s.unknown_axes() != 0 || way.x != 0.0 || way.y != 0.0 ||
      !(way.z < 0.0) || i + 1 >= path_.size() || path_[i + 1].kind() != StepKind::cut ||
      lock_of(i + 1) != SpindleLock::tap)
    return false;
  const std::optional<Tap> tap = tap_at(i + 1, position_.at);
  if (!tap || !can_cycle(i + 1, s.to()) || !profile_.has_g(kReturnToStart)) return false;
  put_tap(i + 1, *tap, axes_.counts(s.to())[2]);
  return true;
}

/// A tap with a floating holder as the controller's own cycle, else as cuts, with a warning.
bool ThreadLines::tapping_cycle(std::size_t i) {
  const std::optional<Tap> tap = tap_at(i, position_.at);
  if (tap && can_cycle(i, position_.at)) {
    put_tap(i, *tap, axes_.at()[2]);
    return true;
  }
  if (!reported_)
    diagnostics_
        .warning(
            codes::post_tap, path_.origin_of(i),
            "the controller has no such tapping cycle; it is written as cuts and reversals of the spindle")
        .hint = "use a floating tap holder, and a spindle that reverses";
  reported_ = true;
  return false;
}

/// Of the cut `i`, from here, which the cycle returns to, by the height `clearance`.
void ThreadLines::put_tap(std::size_t i, const Tap& tap, std::int64_t clearance) {
  lines_.start_line();
  if (profile_.has_g(kReturnToStart)) lines_.code('G', kReturnToStart);
  if (!words_.has_plane(Plane::xy)) lines_.code('G', 170);
  words_.set_plane(Plane::xy);
  lines_.code('G', cycle());
  axes_.put(axes_.counts(path_[i].to()), 4u);
  lines_.word('R', clearance, units_.decimals);
  if (tap.dwell > Duration{}) lines_.time_word(tap.dwell);
  words_.put_feed(i);
  lines_.end_line(i);
  lines_.start_line();
  lines_.code('G', 800);
  lines_.end_line(i);
  words_.forget_motion();
  skip_to_ = tap.end;
}

}  // namespace kerf::gcode

// Motions that depend on the spindle's angle: G33, G33.1, and tapping cycles.
#include <cmath>
#include <fmt/format.h>

#include "back/gcode/poster.h"
#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

constexpr int kThread = 330, kRigidTap = 331, kTap = 840, kLeftTap = 740;  // G codes in tenths

}  // namespace

SpindleLock Poster::lock_of(std::size_t i) const {
  const MotionExtra* extra = path_.extra(i);
  return extra != nullptr ? extra->lock : SpindleLock::none;
}

/// The steps of a tap that starts with the cut `i`: reversal, dwell, the cut back to its start, reversal.
/// Nothing if the steps are others.
std::optional<Poster::Tap> Poster::tap_at(std::size_t i) const {
  Tap tap;
  for (std::size_t k = i + 1; k < path_.size(); ++k) {
    const Step& s = path_[k];
    if (s.kind() == StepKind::dwell) {
      tap.dwell = s.dwell().time;
    } else if (s.kind() == StepKind::cut) {
      if (lock_of(k) != lock_of(i) || !(s.to() == position_.at)) return std::nullopt;
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
bool Poster::locked_motion(std::size_t i) {
  const SpindleLock lock = lock_of(i);
  if (lock == SpindleLock::none) return false;
  if (lock == SpindleLock::tap) return tapping_cycle(i);
  const bool rigid = lock == SpindleLock::rigid_tap;
  const std::optional<Tap> tap = rigid ? tap_at(i) : std::nullopt;
  const Counts to = grid_counts(path_[i].to());
  const auto pitch = std::llround(path_.extra(i)->per_turn * grid_.counts_per_mm);
  const unsigned axes = axes_to_write(i, to);
  if (!profile_.has_g(rigid ? kRigidTap : kThread) || (rigid && !tap) || pitch <= 0 || axes == 0 ||
      axes_by_distance(i, to) != 0) {
    report_unsupported(i, "the feed follows the angle of the spindle (a thread), which cannot be written");
    return true;
  }
  start_line();
  code('G', rigid ? kRigidTap : kThread);
  put_axes(to, axes);
  word('K', pitch, decimals_);
  end_line(i);
  motion_ = -1;
  if (tap)
    skip_to_ = tap->end;  // the controller returns to the start
  else
    arrive(i, to, axes);
  return true;
}

/// A tap with a floating holder as the controller's own cycle, else as cuts, with a warning.
bool Poster::tapping_cycle(std::size_t i) {
  const std::optional<Tap> tap = tap_at(i);
  const int cycle = spindle_.turn == SpindleTurn::ccw ? kLeftTap : kTap;
  const Point3 way = path_[i].to() - position_.at;
  const bool straight_down = way.x == 0.0 && way.y == 0.0 && way.z < 0.0;
  const bool own = tap && straight_down && profile_.has_g(cycle) && profile_.has_g(800) &&
                   position_.unknown == 0 && path_[i].unknown_axes() == 0;
  if (!own) {
    if (tap && !tap_reported_)
      diagnostics_
          .warning(
              codes::post_tap, path_.origin_of(i),
              "the controller has no such tapping cycle; it is written as cuts and reversals of the spindle")
          .hint = "use a floating tap holder, and a spindle that reverses";
    tap_reported_ = tap_reported_ || tap.has_value();
    return false;
  }
  put_tap(i, *tap, cycle);
  return true;
}

void Poster::put_tap(std::size_t i, const Tap& tap, int cycle) {
  start_line();
  if (plane_ != Plane::xy) code('G', 170);
  plane_ = Plane::xy;
  code('G', cycle);
  put_axes(grid_counts(path_[i].to()), 4u);
  word('R', at_[2], decimals_);
  if (tap.dwell > Duration{}) word('P', std::llround(tap.dwell.seconds() * 1000.0), 3);
  put_feed(i);
  end_line(i);
  start_line();
  code('G', 800);
  end_line(i);
  motion_ = -1;
  skip_to_ = tap.end;
}

}  // namespace kerf::gcode

// Spindle-synchronized motions: G33, G33.1 and the threading cycle G76.
//
// Source: LinuxCNC's pages "G33 Spindle Synchronized Motion", "G33.1 Rigid Tapping", "G76 Threading Cycle".
#include "front/gcode/run/thread_cycles.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/gcode.h"

#include "kerf/base/limits.h"

namespace kerf::gcode {

/// The tool moves by K per revolution; G33.1 then returns along the same path with the spindle reversed.
void ThreadCycles::spindle_motion(Tenths motion) {
  const ToolPosition from = position_;
  const std::optional<ToolPosition> to = mover_.target();
  const std::optional<double> pitch = line_.take('K');
  if (!pitch) {
    reporter_.error(
        codes::word_missing, line_.column(Group::motion),
        fmt::format("{} needs K, the distance per revolution of the spindle", code_text('G', motion)));
    return line_.use(kAllLetters);
  }
  if (!to) return;
  const double per_turn = std::abs(*pitch) * modes_.scale;
  const SpindleLock lock = motion == 330 ? SpindleLock::thread : SpindleLock::rigid_tap;
  mover_.locked_cut(*to, per_turn, lock);
  if (motion == 330) return;
  const SpindleTurn turn = modes_.spindle;
  spindle_.turn(turn == SpindleTurn::cw ? SpindleTurn::ccw : SpindleTurn::cw);
  mover_.locked_cut(from, per_turn, lock);
  spindle_.turn(turn);
}

/// The words of G76, in mm; depths are positive along `side`.
struct ThreadCycles::Thread {
  double pitch = 0.0, peak = 0.0, first = 0.0, full = 0.0;
  double fall = 1.0;    // degression of the depths of cut
  double slant = 0.0;   // tangent of the compound slide angle
  double spring = 0.0;  // additional passes at full depth
  double taper = 0.0;   // length of tapered ends
  bool tapered_entry = false, tapered_exit = false;
  double side = 1.0;  // direction of the cut in X: +1 for internal threads
  double way = 1.0;   // direction in Z

  bool is_valid() const {
    return pitch > 0.0 && peak != 0.0 && first > 0.0 && full > first && fall >= 1.0 && std::isfinite(slant) &&
           spring >= 0.0 && spring <= limits::kMaxThreadPasses && taper >= 0.0 &&
           std::pow(full / first, fall) <= limits::kMaxThreadPasses;
  }
};

ThreadCycles::Thread ThreadCycles::take_words() {
  const double in_x =
      modes_.scale * (modes_.diameters ? 0.5 : 1.0);  // with G7, I, J and K are diameters as X is
  Thread thread;
  thread.pitch = line_.take('P').value_or(0.0) * modes_.scale;
  thread.peak = line_.take('I').value_or(0.0) * in_x;
  thread.first = line_.take('J').value_or(0.0) * in_x;
  thread.full = line_.take('K').value_or(0.0) * in_x;
  thread.fall = line_.take('R').value_or(1.0);
  thread.slant = std::tan(line_.take('Q').value_or(0.0) * std::numbers::pi / 180.0);
  thread.spring = line_.take('H').value_or(0.0);
  thread.taper = line_.take('E').value_or(0.0) * modes_.scale;
  const double ends = line_.take('L').value_or(0.0);  // 1: tapered entry, 2: exit, 3: both
  thread.tapered_entry = thread.taper > 0.0 && (ends == 1.0 || ends == 3.0);
  thread.tapered_exit = thread.taper > 0.0 && (ends == 2.0 || ends == 3.0);
  thread.side = thread.peak > 0.0 ? 1.0 : -1.0;
  return thread;
}

/// One pass of a thread: infeed outside of the work, cut along Z at the pitch, retract.
void ThreadCycles::pass(const Thread& t, const ToolPosition& start, double end_z, double depth) {
  const double clear = start.at.x - t.side * (t.full - depth);
  const double bottom = start.at.x + t.side * (std::abs(t.peak) + depth);
  const double outside = bottom - t.side * t.full;  // X at the outer end of a taper
  const double at_taper = t.taper > 0.0 ? t.pitch * std::hypot(t.taper, t.full) / t.taper : t.pitch;
  const double start_z = start.at.z + t.way * depth * t.slant;
  const double last_z = end_z - t.way * (t.full - depth) * t.slant;
  ToolPosition at = start;
  const auto go = [&](double x, double z) {
    at.at.x = x;
    at.at.z = z;
    return at;
  };
  mover_.rapid(go(clear, start_z));
  if (t.tapered_entry) {
    mover_.locked_cut(go(outside, start_z), at_taper, SpindleLock::thread);
    mover_.locked_cut(go(bottom, start_z + t.way * t.taper), at_taper, SpindleLock::thread);
  } else {
    mover_.rapid(go(bottom, start_z));
  }
  mover_.locked_cut(go(bottom, t.tapered_exit ? last_z - t.way * t.taper : last_z), t.pitch,
                    SpindleLock::thread);
  if (t.tapered_exit) mover_.locked_cut(go(outside, last_z), at_taper, SpindleLock::thread);
  mover_.rapid(go(clear, last_z));
}

/// G76 P Z I J K R Q H E L: the n-th pass has the depth first * n^(1 / fall); fall = 2 gives constant chip
/// area.
void ThreadCycles::cycle() {
  Thread thread = take_words();
  const ToolPosition start = position_;
  const std::optional<ToolPosition> end = mover_.target();
  if (!end) return;
  thread.way = end->at.z < start.at.z ? -1.0 : 1.0;
  if (!thread.is_valid()) {
    reporter_.error(codes::word_out_of_range, line_.column(),
                    "G76 needs P (pitch), I, J, K above J, R from 1; skipped");
    return;
  }
  double depth = thread.first;
  for (int n = 2; depth < thread.full && !steps_.full(); ++n) {
    pass(thread, start, end->at.z, depth);
    depth = thread.first * std::pow(n, 1.0 / thread.fall);
  }
  for (int i = 0; i <= static_cast<int>(thread.spring) && !steps_.full(); ++i)
    pass(thread, start, end->at.z, thread.full);
  mover_.rapid(*end);
}

}  // namespace kerf::gcode

// Planning of a print: limits of each motion, speeds at corners, then the speeds that braking permits, from
// the last motion to the first and back.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "path/planner_texts.h"

#include "kerf/base/limits.h"
#include "kerf/path/estimate.h"

namespace kerf {
namespace {

constexpr double kNoLength = 1e-9;      // mm
constexpr double kMinLimit = 1e-3;      // mm/s, mm/s2: a limit of 0 would take for ever
constexpr double kStraight = 0.999999;  // cosine of a corner that needs no slowing down
constexpr Length kArcChord = mm(0.02);  // of arcs without filament
constexpr double kFilamentJump = 1.0;   // mm/s: Klipper's default of instantaneous_corner_velocity
constexpr double kSecondsPerMinute = 60.0;

using Axes = std::array<double, 4>;

struct Move {
  std::size_t step = 0;
  Axes way{};           // mm per mm of the motion
  double length = 0.0;  // mm: in X, Y and Z, or of the filament alone
  double speed = 0.0, acceleration = 0.0;
  double entry2 = 0.0;  // square of the speed at its start, at first the maximum at the corner
  double smooth = 0.0;  // mm2/s2: by how much the square of the speed changes at most, Klipper's smoothed one
  double peak2 = std::numeric_limits<double>::infinity();  // square of its highest speed, by smoothing
};

class PrintWalker {
 public:
  PrintWalker(const Toolpath& path, const PrintPlanner& planner)
      : path_(path), planner_(planner), seconds_(path.size()) {
    const double radius = 0.5 * planner.filament.mm();
    area_ = std::numbers::pi * radius * radius;
  }

  void run() {
    for (std::size_t i = 0; i < path_.size(); ++i) {
      const Step& s = path_[i];
      if (s.is_motion())
        motion(i);
      else if (s.kind() == StepKind::motion_limits)
        set(s.motion_limits());
      else if (s.kind() == StepKind::note)
        note(path_.text(i));
      else if (s.kind() == StepKind::verbatim)
        set_cruise(read_cruise_limit(path_.text(i)));
      else if (s.kind() == StepKind::dwell || s.kind() == StepKind::pause ||
               s.kind() == StepKind::tool_change ||
               (s.kind() == StepKind::temperature && s.temperature().wait))
        stop();
      if (s.kind() == StepKind::dwell) seconds_[i] += static_cast<float>(s.dwell().time.seconds());
      here_.pass(s);
    }
    stop();
  }

  std::vector<float>& seconds() { return seconds_; }
  std::size_t not_timed() const { return not_timed_; }

 private:
  void set(const step::MotionLimits& limits) {
    for (std::size_t k = 0; k < limits.values.size(); ++k) {
      if ((limits.given >> k & 1u) == 0) continue;
      const double value = std::max(limits.values[k], kMinLimit);
      switch (limits.kind) {
        case LimitKind::axis_acceleration: planner_.axis_acceleration[k] = value; break;
        case LimitKind::axis_speed: planner_.axis_speed[k] = value; break;
        case LimitKind::acceleration:
          if (k < 3) planner_.acceleration[k] = value;
          break;
        case LimitKind::jerk: planner_.jerk[k] = limits.values[k]; break;
        case LimitKind::junction_deviation: planner_.junction_deviation = limits.values[k]; break;
        case LimitKind::corner_speed: set_corner_speed(limits.values[k]); break;
      }
    }
  }

  /// Slicers take Klipper's speed at corners for a jerk.
  void set_corner_speed(double speed) {
    planner_.corner_speed = speed;
    if (planner_.corners == CornerRule::jerk) planner_.jerk[0] = planner_.jerk[1] = speed;
  }

  void note(std::string_view text) {
    if (const auto limits = read_limit_note(text)) set(*limits);
  }

  void set_cruise(const CruiseLimit& limit) {
    if (limit.ratio) planner_.cruise_ratio = *limit.ratio;
    if (limit.to_decel)
      planner_.cruise_ratio = 1.0 - std::min(1.0, *limit.to_decel / planner_.acceleration[0]);
  }

  void motion(std::size_t i) {
    const Step& s = path_[i];
    const double feed = s.kind() == StepKind::rapid ? std::numeric_limits<double>::infinity()
                                                    : s.feed().mm_per_min() / kSecondsPerMinute;
    if (s.reference() != Reference::work || !(feed > 0.0)) {
      ++not_timed_;
      return stop();
    }
    if (s.kind() == StepKind::arc) {
      const ArcWalk walk = walk_of(s, here_.at);
      const int chords = walk.chords(kArcChord, limits::kMaxChords);
      Point3 from = here_.at;
      for (int k = 1; k <= chords; ++k) {
        const Point3 to = k == chords ? s.to() : walk.at(k / static_cast<double>(chords));
        add(i, to - from, 0.0, feed);
        from = to;
      }
      return;
    }
    const double filament = s.kind() == StepKind::extrude ? path_.extrude(i).volume.mm3() / area_ : 0.0;
    Point3 way = s.to() - here_.at;
    for (int axis = 0; axis < 3; ++axis)  // from an unknown position: not timed on that axis
      if (((here_.unknown | s.unknown_axes()) >> axis & 1u) != 0) way[axis] = 0.0;
    add(i, way, filament, feed);
  }

  void add(std::size_t step, Point3 way, double filament, double feed) {
    Move move;
    move.step = step;
    const double distance = length(way);
    move.length = distance > kNoLength ? distance : std::abs(filament);
    if (!(move.length > kNoLength)) return;
    move.way = {way.x / move.length, way.y / move.length, way.z / move.length, filament / move.length};
    move.speed = feed;
    const bool filament_only = distance <= kNoLength;
    const std::size_t kind = filament_only ? 1 : filament > 0.0 ? 0 : 2;
    move.acceleration = planner_.acceleration[kind];
    for (std::size_t a = 0; a < 4; ++a) {
      const double part = std::abs(move.way[a]);
      if (part <= 0.0) continue;
      move.speed = std::min(move.speed, planner_.axis_speed[a] / part);
      // Klipper has no accelerations of X and Y.
      if (planner_.corners == CornerRule::square_corner && a < 2) continue;
      move.acceleration = std::min(move.acceleration, planner_.axis_acceleration[a] / part);
    }
    if (planner_.corners == CornerRule::square_corner)
      move.smooth = 2.0 * move.acceleration * (1.0 - planner_.cruise_ratio) * move.length;
    const double corner = moves_.empty() ? 0.0 : corner_speed(moves_.back(), move);
    // From rest, and to it, an axis may jump by its jerk.
    const double jump = planner_.corners == CornerRule::jerk ? jerk_speed(move.way, move.speed) : 0.0;
    const double entry = moves_.empty() ? jump : corner;
    move.entry2 = entry * entry;
    moves_.push_back(move);
  }

  /// The speed at which no axis changes by more than its jerk, when a motion starts from rest.
  double jerk_speed(const Axes& way, double speed) const {
    for (std::size_t a = 0; a < 4; ++a) {
      const double change = std::abs(way[a]) * speed;
      if (change > planner_.jerk[a]) speed *= planner_.jerk[a] / change;
    }
    return speed;
  }

  double corner_speed(const Move& before, const Move& after) const {
    double speed = std::min(before.speed, after.speed);
    if (planner_.corners == CornerRule::jerk) {
      double highest = speed;
      for (std::size_t a = 0; a < 4; ++a) {
        // Where an axis turns round it stops and starts: each of the two counts by itself.
        const bool turns = before.way[a] * after.way[a] < 0.0;
        const double change = speed * (turns ? std::max(std::abs(before.way[a]), std::abs(after.way[a]))
                                             : std::abs(after.way[a] - before.way[a]));
        if (change > planner_.jerk[a]) highest = std::min(highest, speed * planner_.jerk[a] / change);
      }
      const double from_rest =
          std::min(jerk_speed(before.way, before.speed), jerk_speed(after.way, after.speed));
      return std::max(highest, std::min(from_rest, speed));
    }
    double cosine = 0.0;  // of the change of direction
    double lengths[2] = {};
    for (std::size_t a = 0; a < 3; ++a) {
      cosine += before.way[a] * after.way[a];
      lengths[0] += before.way[a] * before.way[a];
      lengths[1] += after.way[a] * after.way[a];
    }
    if (lengths[0] == 0.0 || lengths[1] == 0.0) return 0.0;  // the filament alone
    if (planner_.corners == CornerRule::square_corner)
      speed = std::min(speed, kFilamentJump / std::max(std::abs(after.way[3] - before.way[3]), kNoLength));
    if (cosine >= kStraight) return speed;
    const double acceleration = std::min(before.acceleration, after.acceleration);
    const double half = std::sqrt(0.5 * (1.0 - cosine));  // sine of half the change of direction
    const double deep = std::sqrt(0.5 * (1.0 + cosine));  // sine of half the angle between the two
    if (half <= 0.0) return speed;
    const double deviation =
        planner_.corners == CornerRule::junction_deviation
            ? planner_.junction_deviation
            : planner_.corner_speed * planner_.corner_speed * (std::numbers::sqrt2 - 1.0) / acceleration;
    double speed2 = acceleration * deviation * deep / (1.0 - deep);
    if (planner_.corners == CornerRule::square_corner)  // no arc longer than half of a motion
      speed2 = std::min(speed2, 0.5 * std::min(before.length, after.length) * deep / half * acceleration);
    return std::min(speed, std::sqrt(speed2));
  }

  /// The machine comes to rest: all motions so far are planned and timed.
  void stop() {
    double exit2 = 0.0;
    if (!moves_.empty() && planner_.corners == CornerRule::jerk) {
      const double jump = jerk_speed(moves_.back().way, moves_.back().speed);
      exit2 = jump * jump;
    }
    if (planner_.corners == CornerRule::square_corner) smooth();
    const double last = exit2;
    for (std::size_t k = moves_.size(); k-- > 0;) {
      Move& m = moves_[k];
      m.entry2 = std::min({m.entry2, m.peak2, k > 0 ? moves_[k - 1].peak2 : m.peak2});
      m.entry2 = std::min(m.entry2, exit2 + 2.0 * m.acceleration * m.length);
      exit2 = m.entry2;
    }
    for (std::size_t k = 0; k < moves_.size(); ++k) {
      const Move& m = moves_[k];
      const bool is_last = k + 1 == moves_.size();
      double out2 = is_last ? last : moves_[k + 1].entry2;
      out2 = std::min(out2, m.entry2 + 2.0 * m.acceleration * m.length);
      if (!is_last) moves_[k + 1].entry2 = out2;
      seconds_[m.step] += static_cast<float>(time_of(m, out2));
    }
    moves_.clear();
  }

  /// Klipper's second plan, by the lower acceleration that its minimum cruise ratio leaves: each rise and the
  /// fall behind it get no faster than in that plan, so that short motions to and fro stay slow.
  void smooth() {
    const std::size_t count = moves_.size();
    std::vector<double> speed2(count + 1, 0.0);  // at the start of each motion, in that plan
    for (std::size_t k = 1; k < count; ++k)
      speed2[k] = std::min(moves_[k].entry2, speed2[k - 1] + moves_[k - 1].smooth);
    for (std::size_t k = count; k-- > 0;) speed2[k] = std::min(speed2[k], speed2[k + 1] + moves_[k].smooth);
    const auto rises = [&](std::size_t k) { return speed2[k + 1] >= speed2[k] + moves_[k].smooth; };
    const auto falls = [&](std::size_t k) { return speed2[k] >= speed2[k + 1] + moves_[k].smooth; };
    for (std::size_t k = count; k-- > 0;) {  // what rises, up to its peak
      Move& m = moves_[k];
      if (falls(k)) continue;
      const bool peak_behind = k + 1 == count || falls(k + 1);
      if (!rises(k))
        m.peak2 = std::min(m.speed * m.speed, 0.5 * (speed2[k] + speed2[k + 1] + m.smooth));
      else
        m.peak2 = peak_behind ? speed2[k + 1] : moves_[k + 1].peak2;
    }
    for (std::size_t k = 1; k < count; ++k)  // what falls, from its peak
      if (falls(k)) moves_[k].peak2 = moves_[k - 1].peak2;
  }

  static double time_of(const Move& m, double exit2) {
    const double entry = std::sqrt(m.entry2), exit = std::sqrt(exit2), a = m.acceleration;
    const double top2 = std::min({m.speed * m.speed, m.peak2, 0.5 * (m.entry2 + exit2) + a * m.length});
    const double top = std::sqrt(top2);
    const double ramps = (2.0 * top2 - m.entry2 - exit2) / (2.0 * a);
    return (2.0 * top - entry - exit) / a + std::max(m.length - ramps, 0.0) / top;
  }

  const Toolpath& path_;
  PrintPlanner planner_;
  std::vector<float> seconds_;
  std::vector<Move> moves_;  // since the last stop
  PathPosition here_;
  double area_ = 1.0;  // mm2, of the filament
  std::size_t not_timed_ = 0;
};

}  // namespace

PrintPlanner default_planner(const Toolpath& path, Length filament) {
  PrintPlanner planner;
  planner.filament = filament;
  bool by_slicer = false;  // which plans by jerk for all firmwares
  for (std::size_t i = 0; i < path.size(); ++i) {
    std::optional<LimitKind> kind;
    if (path[i].kind() == StepKind::motion_limits) kind = path[i].motion_limits().kind;
    if (path[i].kind() == StepKind::note) {
      const auto limits = read_limit_note(path.text(i));
      by_slicer = by_slicer || limits;
      if (limits) kind = limits->kind;
      if (path.text(i) == kKlipperNote) kind = LimitKind::corner_speed;
    }
    if (kind == LimitKind::corner_speed && !by_slicer) planner.corners = CornerRule::square_corner;
    if (kind == LimitKind::junction_deviation) planner.corners = CornerRule::junction_deviation;
    if (planner.corners != CornerRule::jerk) break;
  }
  return planner;
}

std::vector<float> print_seconds(const Toolpath& path, const PrintPlanner& planner) {
  PrintWalker walker(path, planner);
  walker.run();
  return std::move(walker.seconds());
}

PrintTime estimate_print_time(const Toolpath& path, const PrintPlanner& planner) {
  PrintWalker walker(path, planner);
  walker.run();
  PrintTime time;
  time.not_timed = walker.not_timed();
  Point2 from;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& s = path[i];
    const Duration step_time = seconds(static_cast<double>(walker.seconds()[i]));
    if (s.kind() == StepKind::dwell) time.dwell = time.dwell + step_time;
    if (!s.is_motion()) continue;
    time.motion = time.motion + step_time;
    const bool extrudes = s.kind() == StepKind::extrude;
    Duration* part = extrudes ? &time.retraction : &time.travel;
    if (extrudes && path.extrude(i).volume > Volume() && !(from == s.to().xy()))
      part = &time.beads[static_cast<std::size_t>(path.extrude(i).kind)];
    *part = *part + step_time;
    from = s.to().xy();
  }
  return time;
}

}  // namespace kerf

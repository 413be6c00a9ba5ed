// Converts steps to planned motions and stops; their times by tool and operation.
#include "kerf/path/estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "path/operation_times.h"
#include "path/planner.h"
#include "path/rotary_way.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxOperations = 1000;       // listed, see estimate.h
constexpr std::size_t kMaxChords = 65'535;         // of an arc; GRBL counts them in 16 bits
constexpr std::size_t kChordBudget = 100'000'000;  // of all arcs; beyond it each gets few
constexpr std::size_t kFewChords = 64;

/// Number of chords of an arc within `tolerance`, rounded down as in GRBL.
std::size_t chords_of(const ArcWalk& walk, double tolerance) {
  const double r = walk.start_radius;
  const double half_chord2 = tolerance * (2.0 * r - tolerance);
  if (!(half_chord2 > 0.0)) return 1;
  const double n = std::floor(0.5 * std::abs(walk.sweep) * r / std::sqrt(half_chord2));
  return static_cast<std::size_t>(std::clamp(n, 1.0, static_cast<double>(kMaxChords)));
}

class Walker {
 public:
  Walker(const Toolpath& path, const Machine& machine)
      : path_(path), machine_(machine), seconds_(path.size()), planner_(machine, seconds_) {}

  void run() {
    for (std::size_t i = 0; i < path_.size(); ++i) {
      if (path_[i].is_motion())
        move(i);
      else if (stops_at(i))
        stop(i);
      if (path_[i].kind() == StepKind::work_zero) set_position(i);
      if (path_[i].kind() == StepKind::dwell)
        seconds_[i] += static_cast<float>(path_[i].dwell().time.seconds());
    }
    planner_.stop();
  }

  std::vector<float>& seconds() { return seconds_; }
  const std::vector<std::size_t>& stops() const { return stops_; }
  std::size_t moves() const { return planner_.moves(); }
  std::size_t not_timed() const { return not_timed_; }

 private:
  void set_position(std::size_t step) {
    const Point3 before = here_.at;
    here_.pass(path_[step]);
    machine_zero_ = machine_zero_ + (here_.at - before);
    planner_.set_position(here_.at);
  }

  /// The end of a straight motion, machine coordinates in those of the work.
  Point3 end_of(const Step& s) const {
    Point3 to = s.to();
    for (int axis = 0; axis < 3; ++axis)
      if (s.reference() == Reference::machine && (s.reference_axes() >> axis & 1u) != 0)
        to[axis] += machine_zero_[axis];
    return to;
  }

  void stop(std::size_t step) {
    planner_.stop();
    stops_.push_back(step);
  }

  void move(std::size_t i) {
    const Step& s = path_[i];
    const bool probes = s.kind() == StepKind::probe;
    const bool homes = s.reference() == Reference::end_switches;  // of unknown duration
    if (s.rests_before() || probes || homes) stop(i);
    const double feed =
        s.kind() == StepKind::rapid ? std::numeric_limits<double>::infinity() : s.feed().mm_per_min() / 60.0;
    const std::optional<double> degrees = rotary_.pass(path_, i, here_.at);
    if (degrees && *degrees > 0.0 && feed > 0.0 && std::isfinite(feed)) {
      stop(i);  // rotary axes have no accelerations here
      seconds_[i] += static_cast<float>(*degrees / feed);
    } else if (!(feed > 0.0) || degrees || homes) {
      if (!homes) ++not_timed_;
      planner_.set_position(s.to());
    } else if (s.kind() == StepKind::arc) {
      arc(i, feed);
    } else {
      planner_.move(end_of(s), feed, i);
      if (!(end_of(s) == s.to())) planner_.set_position(s.to());
    }
    here_.pass(s);
    if (probes || exact_stop_) planner_.stop();
  }

  void arc(std::size_t i, double feed) {
    const ArcWalk walk = walk_of(path_[i], here_.at);
    std::size_t chords = chords_of(walk, machine_.arc_tolerance.mm());
    if (chords_ > kChordBudget) chords = std::min(chords, kFewChords);
    chords_ += chords;
    for (std::size_t k = 1; k < chords; ++k)
      planner_.move(walk.at(static_cast<double>(k) / static_cast<double>(chords)), feed, i);
    planner_.move(path_[i].to(), feed, i);
  }

  /// Whether a step without motion stops the machine: if it changes its state.
  bool stops_at(std::size_t i) {
    const Step& s = path_[i];
    switch (s.kind()) {
      case StepKind::dwell:
      case StepKind::tool_change:
      case StepKind::end: return true;
      case StepKind::pause: return s.pause().kind != PauseKind::optional;
      case StepKind::temperature: return s.temperature().wait;
      case StepKind::path_mode: exact_stop_ = s.path_mode().kind == PathModeKind::exact_stop; return false;
      case StepKind::coolant: return coolant_changes(s.coolant());
      case StepKind::spindle: return spindle_changes(i);
      case StepKind::laser_power: return laser_changes(s.laser_power());
      case StepKind::rapid:  // motions
      case StepKind::cut:
      case StepKind::arc:
      case StepKind::probe:
      case StepKind::extrude:
      case StepKind::fan:
      case StepKind::layer:
      case StepKind::note:
      case StepKind::verbatim:
      case StepKind::close_path:
      case StepKind::store_home:
      case StepKind::work_zero:
      case StepKind::tool_length:
      case StepKind::unresolved:
      case StepKind::motion_limits:
      case StepKind::extruder: break;
    }
    return false;
  }

  bool coolant_changes(const step::Coolant& now) {
    const bool same = now.mist == coolant_.mist && now.flood == coolant_.flood;
    coolant_ = now;
    return !same;
  }

  bool spindle_changes(std::size_t i) {
    const step::Spindle now = path_[i].spindle();
    const step::Spindle was = spindle_;
    spindle_ = now;
    if (now.turn != was.turn) return true;
    if (now.turn == SpindleTurn::off || now == was) return false;
    return machine_.laser == LaserDrive::stops || !on_line_of_cut(i);
  }

  bool laser_changes(const step::LaserPower& now) {
    const step::LaserPower was = laser_;
    laser_ = now;
    if (now.mode != was.mode) return true;
    return now.power != was.power && machine_.laser == LaserDrive::stops;
  }

  /// The laser power changes with the motion on the same line.
  bool on_line_of_cut(std::size_t i) const {
    return i + 1 < path_.size() && path_[i + 1].is_motion() && path_[i + 1].origin() == path_[i].origin();
  }

  const Toolpath& path_;
  const Machine& machine_;
  std::vector<float> seconds_;
  detail::Planner planner_;
  std::vector<std::size_t> stops_;
  PathPosition here_;
  detail::RotaryWay rotary_;
  Point3 machine_zero_;  // by which the positions of the work have changed, e.g. by G92
  step::Coolant coolant_;
  step::Spindle spindle_;
  step::LaserPower laser_;
  bool exact_stop_ = false;
  std::size_t chords_ = 0, not_timed_ = 0;
};

/// Adds up the times of steps.
class Sums {
 public:
  Sums(const Toolpath& path, TimeEstimate& out) : path_(path), out_(out) {}

  void add(std::size_t i, double seconds_of_step, std::size_t stops, Duration stop_time) {
    const Step& s = path_[i];
    start_operation(i);
    TimeFigures figures;
    const Duration time = seconds(seconds_of_step);
    if (s.is_motion()) figures.motion = time;
    if (s.kind() == StepKind::rapid) figures.rapid = time;
    if (s.kind() == StepKind::dwell) figures.dwell = time;
    figures.stops = stops;
    figures.halts = static_cast<double>(stops) * stop_time;
    add(out_.all, figures);
    add(tool_entry(), figures);
    if (s.is_motion()) open_operation(i);
    if (operation_open_)
      add(out_.operations.back().time, figures);
    else
      add(before_, figures);
  }

 private:
  static void add(TimeFigures& sum, const TimeFigures& part) {
    sum.motion = sum.motion + part.motion;
    sum.rapid = sum.rapid + part.rapid;
    sum.dwell = sum.dwell + part.dwell;
    sum.halts = sum.halts + part.halts;
    sum.stops += part.stops;
  }

  /// A tool change, a layer or a note starts an operation, which counts once it has a motion.
  void start_operation(std::size_t i) {
    switch (path_[i].kind()) {
      case StepKind::tool_change:
        tool_ = path_[i].tool_change().tool;
        tool_index_ = kNone;
        break;
      case StepKind::layer: name_ = path_.layer(i).name; break;
      case StepKind::note: name_ = path_.text(i); break;
      case StepKind::rapid:
      case StepKind::cut:
      case StepKind::arc:
      case StepKind::dwell:
      case StepKind::spindle:
      case StepKind::coolant:
      case StepKind::path_mode:
      case StepKind::probe:
      case StepKind::extrude:
      case StepKind::temperature:
      case StepKind::fan:
      case StepKind::laser_power:
      case StepKind::verbatim:
      case StepKind::pause:
      case StepKind::end:
      case StepKind::close_path:
      case StepKind::store_home:
      case StepKind::work_zero:
      case StepKind::tool_length:
      case StepKind::unresolved:
      case StepKind::motion_limits:
      case StepKind::extruder: return;
    }
    if (out_.operations.size() < kMaxOperations) operation_open_ = false;
  }

  void open_operation(std::size_t i) {
    if (operation_open_) return;
    out_.operations.push_back({std::move(name_), tool_, i, before_});
    name_.clear();
    before_ = {};
    operation_open_ = true;
  }

  TimeFigures& tool_entry() {
    if (tool_index_ == kNone) {
      const auto found = std::find_if(out_.tools.begin(), out_.tools.end(),
                                      [&](const ToolTime& entry) { return entry.tool == tool_; });
      tool_index_ = static_cast<std::size_t>(found - out_.tools.begin());
      if (found == out_.tools.end()) out_.tools.push_back({tool_, {}});
    }
    return out_.tools[tool_index_].time;
  }

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  const Toolpath& path_;
  TimeEstimate& out_;
  std::optional<int> tool_;
  std::size_t tool_index_ = kNone;
  std::string name_;
  TimeFigures before_;  // of steps between operations
  bool operation_open_ = false;
};

}  // namespace

TimeEstimate estimate_time(const Toolpath& path, const Machine& machine) {
  Walker walker(path, machine);
  walker.run();
  TimeEstimate out;
  out.moves = walker.moves();
  out.not_timed = walker.not_timed();
  Sums sums(path, out);
  auto stop = walker.stops().begin();
  for (std::size_t i = 0; i < path.size(); ++i) {
    std::size_t stops = 0;
    for (; stop != walker.stops().end() && *stop == i; ++stop) ++stops;
    sums.add(i, static_cast<double>(walker.seconds()[i]), stops, machine.stop_time);
  }
  return out;
}

std::vector<OperationTime> operation_times(const Toolpath& path, const std::vector<float>& seconds) {
  TimeEstimate out;
  Sums sums(path, out);
  for (std::size_t i = 0; i < path.size(); ++i) sums.add(i, static_cast<double>(seconds[i]), 0, {});
  return std::move(out.operations);
}

std::vector<float> step_seconds(const Toolpath& path, const Machine& machine) {
  Walker walker(path, machine);
  walker.run();
  std::vector<float> seconds = std::move(walker.seconds());
  // With the stops, so that they add up to the time of the whole.
  for (const std::size_t step : walker.stops())
    seconds[step] += static_cast<float>(machine.stop_time.seconds());
  return seconds;
}

}  // namespace kerf

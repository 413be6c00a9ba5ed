// Calls of the machine into a toolpath.
#include "front/gcmc/out/path_sink.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "front/gcmc/code/operators.h"

namespace kerf::gcmc {

PathSink::PathSink(Toolpath& path, Vm& vm)
    : path_(path), vm_(vm), scale_(vm.native == Unit::inch ? kMmPerInch : 1.0) {}

// ---- origins

OriginId PathSink::origin_at(std::size_t instruction, OriginId caller) {
  const Key key{instruction, caller};
  if (key == last_key_) return last_origin_;
  auto [it, is_new] = origins_.try_emplace(key, OriginId::none);
  if (is_new) {
    OriginTable& table = path_.origins();
    const TextSpot spot = vm_.spot(instruction);
    it->second = table.text(table.file(spot.file), spot.line, spot.column);
    if (caller != OriginId::none) table.set_caller(it->second, caller);
  }
  last_key_ = key;
  return last_origin_ = it->second;
}

/// The place of the running instruction, with the calls that led there. One place in one chain of calls is
/// one origin.
OriginId PathSink::origin() {
  constexpr std::size_t kMostCalls = 64;           // of a chain; the outermost are left out beyond
  constexpr std::size_t kMostOrigins = 5'000'000;  // beyond, steps know their own line only
  check_size();
  OriginId caller = OriginId::none;
  if (origins_.size() > kMostOrigins) return origin_at(vm_.current_instruction(), caller);
  const std::size_t depth = vm_.depth();
  for (std::size_t i = depth > kMostCalls ? depth - kMostCalls : 0; i < depth; ++i)
    caller = origin_at(vm_.call_site(i), caller);
  return origin_at(vm_.current_instruction(), caller);
}

// ---- motions

/// Texts are kept once each, but a program can make ever new ones.
void PathSink::count_text(std::size_t bytes) {
  text_bytes_ += bytes;
  if (text_bytes_ > vm_.options().max_memory) throw OutOfMemory{};
}

void PathSink::check_size() {
  if (path_.size() < vm_.options().max_path_steps) return;
  vm_.fail(Code::gcmc_limit,
           fmt::format("The toolpath has more than {} steps", vm_.options().max_path_steps));
}

/// Inverse time and per-revolution feeds are not feeds per minute: such motions have none, and the check says
/// so.
Feed PathSink::feed(double per_minute) const {
  if (feed_mode_ == 2 && speed_ != 0.0) return mm_per_min(per_minute * scale_ * speed_);
  return feed_mode_ == 1 && per_minute > 0.0 ? mm_per_min(per_minute * scale_) : Feed{};
}

/// Moves the named axes to where the text leads them. An axis that a motion does not name stays where it is,
/// although relocate() may have changed its coordinate; relative text has the difference from the coordinate
/// that was in force before.
void PathSink::go(const Axes& to, unsigned named) {
  const bool relative = vm_.options().relative;
  for (std::size_t i = 0; i < to.size(); ++i)
    if (named & 1u << i) at_[i] = relative ? at_[i] + (to[i] - commanded_[i]) : to[i];
  commanded_ = to;
}

void PathSink::note_motion(std::size_t step, unsigned named) {
  if (!vm_.options().relative) unknown_ &= ~named;
  rotary_used_ = rotary_used_ || (named & 56u) != 0;
  path_.set_unknown_axes(step, unknown_ & 7u);
  path_.set_named_axes(step, named & 63u);
  if (!rotary_used_) return;
  MotionExtra extra;
  extra.abc = std::array<double, 3>{at_[3], at_[4], at_[5]};
  path_.set_extra(step, std::move(extra));
}

Point3 PathSink::position() const { return {at_[0] * scale_, at_[1] * scale_, at_[2] * scale_}; }

void PathSink::motion(bool rapid, const Axes& to, unsigned named, double per_minute, OriginId where) {
  check_size();
  series_start_.reset();
  go(to, named);
  note_motion(rapid ? path_.add(step::Rapid{position()}, where)
                    : path_.add(step::Cut{position(), feed(per_minute)}, where),
              named);
}

void PathSink::move(const Move& m) {
  if (m.feed > 0.0) feed_ = m.feed;
  motion(m.rapid, m.to, m.named, feed_, origin());
}

void PathSink::arc(const ArcMove& m) {
  static constexpr std::size_t kPlaneAxes[][2] = {{0, 1}, {0, 2}, {1, 2}};
  check_size();
  series_start_.reset();
  const auto& plane = kPlaneAxes[static_cast<std::size_t>(m.plane)];
  step::Arc out;
  out.centre = {(at_[plane[0]] + m.offset.x) * scale_, (at_[plane[1]] + m.offset.y) * scale_};
  go(m.to, m.named);
  out.to = position();
  out.plane = m.plane;
  out.turn = m.turn;
  out.extra_turns = std::max(m.turns - 1, 0);
  out.feed = feed(feed_);
  note_motion(path_.add(out, origin()), m.named);
}

/// Adds the motions of a canned cycle, each with the axes that it moves.
class PathSink::CycleSink final : public DrillSink {
 public:
  /// `named`: the axes of the text's line.
  CycleSink(PathSink& sink, const DrillCycle& cycle, unsigned named, OriginId where)
      : sink_(sink),
        axis_(1u << axes_of(cycle.plane).w),
        next_(rises_first(cycle) ? axis_ : named),
        after_next_(rises_first(cycle) ? named : axis_),
        where_(where) {}
  void rapid(Point3 to) override { add(step::Rapid{to}, to); }
  void cut(Point3 to) override { add(step::Cut{to, sink_.feed(sink_.feed_)}, to); }
  void dwell(Duration) override {}
  void spindle(SpindleTurn) override {}
  void pause() override {}

 private:
  template <class S>
  void add(const S& step, Point3 to) {
    sink_.check_size();
    const Point3 from = sink_.position();
    unsigned named = std::exchange(next_, std::exchange(after_next_, axis_));
    for (int i = 0; i < 3; ++i) {
      if (to[i] != from[i]) named |= 1u << i;
      sink_.at_[static_cast<std::size_t>(i)] = to[i] / sink_.scale_;
    }
    sink_.note_motion(sink_.path_.add(step, where_), named);
  }
  PathSink& sink_;
  unsigned axis_;               // of the hole, as a bit
  unsigned next_, after_next_;  // axes of the next two motions; all others name the axis of the hole
  OriginId where_;
};

/// The motions of the G73 of the text, which is read with G99 in force.
void PathSink::drill(const DrillMove& m) {
  constexpr int kMaxRepeats = 10'000;  // as in G-code
  const bool relative = vm_.options().relative;
  DrillCycle cycle;
  cycle.kind = DrillKind::chip_break;
  cycle.plane = vm_.machine().plane;
  const auto axis = static_cast<std::size_t>(axes_of(cycle.plane).w);
  if ((m.named & 1u << axis) == 0)
    vm_.fail(Code::gcmc_geometry, fmt::format("drill() needs {}, the bottom of the hole", "XYZ"[axis]));
  if (m.repeat > kMaxRepeats)
    vm_.fail(Code::gcmc_limit, fmt::format("drill() repeats a hole more than {} times", kMaxRepeats));
  const double start = series_start_.value_or(at_[axis]);
  const double retract = relative ? start + (m.retract - commanded_[2]) : m.retract;
  cycle.start_level = start * scale_;
  cycle.retract_plane = retract * scale_;
  cycle.bottom = (relative ? retract + (m.to[axis] - commanded_[axis]) : m.to[axis]) * scale_;
  const Point3 from = position();
  const Axes before = at_;
  go(m.to, m.named & 7u & ~(1u << axis));
  cycle.at = position();
  if (relative) cycle.increment = cycle.at - from;
  at_ = before;
  commanded_[2] = m.retract;
  cycle.holes = std::max(m.repeat, 1);
  cycle.peck = mm(m.delta * scale_);
  if (const std::optional<DrillFault> fault = fault_of(cycle))
    vm_.fail(fault->code == Code::cycle_upside_down ? Code::gcmc_geometry : Code::gcmc_limit,
             fmt::format("drill(): {}", fault->message));
  series_start_ = start;
  CycleSink sink(*this, cycle, m.named & 7u, origin());
  expand(cycle, from, sink);
}

// ---- state

void PathSink::feed_mode(int mode) {
  static constexpr const char* kModes[] = {"G93\n", "G94\n", "G95\n"};
  if (mode != feed_mode_) feed_ = 0.0;  // a feed of one mode means nothing in another
  feed_mode_ = mode;
  path_.add(step::Verbatim{kModes[mode]}, origin());
}

void PathSink::spindle(double speed) {
  if (speed != 0.0) speed_ = std::abs(speed);
  turn_ = speed == 0.0 ? SpindleTurn::off : speed > 0.0 ? SpindleTurn::cw : SpindleTurn::ccw;
  path_.add(step::Spindle{rpm(std::abs(speed)), turn_}, origin());
}

void PathSink::spindle_speed(double speed) {
  speed_ = speed;
  path_.add(step::Spindle{rpm(speed), speed == 0.0 ? SpindleTurn::off : turn_}, origin());
}

void PathSink::coolant(int bits) { path_.add(step::Coolant{(bits & 1) != 0, (bits & 2) != 0}, origin()); }

/// M6 stops the spindle.
void PathSink::tool_change(int tool, bool) {
  if (turn_ != SpindleTurn::off) path_.add(step::Spindle{rpm(0), SpindleTurn::off}, origin());
  turn_ = SpindleTurn::off;
  path_.add(step::ToolChange{tool}, origin());
}

void PathSink::dwell(double time) { path_.add(step::Dwell{seconds(time)}, origin()); }

void PathSink::path_mode(bool exact, std::optional<double> p, std::optional<double>) {
  step::PathMode mode;
  mode.kind = exact ? PathModeKind::exact_path : PathModeKind::blend;
  mode.tolerance = mm(p.value_or(0.0) * scale_);
  path_.add(mode, origin());
}

void PathSink::pause(bool optional) { path_.add(step::Verbatim{optional ? "M1" : "M0"}, origin()); }

void PathSink::comment(std::string_view text) {
  count_text(text.size());
  path_.add(step::Note{std::string(text)}, origin());
}

void PathSink::literal(std::string_view text) {
  count_text(text.size());
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    pending_ += text.substr(0, end);
    text.remove_prefix(end + 1);
    if (!pending_.empty()) path_.add(step::Verbatim{pending_}, origin());
    pending_.clear();
  }
  pending_ += text;
}

void PathSink::finish() {
  if (!pending_.empty()) path_.add(step::Verbatim{pending_}, origin());
  pending_.clear();
}

void PathSink::store_position(bool second) {
  path_.add(step::Verbatim{second ? "G30.1" : "G28.1"}, origin());
}

void PathSink::restore_position(bool, const Axes& via, unsigned named, const Axes& end) {
  const OriginId where = origin();
  if (named != 0) motion(true, via, named, feed_, where);
  motion(true, end, 7u, feed_, where);
}

void PathSink::layer(const std::string& name) { path_.add(step::Layer{name, 256}, origin()); }

void PathSink::close_path() { path_.add(step::Verbatim{"(close path)"}, origin()); }

}  // namespace kerf::gcmc

// From calls of the machine to a toolpath.
#include "front/gcmc/out/path_sink.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "base/codes/gcmc.h"
#include "base/codes/gcode.h"
#include "front/gcmc/code/operators.h"
#include "front/gcmc/out/written_line.h"

#include "kerf/base/limits.h"

namespace kerf::gcmc {
namespace {

constexpr unsigned kLinear = 7, kLinearAndRotary = 63, kEveryAxis = 511;  // bits of axes
constexpr double kMaxPosition = 1e7;                                      // mm

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r") == std::string_view::npos; }

/// Text as a message quotes it.
std::string quoted_line(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  while (!text.empty() && is_blank(text.substr(text.size() - 1))) text.remove_suffix(1);
  if (text.size() <= kLongest) return fmt::format("\"{}\"", text);
  return fmt::format("\"{}...\"", text.substr(0, kLongest));
}

}  // namespace

PathSink::PathSink(Toolpath& path, Vm& vm)
    : path_(path),
      vm_(vm),
      scale_(vm.native == Unit::inch ? kMmPerInch : 1.0),
      draws_(vm.options().target != GcmcTarget::gcode) {}

// ---- origins

OriginId PathSink::origin_at(std::size_t instruction, OriginId caller) {
  const Key key{instruction, caller};
  if (key == last_key_) return last_origin_;
  auto [it, is_new] = origins_.try_emplace(key, OriginId::none);
  if (is_new) {
    OriginTable& table = path_.origins();
    const TextLocation where = vm_.location(instruction);
    it->second = table.text(table.file(where.file), where.line, where.column);
    if (caller != OriginId::none) table.set_caller(it->second, caller);
  }
  last_key_ = key;
  return last_origin_ = it->second;
}

/// The location of the running instruction with the calls that led to it. The same location with the same
/// calls is the same origin.
OriginId PathSink::origin() {
  constexpr std::size_t kMaxCalls = 64;           // of a chain; without the outermost beyond that
  constexpr std::size_t kMaxOrigins = 5'000'000;  // beyond that, steps have no calls
  check_size();
  OriginId caller = OriginId::none;
  if (origins_.size() > kMaxOrigins) return origin_at(vm_.current_instruction(), caller);
  const std::size_t depth = vm_.depth();
  for (std::size_t i = depth > kMaxCalls ? depth - kMaxCalls : 0; i < depth; ++i)
    caller = origin_at(vm_.call_site(i), caller);
  return origin_at(vm_.current_instruction(), caller);
}

// ---- motions

/// Each text is stored once, but a program can generate any number of different ones.
void PathSink::count_text(std::size_t bytes) {
  text_bytes_ += bytes;
  if (text_bytes_ > vm_.options().max_memory) throw OutOfMemory{};
}

void PathSink::check_size() {
  if (path_.size() < vm_.options().max_path_steps) return;
  vm_.fail(codes::gcmc_limit,
           fmt::format("The toolpath has more than {} steps", vm_.options().max_path_steps));
}

/// Whether the next call belongs to the toolpath; an error if literal() has written text on the same line.
bool PathSink::check_pending() {
  if (ended_) return false;
  if (!is_blank(pending_)) {
    vm_.fail(codes::gcmc_literal,
             fmt::format(
                 "The line {} of literal() has no line end: the words of this call would be appended to it",
                 quoted_line(pending_)),
             "end the text of literal() with \\n");
  }
  pending_.clear();
  needs_check_ = false;
  return true;
}

/// The feed of a straight move, mm/min. In inverse time only a feed `given` with the move is valid.
double PathSink::straight_feed(double given, Point3 from, Point3 to) const {
  if (feed_mode_ != FeedMode::inverse_time) return modal_feed();
  return feed_per_minute(feed_mode_, given, distance(from, to), 0.0);
}

/// The feed of a motion without an F word of its own, mm/min.
double PathSink::modal_feed() const {
  if (feed_mode_ == FeedMode::inverse_time) return 0.0;
  return feed_per_minute(feed_mode_, feed_ * scale_, 0.0, speed_.value_or(0.0));
}

/// Moves the named axes as the G-code text would. An axis that is not named does not move, even if relocate()
/// has changed its coordinate; in relative text the distance is from the previous coordinate. Drawings use
/// the position of the program.
void PathSink::go(const Axes& to, unsigned named) {
  const bool relative = vm_.options().relative && !draws_;
  if (draws_) named = kEveryAxis;
  for (std::size_t i = 0; i < to.size(); ++i)
    if (named & 1u << i) at_[i] = relative ? at_[i] + (to[i] - commanded_[i]) : to[i];
  commanded_ = to;
  const Point3 here = position();
  if (!draws_ && !(std::max({std::abs(here.x), std::abs(here.y), std::abs(here.z)}) <= kMaxPosition))
    vm_.fail(codes::gcmc_geometry, fmt::format("A position is more than {:g} mm from zero", kMaxPosition));
}

void PathSink::note_motion(std::size_t step, unsigned named) {
  if (!vm_.options().relative) unknown_ &= ~named;
  rotary_used_ = rotary_used_ || (named & kLinearAndRotary & ~kLinear) != 0;
  moved_ = true;
  path_.set_unknown_axes(step, unknown_ & kLinear);
  path_.set_named_axes(step, named & kLinearAndRotary);
  if (!rotary_used_) return;
  MotionExtra extra;
  extra.abc = std::array<double, 3>{at_[3], at_[4], at_[5]};
  extra.unknown_abc = unknown_ >> 3 & 7u;
  path_.set_extra(step, std::move(extra));
}

void PathSink::rapid(const Axes& to, unsigned named, OriginId where) {
  check_size();
  go(to, named);
  note_motion(path_.add(step::Rapid{position()}, where), named);
}

void PathSink::move(const Move& m) {
  if (!is_active()) return;
  if (m.feed > 0.0) feed_ = m.feed;
  // A motion word alone does not move; it is a step only if the controller executes it as a motion.
  const bool empty = (m.named & kLinearAndRotary) == 0;
  if (empty && (!moved_ || !(m.rapid || feed_ > 0.0))) return;
  const OriginId where = origin();
  series_start_.reset();
  if (m.rapid) return rapid(m.to, m.named, where);
  const Point3 from = position();
  go(m.to, m.named);
  const Feed feed = mm_per_min(straight_feed(m.feed, from, position()));
  note_motion(path_.add(step::Cut{position(), feed}, where), m.named);
}

void PathSink::arc(const ArcMove& m) {
  if (!is_active()) return;
  check_size();
  series_start_.reset();
  const PlaneAxes plane = named_axes_of(m.plane);
  step::Arc out;
  out.centre = {(along(at_, plane.u) + m.offset.x) * scale_, (along(at_, plane.v) + m.offset.y) * scale_};
  go(m.to, m.named);
  out.to = position();
  out.plane = m.plane;
  out.turn = m.turn;
  out.extra_turns = std::max(m.turns - 1, 0);
  out.feed = mm_per_min(modal_feed());
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
  void cut(Point3 to) override { add(step::Cut{to, mm_per_min(sink_.modal_feed())}, to); }
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
  unsigned axis_;               // of the hole; a bit
  unsigned next_, after_next_;  // axes of the next two motions; later ones name the axis of the hole
  OriginId where_;
};

/// The motions of the G73 in the text, with G99 in force.
void PathSink::drill(const DrillMove& m) {
  if (!is_active()) return;
  const bool relative = vm_.options().relative;
  DrillCycle cycle;
  cycle.kind = DrillKind::chip_break;
  cycle.plane = vm_.machine().plane;
  const auto axis = static_cast<std::size_t>(axes_of(cycle.plane).w);
  if ((m.named & 1u << axis) == 0)
    vm_.fail(codes::gcmc_geometry, fmt::format("drill() needs {}, the bottom of the hole", "XYZ"[axis]));
  if (m.repeat > limits::kMaxHoles)
    vm_.fail(codes::gcmc_limit, fmt::format("drill() repeats a hole more than {} times", limits::kMaxHoles));
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
    vm_.fail(fault->code == codes::cycle_upside_down ? codes::gcmc_geometry : codes::gcmc_limit,
             fmt::format("drill(): {}", fault->message));
  series_start_ = start;
  CycleSink sink(*this, cycle, m.named & 7u, origin());
  expand(cycle, from, sink);
}

// ---- state

void PathSink::feed_rate(double feed) {
  if (!is_active()) return;
  if (feed < 0.0 && !draws_)
    vm_.fail(codes::gcmc_range, fmt::format("A feed cannot be negative ({:g})", feed));
  feed_ = feed;
}

void PathSink::feed_mode(int mode) {
  if (!is_active()) return;
  static constexpr FeedMode kModes[] = {FeedMode::inverse_time, FeedMode::per_minute, FeedMode::per_turn};
  if (feed_mode_ != kModes[mode]) feed_ = 0.0;  // a feed is not valid in another mode
  feed_mode_ = kModes[mode];
}

/// The spindle does not turn if the program has set a speed of 0.
void PathSink::turn_spindle(SpindleTurn turn, OriginId where) {
  turn_ = turn;
  const bool still = turn == SpindleTurn::off || (speed_ && !(*speed_ > 0.0));
  path_.add(step::Spindle{still ? rpm(0) : rpm(speed_.value_or(0.0)), still ? SpindleTurn::off : turn},
            where);
}

void PathSink::set_speed(double speed, OriginId where) {
  const bool is_news = turn_ != SpindleTurn::off && speed_ != speed;
  speed_ = speed;
  if (is_news) turn_spindle(turn_, where);
}

void PathSink::spindle(double speed) {
  if (!is_active()) return;
  if (speed != 0.0) speed_ = std::abs(speed);
  turn_spindle(speed == 0.0 ? SpindleTurn::off : speed > 0.0 ? SpindleTurn::cw : SpindleTurn::ccw, origin());
}

void PathSink::spindle_speed(double speed) {
  if (is_active()) set_speed(speed, origin());
}

void PathSink::coolant(int bits) {
  if (!is_active()) return;
  coolant_ =
      bits == 0 ? step::Coolant{} : step::Coolant{coolant_.mist || (bits & 1), coolant_.flood || (bits & 2)};
  path_.add(coolant_, origin());
}

void PathSink::change_tool(int tool, OriginId where) {
  if (turn_ != SpindleTurn::off) turn_spindle(SpindleTurn::off, where);
  path_.add(step::ToolChange{tool}, where);
}

void PathSink::tool_change(int tool, bool) {
  if (!is_active()) return;
  selected_tool_ = tool;
  change_tool(tool, origin());
}

void PathSink::dwell(double time) {
  if (is_active()) path_.add(step::Dwell{seconds(time)}, origin());
}

void PathSink::path_mode(bool exact, std::optional<double> p, std::optional<double>) {
  if (!is_active()) return;
  step::PathMode mode;
  mode.kind = exact ? PathModeKind::exact_path : PathModeKind::blend;
  mode.tolerance = mm(p.value_or(0.0) * scale_);
  path_.add(mode, origin());
}

void PathSink::pause(bool optional) {
  if (is_active()) path_.add(step::Pause{optional ? PauseKind::optional : PauseKind::always}, origin());
}

void PathSink::layer(const std::string& name) {
  if (!ended_) path_.add(step::Layer{name, 256}, origin());
}

void PathSink::close_path() {
  if (!ended_) path_.add(step::ClosePath{}, origin());
}

// ---- stored positions

void PathSink::store_position(bool second) {
  if (!is_active()) return;
  homes_[second ? 1 : 0] = {position(), unknown_ & kLinear};
  path_.add(step::StoreHome{second ? Reference::second_home : Reference::home}, origin());
}

/// Through `via` to the home stored in the controller, for the named axes, or X, Y and Z if none is named. It
/// is known only if the program has stored it.
void PathSink::restore_position(bool second, const Axes& via, unsigned named, const Axes& end) {
  if (!is_active()) return;
  const OriginId where = origin();
  if (draws_) {
    if (named != 0) rapid(via, named, where);
    return rapid(end, kLinear, where);
  }
  rapid(via, named, where);
  const Home& home = homes_[second ? 1 : 0];
  const unsigned axes = (named & kLinear) != 0 ? named & kLinear : kLinear;
  for (int axis = 0; axis < 3; ++axis) {
    const unsigned bit = 1u << axis;
    if ((axes & bit) == 0) continue;
    at_[static_cast<std::size_t>(axis)] = home.at[axis] / scale_;
    unknown_ = (unknown_ & ~bit) | (home.unknown & bit);
  }
  commanded_ = end;
  check_size();
  const std::size_t step = path_.add(step::Rapid{position()}, where);
  note_motion(step, 0);
  if ((axes & unknown_) != 0)
    path_.set_reference(step, second ? Reference::second_home : Reference::home, axes & unknown_);
}

// ---- text

void PathSink::comment(std::string_view text) {
  if (ended_) return;
  count_text(text.size());
  const bool plain = pending_.empty() && text.find_first_of("()\r\n") == std::string_view::npos;
  if (draws_ || plain)
    path_.add(step::Note{std::string(text)}, origin());
  else
    written_text(fmt::format("({})\n", text));
}

void PathSink::literal(std::string_view text) {
  if (ended_ || draws_) return;
  count_text(text.size());
  written_text(text);
}

void PathSink::written_text(std::string_view text) {
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    pending_ += text.substr(0, end);
    text.remove_prefix(end + 1);
    written_line(pending_);
    pending_.clear();
    if (ended_) return;
  }
  pending_ += text;
  needs_check_ = needs_check_ || !pending_.empty();
}

/// The steps of a line written by literal().
void PathSink::written_line(std::string_view text) {
  std::string problem;
  const std::optional<WrittenLine> line = read_written_line(text, problem);
  if (!line) {
    vm_.fail(codes::gcmc_literal,
             fmt::format("The line {} cannot be part of a toolpath: {}", quoted_line(text), problem),
             "use the functions of the language, or write G-code with kerf gcmc and use that");
  }
  const OriginId where = origin();
  for (const std::string& note : line->notes) path_.add(step::Note{note}, where);
  if (line->speed && !line->turn && !line->changes_tool) set_speed(*line->speed, where);
  if (line->speed) speed_ = line->speed;
  if (line->selected) selected_tool_ = line->selected;
  if (line->changes_tool) {
    if (!selected_tool_) {
      vm_.fail(codes::gcmc_literal,
               fmt::format("The line {} cannot be part of a toolpath: no T word selects the tool",
                           quoted_line(text)));
    }
    change_tool(*selected_tool_, where);
  }
  if (line->turn) turn_spindle(*line->turn, where);
  if (line->no_coolant) coolant_ = {};
  coolant_ =
      line->no_coolant ? coolant_ : step::Coolant{coolant_.mist || line->mist, coolant_.flood || line->flood};
  if (line->no_coolant || line->mist || line->flood) path_.add(coolant_, where);
  if (line->dwell) path_.add(*line->dwell, where);
  if (line->path_mode) {
    step::PathMode mode = *line->path_mode;
    mode.tolerance = scale_ * mode.tolerance;
    path_.add(mode, where);
  }
  if (!line->verbatim.empty()) path_.add(step::Verbatim{line->verbatim}, where);
  if (line->pause) path_.add(*line->pause, where);
  if (line->end) end(*line->end, where);
}

/// The program's end stops spindle and coolant. Later calls are not part of the toolpath.
void PathSink::end(step::End how, OriginId where) {
  if (turn_ != SpindleTurn::off) turn_spindle(SpindleTurn::off, where);
  if (coolant_.mist || coolant_.flood) path_.add(coolant_ = {}, where);
  path_.add(how, where);
  ended_ = needs_check_ = true;
}

void PathSink::finish(const TextLocation& end_of_text) {
  const GcmcOptions& options = vm_.options();
  if (draws_ || ended_) return;
  if (!is_blank(pending_)) written_line(pending_);  // the last line, without a line end
  if (options.frame != GcmcFrame::usual || !options.epilogue.empty() || ended_) return;
  OriginTable& table = path_.origins();
  end({true}, table.text(table.file(end_of_text.file), end_of_text.line, end_of_text.column));
}

}  // namespace kerf::gcmc

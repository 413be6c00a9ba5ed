// Calls of the machine into a toolpath.
#include "front/gcmc/out/path_sink.h"

#include <algorithm>
#include <fmt/format.h>

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

void PathSink::after_motion(std::size_t step, const Axes& to, unsigned named) {
  unknown_ &= ~named;
  path_.set_unknown_axes(step, unknown_ & 7u);
  path_.set_named_axes(step, named & 63u);
  if (to[3] != 0.0 || to[4] != 0.0 || to[5] != 0.0 || (named & 56u)) {
    MotionExtra extra;
    extra.abc = std::array<double, 3>{to[3], to[4], to[5]};
    path_.set_extra(step, std::move(extra));
  }
  last_ = to;
}

void PathSink::motion(bool rapid, const Axes& to, unsigned named, double per_minute, OriginId where) {
  check_size();
  const Point3 end{to[0] * scale_, to[1] * scale_, to[2] * scale_};
  const std::size_t step =
      rapid ? path_.add(step::Rapid{end}, where) : path_.add(step::Cut{end, feed(per_minute)}, where);
  after_motion(step, to, named);
}

void PathSink::move(const Move& m) {
  if (m.feed > 0.0) feed_ = m.feed;
  motion(m.rapid, m.to, m.named, feed_, origin());
}

void PathSink::arc(const ArcMove& m) {
  static constexpr std::size_t kPlaneAxes[][2] = {{0, 1}, {0, 2}, {1, 2}};
  check_size();
  const auto& plane = kPlaneAxes[static_cast<std::size_t>(m.plane)];
  step::Arc out;
  out.to = {m.to[0] * scale_, m.to[1] * scale_, m.to[2] * scale_};
  // The offset counts from where the program stands; relocation may have moved the text's begin since.
  out.centre = {(last_[plane[0]] + m.offset.x) * scale_, (last_[plane[1]] + m.offset.y) * scale_};
  out.plane = m.plane;
  out.turn = m.turn;
  out.extra_turns = std::max(m.turns - 1, 0);
  out.feed = feed(feed_);
  after_motion(path_.add(out, origin()), m.to, m.named);
}

/// The moves that the controller's cycle makes: down peck by peck, with a small retreat that breaks the chip.
void PathSink::drill(const DrillCycle& m) {
  constexpr double kChipRetreat = 0.254;  // mm, as LinuxCNC's G73 does
  constexpr double kMostPecks = 100'000;
  const OriginId where = origin();
  Axes at = last_;
  for (std::size_t i : {0u, 1u}) at[i] = m.to[i];
  motion(true, at, m.named & 3u, feed_, where);
  at[2] = m.retract;
  motion(true, at, 4u, feed_, where);
  const double depth = m.to[2];
  if ((m.retract - depth) / m.delta > kMostPecks) vm_.fail(Code::gcmc_limit, "drill() makes too many pecks");
  double level = m.retract;
  while (level > depth) {
    level = std::max(level - m.delta, depth);
    at[2] = level;
    motion(false, at, 4u, feed_, where);
    if (level <= depth) break;
    at[2] = level + kChipRetreat / scale_;
    motion(true, at, 4u, feed_, where);
  }
  at[2] = m.retract;
  motion(true, at, 4u, feed_, where);
}

// ---- state

void PathSink::feed_mode(int mode) {
  static constexpr const char* kModes[] = {"G93\n", "G94\n", "G95\n"};
  feed_mode_ = mode;
  feed_ = 0.0;
  path_.add(step::Verbatim{kModes[mode]}, origin());
}

void PathSink::spindle(double speed) {
  if (speed != 0.0) speed_ = std::abs(speed);
  turn_ = speed == 0.0 ? SpindleTurn::off : speed > 0.0 ? SpindleTurn::cw : SpindleTurn::ccw;
  path_.add(step::Spindle{rpm(std::abs(speed)), turn_}, origin());
}

void PathSink::spindle_speed(double speed) {
  speed_ = speed;
  path_.add(step::Spindle{rpm(speed), turn_}, origin());
}

void PathSink::coolant(int bits) { path_.add(step::Coolant{(bits & 1) != 0, (bits & 2) != 0}, origin()); }

void PathSink::tool_change(int tool, bool) { path_.add(step::ToolChange{tool}, origin()); }

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

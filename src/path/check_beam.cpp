// The state of a laser's beam along a toolpath, compared with what the controller does with it.
#include "path/check_beam.h"

#include <cmath>
#include <fmt/format.h>

#include "base/codes/path.h"
#include "base/number.h"

namespace kerf {
namespace {

constexpr int kShownDecimals = 3;
constexpr unsigned kAxesXY = 3, kAxisZ = 4;  // in masks of axes

std::string_view code_of(LaserMode mode) { return mode == LaserMode::dynamic ? "M4" : "M3"; }

class BeamCheck {
 public:
  BeamCheck(const Toolpath& path, const CheckOptions& options) : path_(path) {
    if (options.machine != nullptr) {
      drive_ = options.machine->laser;
      grbl_ = options.machine->controller == Controller::grbl;
      strongest_ = options.machine->fastest_spindle;
    }
  }

  std::vector<PathHazard> run() {
    for (std::size_t i = 0; i < path_.size(); ++i) {
      examine(i);
      rest_.pass(path_[i]);
    }
    if (path_.size() > 0 && is_on() && path_[path_.size() - 1].kind() != StepKind::end)
      report(path_.size() - 1, codes::path_beam_left_on,
             fmt::format("the program ends with the beam on at {}", power_text()), "add M5 at the end");
    return std::move(found_);
  }

 private:
  bool is_on() const { return beam_.mode != LaserMode::off && beam_.power > 0.0; }

  /// Whether the controller has the beam on during a rapid. In GRBL's laser mode it has not.
  bool burns_in_rapids() const {
    if (drive_) return is_on() && *drive_ == LaserDrive::stops;
    return is_on() && beam_.mode == LaserMode::constant;
  }

  /// Whether the beam is on while nothing moves. In GRBL's laser mode that of M3 is, after G1 to G3.
  bool burns_standing() const {
    if (drive_ == LaserDrive::stops) return is_on();
    if (drive_ && after_rapid_) return false;
    return is_on() && beam_.mode == LaserMode::constant;
  }

  void examine(std::size_t i) {
    const Step& s = path_[i];
    switch (s.kind()) {
      case StepKind::laser_power: return switch_beam(i);
      case StepKind::rapid: return rapid(i);
      case StepKind::cut:
      case StepKind::arc: return cut(i);
      case StepKind::dwell: return dwell(i);
      case StepKind::tool_change:
        if (s.tool_change().kind == ToolChangeKind::change) stand(i, "during a tool change");
        return;
      case StepKind::pause: return pause(i);
      case StepKind::end: return end(i);
      case StepKind::spindle:
      case StepKind::coolant:
      case StepKind::path_mode:
      case StepKind::probe:
      case StepKind::extrude:
      case StepKind::temperature:
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
      case StepKind::extruder: return;
    }
  }

  void switch_beam(std::size_t i) {
    const step::LaserPower wanted = path_[i].laser_power();
    if (wanted.mode == LaserMode::off || !(wanted.power > 0.0)) {
      if (is_on()) {
        last_on_ = beam_;
        switched_off_ = i;
      }
      rapids_ = kNone;
    }
    beam_ = wanted;
    if (!strongest_ || !is_on() || beam_.power <= strongest_->rpm() || exceeds_) return;
    exceeds_ = true;  // one finding: all powers of a program are in one scale
    report(i, codes::path_spindle_range,
           fmt::format("power S {}; the machine's full power is S {}", number_text(beam_.power, 1),
                       number_text(strongest_->rpm(), 1)),
           "use the scale of the machine for S, or set its maximum ($30 in GRBL)");
  }

  /// "power S 300 (M3)"
  std::string power_text() const {
    return fmt::format("power S {} ({})", number_text(beam_.power, kShownDecimals), code_of(beam_.mode));
  }

  void rapid(std::size_t i) {
    const bool moves = is_moving(i, kAxesXY | kAxisZ);
    after_rapid_ = true;
    if (!moves || !burns_in_rapids()) return;
    if (rapids_ != kNone) return void(++found_[rapids_].steps);
    rapids_ = found_.size();
    report(i, codes::path_beam_in_rapid, fmt::format("the beam is on at {} during a rapid", power_text()),
           drive_ ? "write S0 or M5 before the rapid, or switch on laser mode ($32=1 in GRBL)"
                  : "write S0 or M5 before the rapid; GRBL switches the beam off there in laser mode only "
                    "($32=1; --machine specifies the controller)");
  }

  void cut(std::size_t i) {
    after_rapid_ = false;
    const Step& s = path_[i];
    const MotionExtra* extra = path_.extra(i);
    const bool turns = extra != nullptr && (extra->abc || extra->unknown_abc != 0);
    if (!is_on() || s.kind() == StepKind::arc || turns || is_moving(i, kAxesXY) || !is_moving(i, kAxisZ))
      return;
    report(i, codes::path_beam_standing,
           fmt::format("the beam is on at {} while only Z moves, and burns deep there", power_text()),
           "write S0 before the motion in Z");
  }

  /// Whether one of `axes` moves, or may move because its position is unknown.
  bool is_moving(std::size_t i, unsigned axes) const {
    const Step& s = path_[i];
    if (((s.unknown_axes() ^ rest_.unknown) & axes) != 0 || (s.reference_axes() & axes) != 0) return true;
    for (int axis = 0; axis < 3; ++axis)
      if ((axes >> axis & 1u) != 0 && s.to()[axis] != rest_.at[axis]) return true;
    return false;
  }

  void dwell(std::size_t i) {
    const double seconds = path_[i].dwell().time.seconds();
    if (seconds > 0.0)
      stand(i, fmt::format("for {} s while nothing moves", number_text(seconds, kShownDecimals)));
  }

  /// In its laser mode GRBL switches the beam off while it waits.
  void pause(std::size_t i) {
    if (drive_ != LaserDrive::follows) stand(i, "during a pause, while nothing moves");
  }

  void stand(std::size_t i, std::string_view when) {
    if (burns_standing())
      report(i, codes::path_beam_standing, fmt::format("the beam is on at {} {}", power_text(), when),
             "write S0 or M5 before it, or M4 in laser mode, where the beam is off while nothing moves");
  }

  /// M2 and M30 switch the beam off on GRBL; the reader adds that as a step of their line.
  void end(std::size_t i) {
    if (switched_off_ && !grbl_ && last_on_.mode == LaserMode::constant && same_line(*switched_off_, i)) {
      beam_ = last_on_;
      report(
          i, codes::path_beam_left_on,
          fmt::format("the program ends with the beam on at {}; not every controller switches it off at the "
                      "end",
                      power_text()),
          "write M5 before the end");
    }
    beam_ = {};
    switched_off_.reset();
  }

  bool same_line(std::size_t a, std::size_t b) const {
    const Origin first = path_.origin_of(a), second = path_.origin_of(b);
    const auto *x = std::get_if<TextLocation>(&first), *y = std::get_if<TextLocation>(&second);
    return x != nullptr && y != nullptr && x->line == y->line && x->file == y->file;
  }

  void report(std::size_t i, Code code, std::string message, std::string_view hint) {
    const Point3 at = path_[i].is_motion() ? path_[i].to() : rest_.at;
    found_.push_back({code, static_cast<std::uint32_t>(i), 1, at, std::move(message), std::string(hint)});
  }

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  const Toolpath& path_;
  std::optional<LaserDrive> drive_;  // nothing: unknown
  bool grbl_ = false;
  std::optional<SpindleSpeed> strongest_;  // S of full power
  std::vector<PathHazard> found_;
  PathPosition rest_;
  step::LaserPower beam_, last_on_;
  std::optional<std::size_t> switched_off_;  // step
  std::size_t rapids_ = kNone;               // entry of `found_` that the next rapid with the beam on joins
  bool after_rapid_ = true;                  // at the start GRBL is in G0
  bool exceeds_ = false;
};

}  // namespace

std::vector<PathHazard> check_beam(const Toolpath& path, const CheckOptions& options) {
  if (!path.has(StepKind::laser_power)) return {};
  return BeamCheck(path, options).run();
}

}  // namespace kerf

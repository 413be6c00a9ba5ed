// Moves that the spindle drives: G33, G33.1 and the threading cycle G76.
//
// Source: LinuxCNC's pages "G33 Spindle Synchronized Motion", "G33.1 Rigid Tapping", "G76 Threading Cycle".
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "front/gcode/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr int kMostPasses = 1000;

}  // namespace

/// One turn of the spindle moves the tool by K; G33.1 goes back the same way with the spindle reversed.
void Interpreter::spindle_move(Tenths motion) {
  const Place from = here_;
  const std::optional<Place> to = target();
  const std::optional<double> pitch = line_.take('K');
  if (!pitch) {
    talker_.error(Code::word_missing, line_.column(Group::motion),
                  fmt::format("{} needs K, the way in one turn of the spindle", code_text('G', motion)));
    return line_.use(kAllLetters);
  }
  if (!to) return;
  const double feed = std::abs(*pitch) * modes_.scale * modes_.speed;
  cut(*to, feed);
  if (motion == 330) return;
  const SpindleTurn turn = modes_.spindle;
  spin(turn == SpindleTurn::cw ? SpindleTurn::ccw : SpindleTurn::cw);
  cut(from, feed);
  spin(turn);
}

/// G76 P Z I J K R Q H: passes of growing depth in X, as deep as leaves the same chip.
void Interpreter::thread_cycle() {
  const double pitch = line_.take('P').value_or(0.0) * modes_.scale;
  const double peak = line_.take('I').value_or(0.0) * modes_.scale;
  const double first = line_.take('J').value_or(0.0) * modes_.scale;
  const double full = line_.take('K').value_or(0.0) * modes_.scale;
  const double fall = line_.take('R').value_or(1.0);
  const double slant = std::tan(line_.take('Q').value_or(0.0) * std::numbers::pi / 180.0);
  const double spring = line_.take('H').value_or(0.0);
  const Place start = here_;
  const std::optional<Place> end = target();
  line_.use(Line::bit('E') | Line::bit('L'));
  if (!end) return;
  const bool meant = pitch > 0.0 && peak != 0.0 && first > 0.0 && full >= first && fall >= 1.0 &&
                     std::isfinite(slant) && spring >= 0.0 && spring <= kMostPasses;
  if (!meant || std::pow(full / first, fall) > kMostPasses) {
    talker_.error(Code::word_out_of_range, line_.column(),
                  "G76 needs P (pitch), I, J, K not below J, R from 1; it is left out");
    return;
  }
  const double side = peak > 0.0 ? 1.0 : -1.0;
  const auto pass = [&](double depth) {
    Place at = start;
    at.at.x = start.at.x - side * (std::abs(peak) - depth);
    const double back = at.at.x;
    at.at.z -= depth * slant;
    rapid(at);
    at.at.x = start.at.x + side * (std::abs(peak) + depth);
    rapid(at);
    at.at.z = end->at.z + (full - depth) * slant;
    cut(at, pitch * modes_.speed);
    at.at.x = back;
    rapid(at);
  };
  double depth = first;
  for (int n = 2; depth < full && !full_; ++n) {
    pass(depth);
    depth = first * std::pow(n, 1.0 / fall);
  }
  for (int i = 0; i <= static_cast<int>(spring) && !full_; ++i) pass(full);
  Place last = start;
  last.at.z = end->at.z;
  rapid(last);
}

}  // namespace kerf::gcode

// Printers: Marlin and Klipper. E is the filament, heaters and fans are steps of their own.
//
// Source: Marlin's list of G-codes; Klipper's page "G-Codes".
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "front/gcode/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr double kFullFan = 255.0;
constexpr double kHottest = 2000.0;  // degrees Celsius that can be meant
constexpr double kChord = 0.01;      // mm that a bead may stray from its arc
constexpr int kMostChords = 10'000;
constexpr int kMostFans = 100;

}  // namespace

/// True for a line whose M code only a printer has.
bool Interpreter::printer_line() {
  const bool printer = program_.dialect == GcodeDialect::marlin || program_.dialect == GcodeDialect::klipper;
  if (!printer) return false;
  if (line_.has('T') && !line_.has_codes()) {  // changes at once
    select_tool();
    if (modes_.selected_tool) {
      modes_.tool = *modes_.selected_tool;
      add(step::ToolChange{*modes_.tool});
    }
  }
  if (line_.large_m_code() >= 0) return true;
  if (!line_.has(Group::other)) return false;
  const Tenths code = line_.code(Group::other);
  return code == 820 || code == 830 || code == 840;
}

void Interpreter::printer_code() {
  const int code = line_.large_m_code();
  if (code < 0) {
    const Tenths small = line_.code(Group::other);
    if (small != 840) filament_relative_ = small == 830;
    return;
  }
  const auto heat = [&](Heater heater, bool wait) {
    const double celsius = std::clamp(line_.take('S').value_or(line_.take('R').value_or(0.0)), 0.0, kHottest);
    add(step::Temperature{heater, celsius, wait});
  };
  switch (code) {
    case 104: return heat(Heater::nozzle, false);
    case 109: return heat(Heater::nozzle, true);
    case 140: return heat(Heater::bed, false);
    case 190: return heat(Heater::bed, true);
    case 141: return heat(Heater::chamber, false);
    case 191: return heat(Heater::chamber, true);
    case 106:
    case 107: {
      const auto fan = static_cast<int>(std::clamp(line_.take('P').value_or(0.0), 0.0, double{kMostFans}));
      const double power = code == 107 ? 0.0 : line_.take('S').value_or(kFullFan);
      add(step::Fan{fan, std::clamp(power / kFullFan, 0.0, 1.0)});
      return;
    }
    default: add(step::Verbatim{fmt::format("M{}", code)}); return;  // the machine's own matter
  }
}

/// G28 drives to the ends of the axes, G92 sets coordinates and the filament's zero.
void Interpreter::printer_reference() {
  const Tenths code = line_.code(Group::reference);
  if (code == 920) {
    const std::optional<double> e = line_.take('E');
    if (e) filament_ = *e;
    if (line_.has_unused(kAxisLetters)) shift_zero();
    return;
  }
  if (code == 280) {
    add(step::Verbatim{"G28"});
    const bool all = !line_.has_any(kAxisLetters);
    for (int axis = 0; axis < 3; ++axis) {
      const auto letter = static_cast<char>('X' + axis);
      if (!all && !line_.has(letter)) continue;
      here_.at[axis] = 0.0;
      here_.unknown |= 1u << axis;
    }
  }
  line_.use(kAllLetters);
}

/// A straight move with an E word: a bead where it moves, filament pushed or drawn back where it stands.
void Interpreter::extrude(const Place& to, double feed) {
  const double e = line_.take('E').value_or(0.0);
  const double pushed = (filament_relative_ ? e : e - filament_) * modes_.scale;
  filament_ = filament_relative_ ? filament_ + e : e;
  const double area = std::numbers::pi / 4.0 * options_.filament_diameter * options_.filament_diameter;
  const bool moves = !(to.at == here_.at);
  if (moves && !(pushed > 0.0)) return cut(to, feed);
  step::Extrude bead;
  bead.to = to.at;
  bead.volume = Volume::raw(pushed * area);
  bead.feed = mm_per_min(feed);
  if (std::isfinite(bead.volume.raw()) && add(bead)) arrive(to);
}

/// Beads are straight: an arc with an E word becomes chords, each with its share.
void Interpreter::extrude_arc(const ArcWalk& walk, const Place& to, Feed feed) {
  const double e = line_.take('E').value_or(0.0);
  const double pushed = filament_relative_ ? e : e - filament_;
  const int count = walk.chords(mm(kChord), kMostChords);
  const double begin = filament_;
  const bool relative = filament_relative_;
  for (int i = 1; i <= count; ++i) {
    Place next = to;
    if (i < count) next.at = walk.at(i / double(count));
    line_.put('E', relative ? pushed / count : begin + pushed * i / count);
    extrude(next, feed.mm_per_min());
  }
}

}  // namespace kerf::gcode

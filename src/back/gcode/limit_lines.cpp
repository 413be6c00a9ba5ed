// The limits of a printer's motions.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "back/gcode/print_lines.h"
#include "base/number.h"

namespace kerf::gcode {
namespace {

constexpr int kLimitDecimals = 3;  // of speeds and accelerations

std::int64_t counts_of(double value, int decimals) { return std::llround(value * std::pow(10.0, decimals)); }

}  // namespace

/// A limit that the firmware has no command for changes the time of a print, not its shape: one warning.
void LimitLines::skip_limits(std::size_t i, LimitKind kind) {
  const unsigned bit = 1u << static_cast<unsigned>(kind);
  if ((skipped_ & bit) != 0) return;
  skipped_ |= bit;
  std::string name(to_string(kind));
  std::replace(name.begin(), name.end(), '_', ' ');
  report_skipped(i, fmt::format("{} has no command for this limit ({}); it", profile_.title, name));
}

/// The given values as words, multiplied by `factor`.
void LimitLines::put_limits(std::size_t i, const step::MotionLimits& limits, std::string_view letters,
                            double factor) {
  const double unit_mm = units_.unit_mm;
  for (std::size_t k = 0; k < letters.size(); ++k)
    if ((limits.given >> k & 1u) != 0)
      lines_.word(letters[k], counts_of(limits.values[k] * factor / unit_mm, kLimitDecimals), kLimitDecimals);
  lines_.end_line(i);
}

void LimitLines::motion_limits(std::size_t i) {
  const step::MotionLimits limits = path_[i].motion_limits();
  if (profile_.limits == LimitCommands::klipper) return put_klipper_limit(i, limits);
  constexpr double kPerMinute = 60.0;
  const bool reprap = profile_.limits == LimitCommands::reprap;
  const double speed = reprap ? kPerMinute : 1.0;
  const bool jerk_in_566 = reprap && limits.kind == LimitKind::jerk;
  const bool own_kind =
      limits.kind == LimitKind::corner_speed || (reprap && limits.kind == LimitKind::junction_deviation);
  if (profile_.limits == LimitCommands::none || own_kind) return skip_limits(i, limits.kind);
  constexpr int kCodes[] = {2010, 2030, 2040, 2050, 2050};
  const int tenths = jerk_in_566 ? 5660 : kCodes[static_cast<std::size_t>(limits.kind)];
  if (!profile_.has_m(tenths)) return skip_limits(i, limits.kind);
  lines_.start_line();
  lines_.code('M', tenths);
  switch (limits.kind) {
    case LimitKind::axis_acceleration: return put_limits(i, limits, "XYZE", 1.0);
    case LimitKind::axis_speed: return put_limits(i, limits, "XYZE", speed);
    case LimitKind::acceleration: return put_limits(i, limits, "PRT", 1.0);
    case LimitKind::jerk: return put_limits(i, limits, "XYZE", speed);
    case LimitKind::junction_deviation: return put_limits(i, limits, "J", 1.0);
    case LimitKind::corner_speed: return;
  }
}

/// Klipper has one acceleration for all motions, and one speed for X and Y together.
void LimitLines::put_klipper_limit(std::size_t i, const step::MotionLimits& limits) {
  double value = -1.0;
  for (std::size_t k = 0; k < limits.values.size(); ++k) {
    const bool counts = limits.kind == LimitKind::acceleration ? k == 0 || k == 2
                        : limits.kind == LimitKind::axis_speed ? k < 2
                                                               : k == 0;
    if (counts && (limits.given >> k & 1u) != 0)
      value = value < 0.0 ? limits.values[k] : std::min(value, limits.values[k]);
  }
  const std::string_view name = limits.kind == LimitKind::acceleration   ? "ACCEL"
                                : limits.kind == LimitKind::axis_speed   ? "VELOCITY"
                                : limits.kind == LimitKind::corner_speed ? "SQUARE_CORNER_VELOCITY"
                                                                         : "";
  if (name.empty() || value < 0.0) return skip_limits(i, limits.kind);
  lines_.text_line(fmt::format("SET_VELOCITY_LIMIT {}={}", name, number_text(value, kLimitDecimals)));
}

}  // namespace kerf::gcode

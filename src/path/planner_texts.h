// What the texts in a toolpath state about the planning of motions: settings of slicers and of Klipper.
//
// Slicers write the limits with which they compute the time of a print as comments, at the end of the program
// or at its start. In a toolpath they are notes before the first motion, "machine_max_feedrate_x = 500,200";
// they hold for the time alone, because the printer does not read them. Commands of the program override
// them.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "kerf/path/toolpath.h"

namespace kerf {

/// The note in the toolpath of a program for Klipper that states no limits of a slicer.
inline constexpr std::string_view kKlipperNote = "gcode_flavor = klipper";

/// The limit of a note; of two values (PrusaSlicer: normal and silent) the first one. Nothing for other texts
/// and for a value of 0, which is none.
std::optional<step::MotionLimits> read_limit_note(std::string_view text);
/// The notes of a program: the settings in its comments, at its start or end. Empty where it says that the
/// limits are not for the time (machine_limits_usage = ignore).
std::vector<std::string_view> limit_notes(std::string_view program);

/// Whether a note is for the planner alone, so that no printer needs it.
bool is_planner_note(std::string_view text);

/// How much of a short motion Klipper runs at a constant speed.
struct CruiseLimit {
  std::optional<double> ratio;     // MINIMUM_CRUISE_RATIO, 0 to 1
  std::optional<double> to_decel;  // ACCEL_TO_DECEL, mm/s2
};
/// The words of a line "SET_VELOCITY_LIMIT ACCEL_TO_DECEL=2500"; nothing for other lines.
CruiseLimit read_cruise_limit(std::string_view line);

}  // namespace kerf

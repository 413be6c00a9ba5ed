// The commands of printers with words of their own: limits of motions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kerf/path/toolpath.h"
#include "kerf/program/gcode_options.h"

namespace kerf::gcode {

struct LimitCommand {
  std::vector<step::MotionLimits> list;
  std::string rest;  // the command with the words that no step has; empty: none
};
/// The limits that a command sets: M201, M203, M204, M205, M566 and, for Klipper, SET_VELOCITY_LIMIT word by
/// word. `scale`: mm per unit of the program. Empty for other commands, and for M codes with words that have
/// no step.
LimitCommand read_limits(std::string_view command, GcodeDialect dialect, double scale);

/// Whether a command sets minimum feeds of 0, which is no limit (M205 S0 T0).
bool sets_no_minimum_feed(std::string_view command);

}  // namespace kerf::gcode

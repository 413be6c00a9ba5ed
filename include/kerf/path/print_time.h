// Printing time as the firmware plans it: straight motions of X, Y, Z and the filament with constant
// acceleration, and a speed through corners that depends on the firmware.
//
//   const PrintTime time = estimate_print_time(path, default_planner(path));
//   time.total().seconds();
//
// `jerk` (Marlin's classic jerk, RepRapFirmware, the estimates of slicers): at a corner no axis changes its
// speed by more than its jerk. `junction_deviation` (Marlin): the speed of an arc that deviates from the
// corner by so much. `square_corner` (Klipper): the same, with the deviation at which a corner of 90 degrees
// is run at the given speed. Limits that the program sets (step::MotionLimits) replace those of the planner
// from there on. The firmware looks ahead as far as necessary. Heating and homing are not timed, as in
// slicers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kerf/base/units.h"
#include "kerf/path/toolpath.h"

namespace kerf {

enum class CornerRule : std::uint8_t { jerk, junction_deviation, square_corner };

/// Arrays are X, Y, Z, E; mm and seconds. The default is Marlin's configuration.
struct PrintPlanner {
  CornerRule corners = CornerRule::jerk;
  std::array<double, 4> axis_speed{300, 300, 5, 25};                // mm/s
  std::array<double, 4> axis_acceleration{3000, 3000, 100, 10000};  // mm/s2
  std::array<double, 4> jerk{10, 10, 0.3, 5};                       // mm/s
  std::array<double, 3> acceleration{3000, 3000, 3000};             // of beads, retractions, travel; mm/s2
  double junction_deviation = 0.013;                                // mm
  double corner_speed = 5.0;                                        // mm/s
  Length filament = mm(1.75);                                       // diameter
};
/// The planner of a program: Klipper's if it sets a corner speed, one with a junction deviation if it sets
/// that, else one with jerks. `filament`: the diameter of its E words.
PrintPlanner default_planner(const Toolpath& path, Length filament = mm(1.75));

struct PrintTime {
  Duration motion;                           // all of them
  std::array<Duration, kBeadKinds> beads{};  // of this: by kind
  Duration travel;                           // of this: motions without filament
  Duration retraction;                       // of this: filament moved without laying a bead
  Duration dwell;
  std::size_t not_timed = 0;  // motions without a feed, and homing
  Duration total() const { return motion + dwell; }
};
PrintTime estimate_print_time(const Toolpath& path, const PrintPlanner& planner);

/// Seconds of each step.
std::vector<float> print_seconds(const Toolpath& path, const PrintPlanner& planner);

}  // namespace kerf

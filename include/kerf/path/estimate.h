// Times of toolpaths: of a machine, and of a printer by its firmware.
//
// Machining time of a toolpath as planned by the controller: acceleration, slower corners, and a short
// look-ahead that brakes on short motions.
//
//   TimeEstimate time = estimate_time(path, machine);
//   time.all.motion.seconds();
//
// The model is that of GRBL's page "Grbl v1.1 Configuration" ($11, $12, $110-$122): straight motions with
// constant acceleration, limited on each axis; the speed through a corner from the junction deviation; arcs
// as chords; a queue of planned motions whose last one ends at rest, refilled after every motion (an
// infinitely fast sender). Changes of spindle and coolant, pauses, dwells, tool changes and changes of the
// work offset stop the machine. Feeds are those of the program; overrides are 100%.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kerf/base/units.h"
#include "kerf/path/machine.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// Times of a part of a toolpath.
struct TimeFigures {
  Duration motion;  // motions alone, including braking for stops
  Duration rapid;   // of `motion`: rapids
  Duration dwell;   // as programmed
  Duration halts;   // Machine::stop_time of every stop
  std::size_t stops = 0;
  Duration cutting() const { return motion - rapid; }
  Duration total() const { return motion + dwell + halts; }
};

struct ToolTime {
  std::optional<int> tool;  // nothing: before the first tool change
  TimeFigures time;
};

/// A section of the toolpath that a tool change, a layer or a note starts.
struct OperationTime {
  std::string name;  // text of the layer or note; may be empty
  std::optional<int> tool;
  std::size_t first_step = 0;
  TimeFigures time;
};

struct TimeEstimate {
  TimeFigures all;
  std::vector<ToolTime> tools;  // in order of first use; a tool used again is one entry
  std::vector<OperationTime>
      operations;         // those with motions; at most 1000, the last one then contains the rest
  std::size_t moves = 0;  // planned ones: chords of arcs each count
  /// Motions without a feed, and motions of rotary axes alone that are rapids or start at an unknown angle.
  /// Others of rotary axes alone take the time of their feed, from rest to rest, without acceleration.
  std::size_t not_timed = 0;
};

TimeEstimate estimate_time(const Toolpath& path, const Machine& machine);

/// Seconds per step, including dwells.
std::vector<float> step_seconds(const Toolpath& path, const Machine& machine);

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
  double cruise_ratio = 0.5;   // of a motion's length at constant speed, at least (Klipper)
  Length filament = mm(1.75);  // diameter
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

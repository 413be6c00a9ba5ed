// What a machine can do: rates, accelerations, how its controller plans ahead, how far it travels.
//
// Files of machines are read by machine_files.h. A new Machine is a small router run by GRBL 1.1.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "kerf/geometry.h"
#include "kerf/units.h"

namespace kerf {

using Acceleration = Quantity<1, -2>;
constexpr Acceleration mm_per_s2(double v) { return Acceleration::raw(v * 3600.0); }
constexpr double in_mm_per_s2(Acceleration a) { return a.raw() / 3600.0; }

/// Which program runs the machine, as far as that changes what a file does: GRBL is fed line by line, so that
/// what follows M2 runs too, and it reads F and the units as modal for every line.
enum class Controller : std::uint8_t { other, grbl };
/// With `follows` the beam follows S from move to move without a stop (GRBL's $32=1).
enum class LaserDrive : std::uint8_t { stops, follows };

/// How far an axis goes, in machine coordinates (mm).
struct AxisTravel {
  double low = 0.0, high = 0.0;
  double length() const { return high - low; }
};

/// Arrays are X, Y, Z.
struct Machine {
  std::string name = "GRBL router";
  Controller controller = Controller::grbl;

  std::array<Feed, 3> rates{mm_per_min(3000), mm_per_min(3000), mm_per_min(1000)};
  std::array<Acceleration, 3> accelerations{mm_per_s2(200), mm_per_s2(200), mm_per_s2(50)};
  Feed slowest_feed = mm_per_min(1);  // lower feeds are driven at this one
  /// How far a corner may be rounded in thought: the speed through a corner is that of an arc that leaves it
  /// by so much, at the axes' acceleration. 0: every corner is a stop.
  Length junction_deviation = mm(0.01);
  /// Arcs are driven as chords that leave the circle by so much.
  Length arc_tolerance = mm(0.002);
  /// Moves planned at a time; the last of them ends at rest. GRBL has a ring of 16, of which 15 are used.
  int look_ahead = 15;
  /// Positions are whole steps; 0: not rounded.
  std::array<double, 3> steps_per_mm{};
  /// What every full stop costs besides the braking (GRBL's $1, when the drivers are let go).
  Duration stop_time;
  LaserDrive laser = LaserDrive::stops;

  std::array<std::optional<AxisTravel>, 3> travel;
  /// Where the program's zero lies in machine coordinates, where that is known.
  std::optional<Point3> work_zero;
  std::optional<SpindleSpeed> slowest_spindle, fastest_spindle;
};

/// What `limits` (of X, Y, Z, each above 0) allow along the direction of `way`, so that no axis exceeds its
/// own. `way` is not 0.
double along(Point3 way, const std::array<double, 3>& limits);

}  // namespace kerf

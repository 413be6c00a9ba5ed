// A machine: rates, accelerations, the planning of its controller, travel.
//
// workshop_files.h reads machine files. The default Machine is a small router run by GRBL 1.1.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"

namespace kerf {

using Acceleration = Quantity<1, -2>;
constexpr Acceleration mm_per_s2(double v) { return Acceleration::raw(v * 3600.0); }
constexpr double in_mm_per_s2(Acceleration a) { return a.raw() / 3600.0; }

/// The controller, where it affects a program: GRBL receives single lines, so lines after M2 run too, and F
/// and units are modal for every line.
enum class Controller : std::uint8_t { other, grbl };
/// With `follows` the power changes from motion to motion without a stop (GRBL's $32=1).
enum class LaserDrive : std::uint8_t { stops, follows };

/// Travel of an axis in machine coordinates (mm).
struct AxisTravel {
  double low = 0.0, high = 0.0;
  double length() const { return high - low; }
};

/// Maximum rates of X, Y and Z, each above 0.
using AxisRates = std::array<Feed, 3>;

/// Arrays are X, Y, Z.
struct Machine {
  std::string name = "GRBL router";
  Controller controller = Controller::grbl;

  AxisRates rates{mm_per_min(3000), mm_per_min(3000), mm_per_min(1000)};
  std::array<Acceleration, 3> accelerations{mm_per_s2(200), mm_per_s2(200), mm_per_s2(50)};
  Feed slowest_feed = mm_per_min(1);  // lower feeds are raised to it
  /// The speed at a corner is that of an arc that deviates from it by this much, at the acceleration of the
  /// axes. 0: every corner is a stop.
  Length junction_deviation = mm(0.01);
  /// Maximum distance of the chords that arcs are run as.
  Length arc_tolerance = mm(0.002);
  /// Number of motions planned ahead; the last one ends at rest. GRBL has a ring of 16, of which 15 are used.
  int look_ahead = 15;
  /// Positions are rounded to steps; 0: not rounded.
  std::array<double, 3> steps_per_mm{};
  /// Time of a full stop in addition to braking (GRBL's $1, while the motors stay on).
  Duration stop_time;
  LaserDrive laser = LaserDrive::stops;
  /// Rapids move each axis at its own rate until it has arrived, so that their path has corners ("dog-leg").
  bool rapids_by_axis = false;

  std::optional<AxisRates> rates_by_axis() const {
    return rapids_by_axis ? std::optional(rates) : std::nullopt;
  }

  std::array<std::optional<AxisTravel>, 3> travel;
  /// Work zero in machine coordinates, if known.
  std::optional<Point3> work_zero;
  std::optional<SpindleSpeed> slowest_spindle, fastest_spindle;
};

/// Where and when a rapid of axes that move each at its own rate changes its direction.
struct RapidCorner {
  Point3 at;
  double fraction = 0.0;  // of its time, between 0 and 1
};
/// In order of time; none on a straight way, at most two.
std::vector<RapidCorner> corners_of_rapid(const Point3& from, const Point3& to, const AxisRates& rates);

/// The maximum along the direction of `way` (not 0) such that no axis exceeds its limit in `limits` (X, Y, Z,
/// each above 0).
double along(Point3 way, const std::array<double, 3>& limits);

}  // namespace kerf

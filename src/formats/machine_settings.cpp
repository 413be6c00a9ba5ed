// The tables of settings.
#include "formats/machine_settings.h"

#include <algorithm>

namespace kerf::detail {
namespace {

// Ranges of settings: far beyond real machines, and safe to compute with.
constexpr double kMinRate = 1e-3, kMaxRate = 1e6;                  // mm/min
constexpr double kMinAcceleration = 1e-3, kMaxAcceleration = 1e7;  // mm/s^2
constexpr double kMaxLength = 1e6;                                 // mm
constexpr double kMinTolerance = 1e-5;                             // mm
constexpr double kMaxStepsPerMm = 1e6;
constexpr double kMaxLookAhead = 10'000;  // motions
constexpr double kMaxRpm = 1e6;
constexpr double kMotorsAlwaysOn = 255;  // GRBL's $1

template <int Axis>
void set_rate(Machine& m, double v) {
  m.rates[Axis] = mm_per_min(v);
}
template <int Axis>
void set_acceleration(Machine& m, double v) {
  m.accelerations[Axis] = mm_per_s2(v);
}
template <int Axis>
void set_steps(Machine& m, double v) {
  m.steps_per_mm[Axis] = v;
}
/// GRBL's machine coordinates end at 0, the position after homing.
template <int Axis>
void set_travel(Machine& m, double v) {
  m.travel[Axis] = AxisTravel{-v, 0.0};
}

void set_three(Machine& m, const double* v, void (*x)(Machine&, double), void (*y)(Machine&, double),
               void (*z)(Machine&, double)) {
  x(m, v[0]);
  y(m, v[1]);
  z(m, v[2]);
}

template <std::size_t Axis>
void set_ends(Machine& m, const double* v) {
  m.travel[Axis] = AxisTravel{std::min(v[0], v[1]), std::max(v[0], v[1])};
}

}  // namespace

const std::vector<MachineSetting>& machine_settings() {
  static const std::vector<MachineSetting> all{
      {"rate", 3, kMinRate, kMaxRate, "rates of X, Y, Z in mm/min",
       [](Machine& m, const double* v) { set_three(m, v, set_rate<0>, set_rate<1>, set_rate<2>); }},
      {"acceleration", 3, kMinAcceleration, kMaxAcceleration, "accelerations of X, Y, Z in mm/s2",
       [](Machine& m, const double* v) {
         set_three(m, v, set_acceleration<0>, set_acceleration<1>, set_acceleration<2>);
       }},
      {"steps_per_mm", 3, 0, kMaxStepsPerMm, "steps per mm of X, Y, Z",
       [](Machine& m, const double* v) { set_three(m, v, set_steps<0>, set_steps<1>, set_steps<2>); }},
      {"junction_deviation", 1, 0, kMaxLength, "a length in mm",
       [](Machine& m, const double* v) { m.junction_deviation = mm(v[0]); }},
      {"arc_tolerance", 1, kMinTolerance, kMaxLength, "a length in mm",
       [](Machine& m, const double* v) { m.arc_tolerance = mm(v[0]); }},
      {"slowest_feed", 1, kMinRate, kMaxRate, "a feed in mm/min",
       [](Machine& m, const double* v) { m.slowest_feed = mm_per_min(v[0]); }},
      {"look_ahead", 1, 1, kMaxLookAhead, "a number of motions",
       [](Machine& m, const double* v) { m.look_ahead = static_cast<int>(v[0]); }},
      {"stop_time", 1, 0, 3600, "seconds", [](Machine& m, const double* v) { m.stop_time = seconds(v[0]); }},
      {"spindle", 2, 0, kMaxRpm, "lowest and highest speed in rpm",
       [](Machine& m, const double* v) {
         m.slowest_spindle = rpm(std::min(v[0], v[1]));
         m.fastest_spindle = rpm(std::max(v[0], v[1]));
       }},
      {"work_zero", 3, -kMaxLength, kMaxLength, "a position in machine coordinates, mm",
       [](Machine& m, const double* v) {
         m.work_zero = Point3{v[0], v[1], v[2]};
       }},
      {"travel_x", 2, -kMaxLength, kMaxLength, "both ends of the axis in machine coordinates, mm",
       set_ends<0>},
      {"travel_y", 2, -kMaxLength, kMaxLength, "both ends of the axis in machine coordinates, mm",
       set_ends<1>},
      {"travel_z", 2, -kMaxLength, kMaxLength, "both ends of the axis in machine coordinates, mm",
       set_ends<2>},
  };
  return all;
}

const std::vector<GrblSetting>& grbl_settings() {
  static const std::vector<GrblSetting> all{
      {1, 0, 1e5, "milliseconds",
       [](Machine& m, double v) { m.stop_time = v == kMotorsAlwaysOn ? Duration{} : seconds(v / 1000.0); }},
      {11, 0, kMaxLength, "a length in mm", [](Machine& m, double v) { m.junction_deviation = mm(v); }},
      {12, kMinTolerance, kMaxLength, "a length in mm",
       [](Machine& m, double v) { m.arc_tolerance = mm(v); }},
      {20, 0, 1, "0 or 1", [](Machine&, double) {}},  // whether the travel counts
      {30, 0, kMaxRpm, "a speed in rpm", [](Machine& m, double v) { m.fastest_spindle = rpm(v); }},
      {31, 0, kMaxRpm, "a speed in rpm", [](Machine& m, double v) { m.slowest_spindle = rpm(v); }},
      {32, 0, 1, "0 or 1",
       [](Machine& m, double v) { m.laser = v == 0.0 ? LaserDrive::stops : LaserDrive::follows; }},
      {100, 0, kMaxStepsPerMm, "steps per mm", set_steps<0>},
      {101, 0, kMaxStepsPerMm, "steps per mm", set_steps<1>},
      {102, 0, kMaxStepsPerMm, "steps per mm", set_steps<2>},
      {110, kMinRate, kMaxRate, "a rate in mm/min above 0", set_rate<0>},
      {111, kMinRate, kMaxRate, "a rate in mm/min above 0", set_rate<1>},
      {112, kMinRate, kMaxRate, "a rate in mm/min above 0", set_rate<2>},
      {120, kMinAcceleration, kMaxAcceleration, "an acceleration in mm/s2 above 0", set_acceleration<0>},
      {121, kMinAcceleration, kMaxAcceleration, "an acceleration in mm/s2 above 0", set_acceleration<1>},
      {122, kMinAcceleration, kMaxAcceleration, "an acceleration in mm/s2 above 0", set_acceleration<2>},
      {130, 0, kMaxLength, "a length in mm", set_travel<0>},
      {131, 0, kMaxLength, "a length in mm", set_travel<1>},
      {132, 0, kMaxLength, "a length in mm", set_travel<2>},
  };
  return all;
}

}  // namespace kerf::detail

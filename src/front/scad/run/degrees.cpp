// Angles are reduced to the first half quadrant before the library's functions see them.
#include "front/scad/run/degrees.h"

#include <cmath>
#include <numbers>

namespace kerf::scad {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0, kDegrees = 180.0 / std::numbers::pi;

/// Whether an angle has a sine: as in OpenSCAD, one of 2^52 turns or more has none.
bool has_sine(double x) { return std::fabs(x) < 4503599627370496.0 * 360.0; }

/// x less whole turns: in [0, 360).
double turn_fraction(double x) {
  const double turns = std::floor(x / 360.0);
  double r = x - turns * 360.0;
  if (r < 0.0) r += 360.0;
  if (r >= 360.0) r -= 360.0;
  return r;
}

/// The sine of an angle from 0 to 90.
double quadrant_sine(double r) {
  if (r > 45.0) return r == 60.0 ? 0.5 * std::numbers::sqrt3 : std::cos((90.0 - r) * kRadians);
  if (r == 45.0) return std::numbers::sqrt2 / 2.0;
  return r == 30.0 ? 0.5 : std::sin(r * kRadians);
}

/// The angle of an exact fraction, else that of the library.
double exact_or(double x, double angle) {
  const double rounded = std::round(angle);
  return std::fabs(angle - rounded) < 1e-12 && sin_degrees(rounded) == x ? rounded : angle;
}

}  // namespace

double sin_degrees(double x) {
  if (!has_sine(x)) return std::nan("");
  double r = turn_fraction(x), sign = 1.0;
  if (r >= 180.0) {
    r -= 180.0;
    sign = -1.0;
  }
  if (r > 90.0) r = 180.0 - r;
  return sign * quadrant_sine(r);
}

double cos_degrees(double x) {
  if (!has_sine(x)) return std::nan("");
  double r = turn_fraction(x), sign = 1.0;
  if (r > 180.0) r = 360.0 - r;
  if (r > 90.0) {
    r = 180.0 - r;
    sign = -1.0;
  }
  return sign * quadrant_sine(90.0 - r);
}

double tan_degrees(double x) {
  if (!has_sine(x)) return std::nan("");
  double r = turn_fraction(x);
  if (r == 90.0) return HUGE_VAL;
  if (r == 180.0) return -0.0;
  if (r == 270.0) return -HUGE_VAL;
  if (r >= 180.0) r -= 180.0;
  double sign = 1.0;
  if (r > 90.0) {
    r = 180.0 - r;
    sign = -1.0;
  }
  if (r == 45.0) return sign;
  if (r == 30.0) return sign * (std::numbers::sqrt3 / 3.0);
  if (r == 60.0) return sign * std::numbers::sqrt3;
  return sign * std::tan(r * kRadians);
}

double asin_degrees(double x) { return exact_or(x, std::asin(x) * kDegrees); }

double acos_degrees(double x) {
  const double angle = std::acos(x) * kDegrees, rounded = std::round(angle);
  return std::fabs(angle - rounded) < 1e-12 && cos_degrees(rounded) == x ? rounded : angle;
}

double atan_degrees(double x) {
  const double angle = std::atan(x) * kDegrees, rounded = std::round(angle);
  return std::fabs(angle - rounded) < 1e-12 && tan_degrees(rounded) == x ? rounded : angle;
}

double atan2_degrees(double y, double x) {
  const double angle = std::atan2(y, x) * kDegrees, rounded = std::round(angle);
  return std::fabs(angle - rounded) < 3e-14 * 180.0 ? rounded : angle;
}

}  // namespace kerf::scad

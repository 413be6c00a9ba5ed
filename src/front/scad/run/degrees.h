// Trigonometry in degrees, exact where the value is a simple fraction: sin(30) is 0.5.
#pragma once

namespace kerf::scad {

double sin_degrees(double x);
double cos_degrees(double x);
double tan_degrees(double x);
double asin_degrees(double x);
double acos_degrees(double x);
double atan_degrees(double x);
double atan2_degrees(double y, double x);

}  // namespace kerf::scad

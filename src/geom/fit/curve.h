// Bézier curves and splines to compute on: points, derivatives, and how many chords stay near them.
#pragma once

#include <vector>

#include "kerf/geom/fit.h"

namespace kerf::outline_detail {

inline constexpr int kMaxDegree = 25;

/// A point of a curve and its derivative.
struct CurveSample {
  Point2 at, slope;
};

/// A Bézier curve over 0 to 1: one polynomial, or a quotient of two.
struct RationalBezier {
  struct Control {
    double x, y, w;  // x and y are multiplied with the weight
  };
  std::vector<Control> control;  // at least two, at most kMaxDegree + 1; weights above 0

  CurveSample at(double t) const;
  /// Chords of equal steps of the parameter that deviate from the curve by at most `chord` mm; a bound that
  /// is exact for parabolas, and at most `limit`.
  int chords(double chord, int limit) const;
};

/// The polynomial pieces of a valid spline (as many knots as it needs, none falling, weights above
/// 0).
std::vector<RationalBezier> pieces_of(const Spline& spline);

}  // namespace kerf::outline_detail

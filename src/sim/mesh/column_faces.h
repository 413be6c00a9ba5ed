// Areas of the faces of columns, and of the rays of a fourth-axis workpiece, from which the volume range of
// their mesh follows.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include "sim/mesh/mesh_columns.h"

#include "kerf/geom/mesh_check.h"

namespace kerf::meshing {

/// Volume of columns, area of their ends, and area of their sides that their neighbours do not cover.
struct Faces {
  double volume = 0.0, ends = 0.0, sides = 0.0;  // mm3, mm2
};

inline double height(float low, float high) { return static_cast<double>(high) - static_cast<double>(low); }

/// Sum of measure(low, high) over the symmetric difference of two columns.
template <class Measure>
double unshared(Runs a, Runs b, const Measure& measure) {
  if (a.size() == 1 && b.size() == 1 && a[0].low < b[0].high && b[0].low < a[0].high)
    return measure(std::min(a[0].low, b[0].low), std::max(a[0].low, b[0].low)) +
           measure(std::min(a[0].high, b[0].high), std::max(a[0].high, b[0].high));
  double sum = 0.0;
  for (const Interval& run : a) sum += measure(run.low, run.high);
  for (const Interval& run : b) sum += measure(run.low, run.high);
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    const float low = std::max(a[i].low, b[k].low), high = std::min(a[i].high, b[k].high);
    if (low < high) sum -= 2.0 * measure(low, high);
    (a[i].high < b[k].high ? i : k) += 1;
  }
  return sum;
}

/// Maximum movement of a face by rounding coordinates of up to `farthest` mm to single precision.
inline double rounding(double farthest) {
  return farthest * static_cast<double>(std::numeric_limits<float>::epsilon());
}

/// The range of the volume if all faces may be off by `moved` mm, those of the sides by another pitch.
VolumeRange volume_range(const Faces& faces, double pitch, double moved);

}  // namespace kerf::meshing

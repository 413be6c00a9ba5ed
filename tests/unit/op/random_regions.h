// Random regions for tests of operations.
#pragma once

#include <random>
#include <vector>

#include "swept.h"

namespace kerf::test {

/// Unions of rectangles, circles and triangles at random.
inline Region random_region(std::mt19937_64& random) {
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<Region> parts;
  const int count = 1 + static_cast<int>(in(0, 6));
  for (int i = 0; i < count; ++i) {
    const Point2 at{in(0, 50), in(0, 40)};
    const double kind = in(0, 3);
    if (kind < 1)
      parts.push_back(region_of(
          {rotated(rectangle(at.x, at.y, at.x + in(3, 30), at.y + in(3, 30)), at, degrees(in(0, 90)))}));
    else if (kind < 2)
      parts.push_back(region_of({as_outline({at, mm(in(1, 15))})}));
    else
      parts.push_back(region_of(
          {polygon({at, {at.x + in(5, 30), at.y + in(-5, 5)}, {at.x + in(-5, 15), at.y + in(5, 30)}})}));
  }
  Diagnostics diagnostics;
  Region all = *unite(parts, {}, diagnostics);
  if (in(0, 1) < 0.6) {
    const Region hole = region_of({as_outline({{in(5, 45), in(5, 35)}, mm(in(1, 8))})});
    all = combine(all, hole, Boolean::subtract, {}, diagnostics)->region;
  }
  return all;
}

}  // namespace kerf::test

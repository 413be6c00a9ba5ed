// Where a path and those embedded in it are in work coordinates.
#pragma once

#include <cmath>

#include "kerf/base/origin.h"
#include "kerf/geom/geometry.h"

namespace kerf::pathdxf {

/// A rotation about Z and a shift.
struct Frame {
  double cosine = 1.0, sine = 0.0;
  Point2 shift;
  double raise = 0.0;                // mm, added to all heights
  OriginId caller = OriginId::none;  // of the embedding

  Point2 operator()(Point2 p) const {
    return {cosine * p.x - sine * p.y + shift.x, sine * p.x + cosine * p.y + shift.y};
  }
  double angle() const { return std::atan2(sine, cosine); }
};

/// The frame of an embedded path: its points `from`, `to` become `start`, `end` of the path around it.
inline Frame embedded(const Frame& outer, Point2 from, Point2 to, Point2 start, Point2 end, double raise) {
  const Point2 own = to - from, here = end - start;
  const double size = length(own) * length(here);
  Frame inner;
  if (size > 0.0) {
    inner.cosine = dot(own, here) / size;
    inner.sine = cross(own, here) / size;
  }
  Frame f;
  f.cosine = outer.cosine * inner.cosine - outer.sine * inner.sine;
  f.sine = outer.sine * inner.cosine + outer.cosine * inner.sine;
  const Point2 at = outer(start);
  f.shift = {at.x - (f.cosine * from.x - f.sine * from.y), at.y - (f.sine * from.x + f.cosine * from.y)};
  f.raise = outer.raise + raise;
  return f;
}

}  // namespace kerf::pathdxf

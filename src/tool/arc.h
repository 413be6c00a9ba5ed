// The circle behind a profile's arc.
#pragma once

#include "geom/base/line_arc.h"

#include "kerf/tool/tool.h"

namespace kerf::detail {

/// Centre and radius in mm of the arc that starts at a knot with a bulge.
struct ProfileArc {
  double r = 0.0, z = 0.0;
  double radius = 0.0;
};

inline ProfileArc profile_arc(const Knot& from, const Knot& to) {
  const Circle circle = circle_of_bulge({from.r, from.z}, {to.r, to.z}, from.bulge);
  return {circle.centre.x, circle.centre.y, circle.radius.mm()};
}

}  // namespace kerf::detail

// Signs that decide on which side a point lies, right for every input whose products neither overflow nor
// underflow.
#pragma once

#include "kerf/geom/geometry.h"

namespace kerf {

/// Above 0 if a, b, c turn to the left, below 0 if to the right, 0 if and only if they lie on one line. The
/// value is twice the area of the triangle where that is certain, else any number of the right sign.
double orientation(Point2 a, Point2 b, Point2 c);

}  // namespace kerf

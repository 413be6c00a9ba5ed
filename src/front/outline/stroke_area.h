// The area of a stroke of some width along an outline.
#pragma once

#include <optional>

#include "kerf/drawing/dxf.h"
#include "kerf/geom/region.h"

namespace kerf::outline_front {

struct Stroke {
  double width = 0.0;  // mm
  dxf::StrokeEnds ends = dxf::StrokeEnds::butt;
  dxf::StrokeCorners corners = dxf::StrokeCorners::mitre;
  double mitre_limit = 4.0;
};

/// As SVG defines it (SVG 2, 13.5): each segment with its width, its corners, and the ends of an open
/// outline. Nothing, with an error, if it cannot be computed.
std::optional<Region> stroke_area(const Outline& outline, const Stroke& stroke, const RegionOptions& options,
                                  Diagnostics& diagnostics);

}  // namespace kerf::outline_front

// The area of a stroke of some width along an outline.
#pragma once

#include <optional>
#include <vector>

#include "kerf/drawing/dxf.h"
#include "kerf/geom/region.h"

namespace kerf::outline_front {

/// x' = a x + c y, y' = b x + d y: to mm.
struct StrokeFrame {
  double a = 1.0, b = 0.0, c = 0.0, d = 1.0;
  Point2 operator*(Point2 p) const { return {a * p.x + c * p.y, b * p.x + d * p.y}; }
  StrokeFrame inverse() const;
};

struct Stroke {
  double width = 0.0;  // mm, or in the coordinates of `frame`
  dxf::StrokeEnds ends = dxf::StrokeEnds::butt;
  dxf::StrokeCorners corners = dxf::StrokeCorners::mitre;
  double mitre_limit = 4.0;
  std::vector<double> dashes;  // and gaps in turn, like `width`
  double dash_offset = 0.0;
  double path_length = 0.0;            // not 0: what the whole path counts as, for dashes
  Point2 x_axis{1.0, 0.0};             // the direction of squares at points
  std::optional<StrokeFrame> frame{};  // where the stroke is not as wide in all directions
};

/// The stroke of an element, in mm.
Stroke stroke_of(const dxf::Paint& paint, double mm_per_unit);

/// The length that dashes are measured along.
double stroke_length(const Outline& outline, const Stroke& stroke, Length chord);

/// As SVG defines it (SVG 2, 13.5): each segment with its width, its corners, and the ends of an open
/// outline, or a dot where there is no segment. Nothing, with an error, if it cannot be computed.
std::optional<Region> stroke_area(const Outline& outline, const Stroke& stroke, const RegionOptions& options,
                                  Diagnostics& diagnostics);

}  // namespace kerf::outline_front

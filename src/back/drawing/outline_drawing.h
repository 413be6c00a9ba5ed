// Outlines as drawings, for DXF and SVG files; also the ideal outline under the cut one with the router bit.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kerf/drawing/drawing_files.h"
#include "kerf/geom/outline.h"

namespace kerf {

enum class OutlineEntities : std::uint8_t {
  pieces,   ///< a LINE or ARC for each segment, as Cnc25D wrote them
  polyline  ///< one polyline with bulges for each outline, closed where the outline is
};

/// Appends to a drawing whose unit is that of the outline's numbers. `layer` is an index into its layers.
void draw(Drawing& drawing, std::size_t layer, const Outline& outline, OutlineEntities as);
void draw(Drawing& drawing, std::size_t layer, const Circle& circle);
void draw(Drawing& drawing, std::size_t layer, const Figure& figure, OutlineEntities as);

/// An outline and the result of `cut_corners` for it.
struct CutPair {
  Outline ideal;
  CutOutline cut;
};
/// The picture of the corners: the ideal outlines dashed, the cut ones over them, and the router bit's circle
/// at each changed corner. Layers "ideal", "bit" and "cut", in the order of drawing; line widths go with the
/// size.
Drawing corner_picture(const std::vector<CutPair>& pairs, std::string title);
/// The same for figures without corner reports: the first over the second.
Drawing overlay_picture(const Figure& over, const Figure& under, std::string title);

}  // namespace kerf

// SVG drawings as the plain structs of a drawing (kerf/drawing/dxf.h), and drawings of either kind.
//
// Read are paths, basic shapes, groups, `use`, nested `svg`, transforms, `viewBox`, and styles from
// attributes, `style` and simple rules of a style sheet. Texts and images are counted as other entities.
//
// Frame: y up, from the lower edge of the page if its height is specified, else from y = 0. If the page has a
// size in mm, cm, in, pt, pc or Q, coordinates are mm; else the drawing has no unit, and they are the page's
// pixels (user units).
//
// Layers: the label of the Inkscape layer that an element is part of; outside of layers the colour of its
// stroke, else of its fill ("#ff0000", "red").
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/units.h"
#include "kerf/drawing/dxf.h"

namespace kerf {

struct SvgOptions {
  std::size_t max_depth = 200;            ///< of elements in elements, `use` included
  std::size_t max_elements = 2'000'000;   ///< drawn, those of each `use` included
  std::size_t max_segments = 10'000'000;  ///< of all paths
  Progress* progress = nullptr;           ///< may stop the work: then there is no value, and no error
};

/// Whether the bytes are XML with an svg element near their start.
bool is_svg(std::string_view bytes);

/// Nothing, with an error appended, if the bytes are not well-formed XML or have no svg element. What
/// browsers ignore is a warning with its line: an invalid attribute, a path from its first invalid command
/// on.
std::optional<dxf::Drawing> read_svg(std::string_view bytes, const std::string& file_name,
                                     const SvgOptions& options, Diagnostics& diagnostics);

/// The layer of a colour in any of its forms, "#0000ff" of blue, #00f and rgb(0, 0, 100%); other names stay.
std::string colour_layer(std::string_view name);

/// What becomes of a stroke with a width, of an SVG or of a polyline.
enum class StrokeShapes : std::uint8_t {
  lines,  ///< its centre line
  areas   ///< the edges of the area that it covers, united with the fill of its element
};
/// By its name: lines or areas.
std::optional<StrokeShapes> stroke_shapes_of(std::string_view name);

/// The unit of a drawing by its name: mm, inch (in), px (1/96 inch) or pt (1/72 inch).
std::optional<Length> drawing_unit(std::string_view name);

/// An SVG or DXF drawing, by its content. Damaged entities are left out with warnings.
std::optional<dxf::Drawing> read_drawing(std::string_view bytes, const std::string& file_name,
                                         Diagnostics& diagnostics, Progress* progress = nullptr);

}  // namespace kerf

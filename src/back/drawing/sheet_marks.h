// What sheets for the workshop have in common: dimension lines and the mark of the zero. All sizes are mm on
// paper.
#pragma once

#include <cstddef>
#include <string>

#include "kerf/drawing/drawing_files.h"
#include "kerf/geom/geometry.h"

namespace kerf::drawings {

inline constexpr double kTextHeight = 2.5, kLabelHeight = 1.8;  // mm

void add_line(Drawing& drawing, std::size_t layer, Point2 a, Point2 b);
void add_rectangle(Drawing& drawing, std::size_t layer, const Box2& box);
void add_text(Drawing& drawing, std::size_t layer, Point2 at, double height, const std::string& text);
/// A dimension line between two points, moved by `offset`, with arrows and its value; nothing where they are
/// one point.
void add_dimension(Drawing& drawing, std::size_t layer, Point2 a, Point2 b, Point2 offset,
                   const std::string& value);
/// A cross with "X0 Y0".
void add_zero_mark(Drawing& drawing, std::size_t layer, Point2 at);

}  // namespace kerf::drawings

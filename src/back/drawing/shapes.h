// Common to the drawings of this room.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "kerf/drawing/drawing_files.h"

namespace kerf::drawings {

template <class Shape>
void add(Drawing& drawing, std::size_t layer, Shape shape) {
  DrawingEntity& entity = drawing.entities.emplace_back();
  entity.layer = layer;
  entity.shape.emplace<Shape>(std::move(shape));
}

/// Scales the line widths, given as multiples of the usual width, with the size of the drawing.
inline void set_widths(Drawing& drawing) {
  constexpr double kUsualWidth = 0.002;  // of the larger side
  const auto bounds = drawing_bounds(drawing);
  const double side = std::max(bounds[2] - bounds[0], bounds[3] - bounds[1]);
  for (DrawingLayer& layer : drawing.layers) layer.line_width *= side > 0.0 ? kUsualWidth * side : 1.0;
}

}  // namespace kerf::drawings

// What all drawings are made with.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "kerf/drawing_files.h"

namespace kerf::drawings {

template <class Shape>
void add(Drawing& drawing, std::size_t layer, Shape shape) {
  DrawingEntity& entity = drawing.entities.emplace_back();
  entity.layer = layer;
  entity.shape.emplace<Shape>(std::move(shape));
}

/// Makes line widths, which are told as multiples of the usual one, go with the drawing's size.
inline void set_widths(Drawing& drawing) {
  constexpr double kLineShare = 0.002;  // of the larger side
  const auto bounds = drawing_bounds(drawing);
  const double side = std::max(bounds[2] - bounds[0], bounds[3] - bounds[1]);
  for (DrawingLayer& layer : drawing.layers) layer.line_width *= side > 0.0 ? kLineShare * side : 1.0;
}

}  // namespace kerf::drawings

// Transforms of SVG: the attribute `transform`, and the properties of CSS.
#pragma once

#include <optional>
#include <string_view>

#include "codec/drawing/svg_values.h"

namespace kerf::svg {

/// What lengths and percentages of a transform refer to.
struct TransformFrame {
  LengthBase base;
  Box box;                     // the reference box
  bool takes_numbers = false;  // as lengths, in an attribute
};

/// The attribute: numbers without units, separated by blanks or commas.
std::optional<Affine> read_transform(std::string_view text);
/// The functions of CSS, whose numbers have units. `is_tilted` is set where the result leaves the page's
/// plane; it then is the projection.
std::optional<Affine> read_css_transform(std::string_view text, const TransformFrame& frame, bool& is_tilted);
/// A property `translate`, `rotate` or `scale`.
std::optional<Affine> read_single_transform(std::string_view property, std::string_view text,
                                            const TransformFrame& frame, bool& is_tilted);
/// The property transform-origin, as a point of the coordinates that the box is in.
std::optional<Vec> read_origin(std::string_view text, const TransformFrame& frame);

}  // namespace kerf::svg

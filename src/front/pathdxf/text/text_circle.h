// The circle around a text of a drawing within which it must overlap its element.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kerf/drawing/dxf.h"
#include "kerf/geom/geometry.h"

namespace kerf::pathdxf {

struct TextCircle {
  Point2 centre;
  double radius = 0.0;
};

/// The characters of a text without formatting codes; %%c, %%d and %%p stay.
std::string unformatted(const dxf::Text& text);
/// %%c, %%d, %%p -> _D, _G, _+
std::string without_special_characters(std::string_view text);

/// The circle, from the width that a letter of 0.6 times the height gives. Nothing for a text that is
/// mirrored, or rotated unless it is anchored at its centre.
std::optional<TextCircle> circle_of(const dxf::Text& text);

}  // namespace kerf::pathdxf

// Checks of the arguments of commands: sizes, names of positions and styles, colours.
//
// A wrong argument ends the command, by Refusal of call.h.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/stock/stock.h"

namespace kerf::design {

/// `value`, if it is a coordinate in mm within the limits of a toolpath.
double coordinate(double value, std::string_view name);
/// `value`, if it is above 0 and no larger than a coordinate.
double positive(double value, std::string_view name);
/// `value` from 0.
double not_negative(double value, std::string_view name);
/// `value` as a whole number in [low, high].
int whole(double value, std::string_view name, int low, int high);

/// The index of the name in `known` that `value` means, without regard to case, blanks and hyphens.
std::size_t choice(std::string_view value, const std::vector<std::string>& known, std::string_view name);

/// A colour of drawings.
struct DrawingColour {
  std::string name;           // "Dark Gray"
  int index = 7;              // AutoCAD colour index; 7 is black on white paper
  std::string layer() const;  // "Layer_Dark_Gray"
};
/// A colour of CSS, a name in any case or #rrggbb, with or without blanks; others are refused.
std::array<std::uint8_t, 3> css_colour(std::string_view text, std::string_view name);
/// The colour of a name; colours of CSS mean the nearest one.
DrawingColour drawing_colour(std::string_view name);

/// "Lower-Left" to "Top-Right".
ZeroCorner zero_corner(std::string_view name);
/// "Top" or "Bottom".
ZeroHeight zero_height(std::string_view name);

}  // namespace kerf::design

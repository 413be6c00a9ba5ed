// The cross-section of printed beads, which all that lays or writes them has in common.
//
// A rectangle with half circles at its sides, as in the Slic3r manual ("Flow math"):
//
//   area = (width - height) * height + pi * (height / 2)^2
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kerf/base/units.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// The volume of a bead of this length in plan, width and height; height <= width.
Volume bead_volume(Length length, Length width, Length height);

inline constexpr Length kUsualFilament = mm(1.75);  // diameter

/// The note in a toolpath that states the diameter of its filament, as slicers write it.
std::string filament_note(Length diameter);
/// The diameter of such a note; nothing for other texts.
std::optional<Length> read_filament_note(std::string_view text);
/// The diameter that a toolpath states; 0: none.
Length filament_of_path(const Toolpath& path);

}  // namespace kerf

// Hazards: steps that would break a tool or a part.
#pragma once

#include <cstdint>
#include <string_view>

#include "kerf/geometry.h"
#include "kerf/units.h"

namespace kerf {

enum class HazardKind : std::uint8_t {
  rapid_in_stock,
  neck_contact,
  shank_contact,
  holder_contact,
  over_flute,
  below_floor,
  spindle_off,
};
std::string_view to_string(HazardKind kind);

/// A step that would break a tool or a part. One entry per step and kind.
struct Hazard {
  HazardKind kind{};
  std::uint32_t step = 0;  // index in the toolpath
  Point3 at;               // mm, the first column touched along the motion, at the depth of the contact there
  Length depth;            // largest depth of the contact below the material's surface
  Volume removed;          // material touched
};

}  // namespace kerf

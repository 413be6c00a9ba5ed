// Options of a simulation, the same for three axes, four axes and fixtures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "kerf/base/limits.h"
#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/path/machine.h"

namespace kerf {

// Hazards: steps that would break a tool or a part.

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

/// The role of the solid: stock is cut; a no-go solid (a fixture) must not be touched. It is never cut, and
/// every cut into it is reported as HazardKind::spindle_off, as if the spindle were stopped.
enum class SolidRole : std::uint8_t { stock, no_go };

struct SimulationOptions {
  Length resolution;     // column pitch; 0 chooses one: that of left-over stock, else about 2.5
                         // million columns, from 0.02 to 1 mm, more where a tool cuts narrower than three of
                         // them; for a huge stock more
  unsigned threads = 0;  // 0: as many as the machine has. The result is the same for any number.
  std::size_t max_columns = limits::kMaxColumns;          // more is an error that names a possible resolution
  Length hazard_depth = default_tolerance::kHazardDepth;  // contacts shallower than this are not hazards
  SolidRole role = SolidRole::stock;
  Length spoilboard{};  // thickness of the board below the stock: cuts that end inside of it are not hazards
  std::optional<AxisRates>
      rapid_rates{};  // of rapids whose axes move each at its own rate; else straight ones
  /// Volumes by step are needed as sums by tool only: what a helix removes may be counted with its last
  /// turns, as turns that a later one covers are left out.
  bool volumes_by_tool = false;
};

}  // namespace kerf

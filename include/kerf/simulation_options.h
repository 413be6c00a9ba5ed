// Options of a simulation, the same for three axes, four axes and fixtures.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kerf/limits.h"
#include "kerf/tolerance.h"
#include "kerf/units.h"

namespace kerf {

/// The role of the solid: stock is cut; a no-go solid (fixtures.h) must not be touched. It is never cut, and
/// every cut into it is reported as HazardKind::spindle_off, as if the spindle were stopped.
enum class SolidRole : std::uint8_t { stock, no_go };

struct SimulationOptions {
  Length resolution;     // column pitch; 0 chooses one: that of left-over stock, else about 2.5
                         // million columns, from 0.02 to 1 mm; for a huge stock more
  unsigned threads = 0;  // 0: as many as the machine has. The result is the same for any number.
  std::size_t max_columns = limits::kMaxColumns;          // more is an error that names a possible resolution
  Length hazard_depth = default_tolerance::kHazardDepth;  // contacts shallower than this are not hazards
  SolidRole role = SolidRole::stock;
};

}  // namespace kerf

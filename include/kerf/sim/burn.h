// The burn of a laser on a flat board: the energy per area that its beam leaves, and a picture of it.
//
//   const auto map = map_burn(program.path, {.beam = mm(0.15), .full_power = 10}, diagnostics);
//   if (map) use(map->highest, map->joules);
//
// The power is that of S in proportion to full power, spread evenly over a round beam; the speed is the
// programmed feed. A straight cut of P watts at v mm/s with a beam of d mm therefore leaves 4 P / (pi d v)
// J/mm2 on its centre line and P / v J per mm. Acceleration is ignored: with M4 the controller scales the
// power with the actual speed, which leaves the same energy per mm; with M3 corners get more than the map
// shows. Rapids leave nothing, as in GRBL's laser mode. Defocus, reflection and heat conduction are not
// modelled.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/path/toolpath.h"
#include "kerf/sim/render.h"

namespace kerf {

struct BurnOptions {
  Length beam = mm(0.1);    ///< diameter of the beam on the board
  double full_power = 5.0;  ///< W of light at `full_s`
  double full_s = 1000.0;   ///< S of full power ($30 in GRBL); larger S is full power
  Length cell{};            ///< of the map; 0: a fifth of the beam, larger on large boards
  /// Of the map, and of the finer cells along the path from which the figures come.
  std::size_t max_cells = 16'000'000;
};

/// Energy per area on square cells, rows from low Y.
struct BurnMap {
  Point2 low;         ///< mm, the lower left corner
  double cell = 0.0;  ///< mm
  int nx = 0, ny = 0;
  std::vector<float> joules_per_mm2;  ///< at the centre of each cell, or the mean of a large one
  double joules = 0.0;                ///< of the whole program
  Duration on{};                      ///< time that the beam is on
  double burnt_mm2 = 0.0;             ///< of the finer cells with energy
  double highest = 0.0;               ///< J/mm2
  Point2 highest_at;                  ///< mm
  double usual_highest = 0.0;         ///< J/mm2 that 99% of the burnt area do not exceed

  double at(Point2 p) const;  ///< J/mm2 of the cell that contains p; 0 outside
};

/// The map of a path with laser power. Nothing, with an error, if an option is out of range, the path has no
/// laser power, or its beam is never on; nothing if stopped. Cuts at unknown positions, rotary motions and
/// powers above full power are warnings, and so is a path so long that the cells along it are wider than a
/// third of the beam.
std::optional<BurnMap> map_burn(const Toolpath& path, const BurnOptions& options, Diagnostics& diagnostics,
                                Progress* progress = nullptr);

/// The map seen from above: the board, darker with more energy; black from `black` J/mm2 on (0:
/// usual_highest). The size is clamped to 1 to 8192 pixels.
Image draw_burn(const BurnMap& map, double black, int width, int height);

}  // namespace kerf

// The burn of a laser's program as the bytes that a page draws.
#pragma once

#include <string>

#include "kerf/base/diagnostics.h"
#include "kerf/path/toolpath.h"
#include "kerf/sim/burn.h"

namespace kerf::app::view {

struct BurnSettings {
  BurnOptions laser = {};
  double black = 0.0;  // J/mm2 that has the full colour; 0: BurnMap::usual_highest
};

/// The body of /download/burn: cells small enough for the beam, but not more than a page draws. Empty, with
/// an error, if the path has no beam that is on.
std::string burn_body(const Toolpath& path, const BurnSettings& settings, std::uint32_t revision,
                      Diagnostics& diagnostics);

}  // namespace kerf::app::view

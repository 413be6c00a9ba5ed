// The motions of a toolpath as pages draw them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/shown/path_blocks.h"

#include "kerf/path/machine.h"
#include "kerf/path/toolpath.h"

namespace kerf::app::view {

/// The axes (bits) that must be known for a motion to be drawn: without Z where no motion has a known Z, as
/// in programs of lasers and plotters, which are drawn at Z0.
unsigned drawn_axes(const Toolpath& path);
struct PathInputs {
  const std::vector<std::string>& files;  // that origins refer to by number
  const std::optional<Machine>& machine;  // for the times; nothing: programmed feeds and usual rapids
  const PathBlocks& before;               // unchanged blocks are taken over
  std::uint32_t revision = 0;
};
PathBlocks path_blocks(const Toolpath& path, const PathInputs& inputs);

}  // namespace kerf::app::view

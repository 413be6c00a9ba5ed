// The motions of a toolpath as the bytes of /path.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kerf/path/machine.h"
#include "kerf/path/toolpath.h"

namespace kerf::app::view {

/// The body of /path, and the number of motions in it.
struct PathBody {
  std::string bytes;
  std::size_t motions = 0;
};
/// The axes (bits) that must be known for a motion to be drawn: without Z where no motion has a known Z, as
/// in programs of lasers and plotters, which are drawn at Z0.
unsigned drawn_axes(const Toolpath& path);
/// `files`: the names that origins refer to by number; `machine`: for the times, nothing: programmed feeds
/// and usual rapids, without acceleration.
PathBody path_body(const Toolpath& path, std::uint32_t revision, const std::vector<std::string>& files,
                   const std::optional<Machine>& machine);

}  // namespace kerf::app::view

// Checks a mesh before it is written: closed, oriented outwards, and of the expected volume.
//
// Positions are x y z in mm; triangles are three indices each, counter-clockwise seen from outside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "kerf/base/diagnostics.h"
#include "kerf/base/units.h"

namespace kerf {

/// Volume enclosed by a closed mesh, and the number of edges that are not shared by exactly two triangles in
/// opposite directions (0 for a valid mesh).
struct MeshCheck {
  Volume volume;
  std::size_t bad_edges = 0;
};
/// `threads` 0: as many as the machine has. The result is the same for any number.
MeshCheck check_mesh(std::span<const float> positions, std::span<const std::uint32_t> triangles,
                     unsigned threads = 0);

/// The volume that a mesh should enclose.
struct VolumeRange {
  Volume expected, tolerance;
};
/// False, with the error mesh_unsound, for a mesh with a bad edge or a volume outside the range. A mesh
/// without triangles is valid if the expected volume is 0. A failure is a defect of Kerf, not of the user's
/// input.
bool verify_mesh(std::span<const float> positions, std::span<const std::uint32_t> triangles,
                 const VolumeRange& volume, Diagnostics& diagnostics);

}  // namespace kerf

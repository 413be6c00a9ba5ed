// Is a mesh what it should be: closed, turned outwards, and of the volume that it was made for. Every mesh is
// looked at so before it is written.
//
// Positions are x y z in mm; triangles are three indices each, counter-clockwise seen from outside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "kerf/diagnostics.h"
#include "kerf/units.h"

namespace kerf {

/// Volume enclosed by a closed mesh, and the number of edges that are not shared by exactly two triangles in
/// opposite directions (0 for a sound mesh).
struct MeshCheck {
  Volume volume;
  std::size_t bad_edges = 0;
};
/// `threads` 0: as many as the machine has. The result is the same for any number.
MeshCheck check_mesh(std::span<const float> positions, std::span<const std::uint32_t> triangles,
                     unsigned threads = 0);

/// What a mesh should hold.
struct VolumeRange {
  Volume expected, tolerance;
};
/// False, with the error mesh_unsound, for a mesh with a bad edge or another volume; a mesh without triangles
/// is sound where nothing is expected. To fail here is a fault of the program, not of the user's input.
bool verify_mesh(std::span<const float> positions, std::span<const std::uint32_t> triangles,
                 const VolumeRange& volume, Diagnostics& diagnostics);

}  // namespace kerf

// Triangle meshes as files: STL, 3MF, GLB and OBJ bytes from plain arrays. No policy, no geometry.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kerf {

/// What the writers need, borrowed from the caller. Positions x y z in mm (Z up), three indices a triangle,
/// counter-clockwise seen from outside. `colour_index` is empty or holds one index into `palette` a triangle.
/// The palette's names become those of materials. `step` is empty or holds the toolpath step that made each
/// triangle (kept in GLB as the attribute _STEP).
struct MeshView {
  std::span<const float> positions;
  std::span<const std::uint32_t> triangles;
  std::span<const std::uint8_t> colour_index;
  std::span<const std::array<std::uint8_t, 3>> palette;  // sRGB
  std::span<const std::uint32_t> step;
  std::string name = "part";
  std::span<const std::string> palette_names = {};  // of the palette's first colours; "colour 2" else
};

enum class MeshFormat : std::uint8_t { stl, three_mf, glb, obj };
/// From a file name's ending (.stl .3mf .glb .obj, any case), or nothing.
std::optional<MeshFormat> mesh_format_of(std::string_view path);
/// The file's bytes. STL is binary and without colour; OBJ is without colour. The same mesh gives the same
/// bytes. Steps are kept in GLB as floats (exact up to 16 million), -1 where there is none. Empty where the
/// format cannot hold the mesh (GLB over 4 GiB: about 85 million triangles) and for 3MF in a WebAssembly
/// build.
std::string write_mesh(const MeshView& mesh, MeshFormat format);

}  // namespace kerf

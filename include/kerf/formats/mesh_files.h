// Reads and writes triangle meshes as STL, 3MF, GLB and OBJ bytes, from and to plain arrays.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/limits.h"
#include "kerf/base/progress.h"

namespace kerf {

/// Input of the writers, owned by the caller. Positions x y z in mm (Z up), three indices per triangle,
/// counter-clockwise seen from outside. `colour_index` is empty or has one index into `palette` per triangle.
/// The names of the palette become material names. `step` is empty or has the toolpath step that made each
/// triangle (stored in GLB as the attribute _STEP).
struct MeshView {
  std::span<const float> positions;
  std::span<const std::uint32_t> triangles;
  std::span<const std::uint8_t> colour_index;
  std::span<const std::array<std::uint8_t, 3>> palette;  // sRGB
  std::span<const std::uint32_t> step;
  std::string name = "part";
  std::span<const std::string> palette_names = {};  // of the first colours; default "colour 2"
};

enum class MeshFormat : std::uint8_t { stl, three_mf, glb, obj };
/// From the extension of a file name (.stl .3mf .glb .obj, any case), or nothing.
std::optional<MeshFormat> mesh_format_of(std::string_view path);
/// The file's bytes. STL is binary; STL and OBJ have no colours. The same mesh gives the same bytes. Steps
/// are floats in GLB (exact up to 16 million), -1 for none. Empty if the format cannot hold the mesh (GLB
/// over 4 GiB: about 85 million triangles) and for 3MF in a WebAssembly build.
std::string write_mesh(const MeshView& mesh, MeshFormat format);

/// The mesh of a file: x y z in mm, Z up; three indices per triangle. Vertices may be duplicated (in STL each
/// triangle has its own), and the mesh need not be closed.
struct MeshData {
  std::vector<double> positions;
  std::vector<std::uint32_t> triangles;
};

/// Exceeding one is an error.
struct MeshLimits {
  std::size_t triangles = limits::kMaxTriangles;
  std::size_t text_bytes = limits::kMaxUnpackedBytes;  // of an unpacked 3MF
};

/// Reads a mesh. STL (text and binary) and OBJ have no unit: mm is assumed. 3MF specifies its unit, GLB is in
/// metres with Y up; both are converted, and their objects (3MF's build, GLB's scene) combined. Appends
/// errors with the file's name, and returns nothing, for damaged, too large or non-finite data and for data
/// that is not in the file (external glTF buffers) or compressed. Nothing, without an error, if stopped.
std::optional<MeshData> read_mesh(std::string_view bytes, MeshFormat format, const std::string& name,
                                  Diagnostics& diagnostics, const MeshLimits& limits = {},
                                  Progress* progress = nullptr);

}  // namespace kerf

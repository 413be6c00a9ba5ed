// The writers of write_mesh, one per format, and little-endian output.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "kerf/formats/mesh_files.h"

namespace kerf::mesh_format {

std::string write_stl(const MeshView& mesh);
std::string write_three_mf(const MeshView& mesh);
std::string write_glb(const MeshView& mesh);
std::string write_obj(const MeshView& mesh);

/// Appends a number of 1 to 4 bytes, lowest byte first, whatever the machine's order.
template <class T>
void append_little(std::string& out, T value) {
  std::uint32_t bits = 0;
  static_assert(sizeof(T) <= 4);
  if constexpr (sizeof(T) == 4) {
    std::memcpy(&bits, &value, 4);
  } else {
    bits = value;
  }
  std::array<char, sizeof(T)> bytes{};
  for (std::size_t k = 0; k < sizeof(T); ++k) bytes[k] = static_cast<char>(bits >> (8 * k) & 0xffu);
  out.append(bytes.data(), bytes.size());
}

/// Writes numbers like append_little into an existing buffer.
inline void put_little(std::span<const float> numbers, char* out) {
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(out, numbers.data(), numbers.size_bytes());
  } else {
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      std::string bytes;
      append_little(bytes, numbers[n]);
      std::memcpy(out + sizeof(float) * n, bytes.data(), sizeof(float));
    }
  }
}

inline std::size_t triangle_count(const MeshView& mesh) { return mesh.triangles.size() / 3; }
inline std::size_t vertex_count(const MeshView& mesh) { return mesh.positions.size() / 3; }

/// The triangle's colour as an index into the palette; `palette.size()` for none.
inline std::size_t colour_of(const MeshView& mesh, std::size_t triangle) {
  if (mesh.palette.empty() || triangle >= mesh.colour_index.size()) return mesh.palette.size();
  const std::size_t index = mesh.colour_index[triangle];
  return index < mesh.palette.size() ? index : mesh.palette.size();
}

/// Normal of a triangle of length 1; zero for a degenerate one.
std::array<float, 3> unit_normal(const MeshView& mesh, std::size_t triangle);
/// The printable ASCII characters of a name, for headers.
std::string plain_name(const MeshView& mesh);
/// The name of a colour of the palette, for materials.
std::string colour_name(const MeshView& mesh, std::size_t colour);

}  // namespace kerf::mesh_format

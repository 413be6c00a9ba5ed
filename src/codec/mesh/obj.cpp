// Writes Wavefront OBJ: vertices and faces as text, without colours.
#include <fmt/format.h>
#include <iterator>

#include "codec/mesh/writers.h"

namespace kerf::mesh_format {

std::string write_obj(const MeshView& mesh) {
  std::string out = "# Kerf, units mm, Z up\no " + plain_name(mesh) + "\n";
  out.reserve(out.size() + 30 * vertex_count(mesh) + 24 * triangle_count(mesh));
  for (std::size_t v = 0; v < vertex_count(mesh); ++v) {
    const float* p = mesh.positions.data() + 3 * v;
    fmt::format_to(std::back_inserter(out), "v {} {} {}\n", p[0], p[1], p[2]);
  }
  for (std::size_t t = 0; t < triangle_count(mesh); ++t) {
    const std::uint32_t* i = mesh.triangles.data() + 3 * t;
    fmt::format_to(std::back_inserter(out), "f {} {} {}\n", i[0] + std::uint64_t{1}, i[1] + std::uint64_t{1},
                   i[2] + std::uint64_t{1});
  }
  return out;
}

}  // namespace kerf::mesh_format

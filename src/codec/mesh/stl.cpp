// Writes binary STL: 80 bytes of header, the count, then 50 bytes per triangle.
#include "codec/mesh/writers.h"

namespace kerf::mesh_format {

std::string write_stl(const MeshView& mesh) {
  const std::size_t triangles = triangle_count(mesh);
  std::string out;
  out.reserve(84 + 50 * triangles);
  // Must not start with "solid", which marks the text form.
  out = "Kerf binary STL, units mm: " + plain_name(mesh);
  out.resize(80, '\0');
  append_little(out, static_cast<std::uint32_t>(triangles));
  for (std::size_t t = 0; t < triangles; ++t) {
    for (const float n : unit_normal(mesh, t)) append_little(out, n);
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis)
        append_little(out, mesh.positions[std::size_t{3} * mesh.triangles[3 * t + k] + axis]);
    append_little(out, std::uint16_t{0});
  }
  return out;
}

}  // namespace kerf::mesh_format

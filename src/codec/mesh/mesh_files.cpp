// Selects the format and its writer; functions that several writers use.
#include "kerf/formats/mesh_files.h"

#include <cassert>
#include <cmath>

#include "codec/mesh/writers.h"

namespace kerf {
namespace mesh_format {

std::array<float, 3> unit_normal(const MeshView& mesh, std::size_t triangle) {
  std::array<std::array<double, 3>, 3> p{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[k][axis] = mesh.positions[std::size_t{3} * mesh.triangles[3 * triangle + k] + axis];
  std::array<double, 3> n{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    n[axis] = (p[1][u] - p[0][u]) * (p[2][v] - p[0][v]) - (p[1][v] - p[0][v]) * (p[2][u] - p[0][u]);
  }
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (!(length > 0.0)) return {};
  return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length),
          static_cast<float>(n[2] / length)};
}

std::string plain_name(const MeshView& mesh) {
  std::string name;
  for (const char c : mesh.name)
    if (c >= ' ' && c <= '~') name += c;
  return name;
}

std::string colour_name(const MeshView& mesh, std::size_t colour) {
  if (colour < mesh.palette_names.size()) return mesh.palette_names[colour];
  return "colour " + std::to_string(colour);
}

}  // namespace mesh_format

std::optional<MeshFormat> mesh_format_of(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  std::string ending;
  for (const char c : path.substr(dot + 1)) ending += c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  if (ending == "stl") return MeshFormat::stl;
  if (ending == "3mf") return MeshFormat::three_mf;
  if (ending == "glb") return MeshFormat::glb;
  if (ending == "obj") return MeshFormat::obj;
  return std::nullopt;
}

std::string write_mesh(const MeshView& mesh, MeshFormat format) {
  const std::size_t vertices = mesh_format::vertex_count(mesh);
  for (const std::uint32_t v : mesh.triangles) assert(v < vertices);
  switch (format) {
    case MeshFormat::stl: return mesh_format::write_stl(mesh);
    case MeshFormat::glb: return mesh_format::write_glb(mesh);
    case MeshFormat::obj: return mesh_format::write_obj(mesh);
    case MeshFormat::three_mf: break;
  }
#if KERF_WITH_3MF
  return mesh_format::write_three_mf(mesh);
#else
  return {};
#endif
}

}  // namespace kerf

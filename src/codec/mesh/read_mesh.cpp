// Selects the reader of a format, and checks the limits of all readers.
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "base/codes/stock.h"
#include "codec/mesh/readers.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace mesh_format {
namespace {

/// Maximum: each triangle has its own vertices. A closed mesh with common vertices has half as many as
/// triangles.
constexpr std::size_t kVerticesPerTriangle = 3;

}  // namespace

bool MeshMaker::fail(const std::string& message, std::uint32_t line) {
  if (!failed_) diagnostics_.error(codes::mesh_file, TextLocation{name_, line, 0}, message);
  failed_ = true;
  return false;
}

bool MeshMaker::too_large(const std::string& what) {
  if (!failed_) diagnostics_.error(codes::mesh_too_large, TextLocation{name_, 0, 0}, what);
  failed_ = true;
  return false;
}

bool MeshMaker::add_vertex(double x, double y, double z, std::uint32_t line) {
  // In this form NaN fails too.
  const bool good = std::abs(x) <= limits::kMaxCoordinate && std::abs(y) <= limits::kMaxCoordinate &&
                    std::abs(z) <= limits::kMaxCoordinate;
  if (!good) return fail("a vertex is not finite or more than 10 km from the origin", line);
  if (vertices() >= kVerticesPerTriangle * limits_.triangles)
    return too_large(
        fmt::format("the mesh has more than {} vertices", kVerticesPerTriangle * limits_.triangles));
  mesh_.positions.insert(mesh_.positions.end(), {x, y, z});
  return true;
}

bool MeshMaker::add_triangle(std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint32_t line) {
  const std::uint64_t count = vertices();
  if (a >= count || b >= count || c >= count)
    return fail(fmt::format("a triangle uses a vertex that does not exist; there are {}", count), line);
  if (mesh_.triangles.size() / 3 >= limits_.triangles)
    return too_large(fmt::format("the mesh has more than {} triangles", limits_.triangles));
  for (const std::uint64_t v : {a, b, c}) mesh_.triangles.push_back(static_cast<std::uint32_t>(v));
  return true;
}

std::optional<MeshData> MeshMaker::finish() {
  if (!failed_ && mesh_.triangles.empty()) {
    diagnostics_.error(codes::mesh_no_volume, TextLocation{name_, 0, 0}, "the file contains no triangles");
    failed_ = true;
  }
  if (failed_) return std::nullopt;
  return std::move(mesh_);
}

Affine Affine::after(const Affine& inner) const {
  Affine out;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      out.m[row][column] = column == 3 ? m[row][3] : 0.0;
      for (int k = 0; k < 3; ++k) out.m[row][column] += m[row][k] * inner.m[k][column];
    }
  }
  return out;
}

void Affine::apply(double& x, double& y, double& z) const {
  const double p[3] = {x, y, z};
  double* const out[3] = {&x, &y, &z};
  for (int row = 0; row < 3; ++row)
    *out[row] = m[row][0] * p[0] + m[row][1] * p[1] + m[row][2] * p[2] + m[row][3];
}

bool Affine::mirrors() const {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) <
         0.0;
}

}  // namespace mesh_format

std::optional<MeshData> read_mesh(std::string_view bytes, MeshFormat format, const std::string& name,
                                  Diagnostics& diagnostics, const MeshLimits& limits, Progress* progress) {
  mesh_format::MeshMaker maker(name, limits, diagnostics, progress);
  switch (format) {
    case MeshFormat::stl: mesh_format::read_stl(bytes, maker); break;
    case MeshFormat::obj: mesh_format::read_obj(bytes, maker); break;
    case MeshFormat::glb: mesh_format::read_glb(bytes, maker); break;
    case MeshFormat::three_mf:
#if KERF_WITH_3MF
      mesh_format::read_three_mf(bytes, maker);
#else
      maker.fail("this build of Kerf cannot read 3MF");
#endif
      break;
  }
  return maker.finish();
}

}  // namespace kerf

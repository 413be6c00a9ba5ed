// Fuzz target: mesh files, and what becomes of them as stock. The first byte picks the format.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kerf/mesh_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  kerf::Diagnostics diagnostics;
  const kerf::MeshLimits limits{.triangles = 20'000, .text_bytes = std::size_t{1} << 22};
  const auto mesh =
      kerf::read_mesh(bytes, static_cast<kerf::MeshFormat>(data[0] % 4), "fuzz", diagnostics, limits);
  if (mesh.has_value() == diagnostics.has_errors()) std::abort();
  if (!mesh) return 0;
  for (const std::uint32_t v : mesh->triangles)
    if (v >= mesh->positions.size() / 3) std::abort();
  return 0;
}

// Fuzz target: mesh files and left-over stock, and their columns. The first byte selects the
// format.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "codec/mesh/column_files.h"

#include "kerf/formats/mesh_files.h"
#include "kerf/stock/stock.h"

namespace {

/// Runs of every column must be ordered and separate.
void check(const kerf::ColumnRuns& columns) {
  for (int j = 0; j < columns.ny; ++j) {
    for (int i = 0; i < columns.nx; ++i) {
      float above = -1e30f;
      for (const kerf::Run& run : columns.column(i, j)) {
        if (!(run.low > above) || !(run.high > run.low)) std::abort();
        above = run.high;
      }
    }
  }
}

void use(const kerf::MeshData& mesh) {
  for (const std::uint32_t v : mesh.triangles)
    if (v >= mesh.positions.size() / 3) std::abort();
  kerf::Diagnostics diagnostics;
  const auto body = kerf::make_mesh_body(mesh.positions, mesh.triangles, "fuzz", diagnostics);
  if (!body) return;
  const kerf::Box3& box = body->bounds();
  constexpr int kLines = 12;
  const double pitch = std::max(box.size().x, box.size().y) / kLines;
  if (!(pitch > 0.0)) return;
  const auto columns = body->columns({box.low.x, box.low.y, box.low.z, pitch, kLines, kLines}, diagnostics);
  if (columns) check(*columns);
}

void read_left(std::string_view bytes) {
  kerf::Diagnostics diagnostics;
  const auto left = kerf::read_columns(bytes, "fuzz", diagnostics, {.columns = 10'000, .runs = 20'000});
  if (left.has_value() == diagnostics.has_errors()) std::abort();
  if (!left) return;
  const auto again = kerf::read_columns(kerf::write_columns(*left), "fuzz", diagnostics);
  if (!again || again->runs != left->runs || again->first != left->first) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] == 'k') {
    read_left(bytes);
    return 0;
  }
  kerf::Diagnostics diagnostics;
  const kerf::MeshLimits limits{.triangles = 20'000, .text_bytes = std::size_t{1} << 22};
  const auto mesh =
      kerf::read_mesh(bytes, static_cast<kerf::MeshFormat>(data[0] % 4), "fuzz", diagnostics, limits);
  if (mesh.has_value() == diagnostics.has_errors()) std::abort();
  if (mesh) use(*mesh);
  return 0;
}

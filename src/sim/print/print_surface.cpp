// The surface of a print from its columns.
#include "kerf/sim/print.h"

namespace kerf {

ColumnGrid without_grooves(const ColumnGrid& columns, Length height) {
  ColumnGrid out{columns.bounds, columns.pitch, columns.nx, columns.ny, {}, {}, {}};
  out.first.reserve(columns.first.size());
  for (std::size_t c = 0; c + 1 < columns.first.size(); ++c) {
    out.first.push_back(static_cast<std::uint32_t>(out.intervals.size()));
    for (std::uint32_t k = columns.first[c]; k < columns.first[c + 1]; ++k) {
      const Interval& run = columns.intervals[k];
      const bool joins =
          k > columns.first[c] && static_cast<double>(run.low - out.intervals.back().high) <= height.mm();
      if (!joins) {
        out.intervals.push_back(run);
        continue;
      }
      out.intervals.back().high = run.high;
      out.intervals.back().high_step = run.high_step;
    }
  }
  if (!columns.first.empty()) out.first.push_back(static_cast<std::uint32_t>(out.intervals.size()));
  return out;
}

Mesh extract_print_mesh(const ColumnGrid& columns, const MeshOptions& options, Progress* progress) {
  Mesh mesh = extract_mesh(columns, options, progress);
  // A wall beside an empty column has no step, as nothing was cut there. It gets that of the adjacent caps.
  std::vector<std::uint32_t> of_vertex(mesh.positions.size() / 3, kStockSurface);
  for (std::size_t t = 0; t < mesh.step.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (mesh.step[t] != kStockSurface) of_vertex[mesh.triangles[3 * t + k]] = mesh.step[t];
  for (std::size_t t = 0; t < mesh.step.size(); ++t)
    for (std::size_t k = 0; k < 3 && mesh.step[t] == kStockSurface; ++k)
      mesh.step[t] = of_vertex[mesh.triangles[3 * t + k]];
  return mesh;
}

}  // namespace kerf

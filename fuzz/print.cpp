// Any bytes as a printing program: it is simulated and, if small, meshed. No crash, no hang, consistent
// figures, a valid mesh.
#include "kerf/sim/print.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kerf/program/gcode.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check_volumes(const kerf::PrintVolumes& v) {
  for (const kerf::Volume volume : {v.extruded, v.laid, v.overlap, v.ends, v.blobs, v.hollow, v.enclosed})
    require(std::isfinite(volume.mm3()));
  const double sum = (v.laid - v.ends + v.overlap + v.blobs).mm3();
  require(std::abs(sum - v.extruded.mm3()) <= 1e-6 * std::max(1.0, v.extruded.mm3() + v.laid.mm3()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  kerf::GcodeReadOptions reading;
  reading.max_steps = 300;
  reading.max_line_bytes = 2000;
  kerf::Diagnostics diagnostics(5);
  const kerf::GcodeProgram program = kerf::read_gcode(text, reading, diagnostics);
  kerf::PrintOptions options;
  options.max_columns = 40'000;
  options.max_intervals = 400'000;
  options.threads = 1;
  if (size % 2 != 0) options.resolution = kerf::mm(0.3);
  const auto print = kerf::simulate_print(program.path, options, diagnostics);
  require(print.has_value() || diagnostics.has_errors());
  for (const kerf::Diagnostic& diagnostic : diagnostics.list()) require(!to_string(diagnostic).empty());
  if (!print) return 0;
  check_volumes(print->total);
  for (const kerf::PrintHazard& hazard : print->hazards) require(hazard.step < program.path.size());
  const kerf::MeshOptions meshing{.tolerance = {}, .step_groups = {}, .threads = 1};
  const kerf::Mesh mesh = kerf::extract_print_mesh(print->columns, meshing);
  kerf::Diagnostics faults;
  require(kerf::verify_mesh(mesh, kerf::mesh_volume(print->columns, meshing), faults));
  return 0;
}

// Any bytes as a G-code program: no crash, no hang, every step finite, every origin and message printable.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kerf/path/report.h"
#include "kerf/program/gcode.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// Reads every field of a step and its origin.
void touch(const kerf::Toolpath& path) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    const kerf::Step& s = path[i];
    require(!to_string(path.origin_of(i)).empty());
    if (s.kind() == kerf::StepKind::note || s.kind() == kerf::StepKind::verbatim)
      require(path.text(i).size() < 2000);
    if (s.kind() == kerf::StepKind::dwell) require(s.dwell().time.seconds() >= 0.0);
    if (s.is_motion())
      require(std::isfinite(s.feed().mm_per_min()) && finite(s.to()) && s.unknown_axes() < 8);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  kerf::GcodeReadOptions options;
  options.max_steps = 5000;
  options.max_line_bytes = 2000;
  options.strict = size % 2 != 0;
  options.after_end = size % 3 == 0 ? kerf::AfterEnd::read_on : kerf::AfterEnd::stop;
  kerf::Diagnostics diagnostics(5);
  const kerf::GcodeProgram program = kerf::read_gcode(text, options, diagnostics);
  require(program.path.size() <= options.max_steps);
  touch(program.path);
  const kerf::PathReport report = kerf::report_on(program.path, {});
  require(std::isfinite(report.all.cut_mm) && std::isfinite(report.all.rapid_mm));
  for (const kerf::Diagnostic& diagnostic : diagnostics.list()) require(!to_string(diagnostic).empty());
  return 0;
}

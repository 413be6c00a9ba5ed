// Any bytes as a G-code program, written by a post and drawn: no crash, no unbounded output, and output
// without errors passes the linter.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "kerf/drawing/toolpath_drawing.h"
#include "kerf/program/gcode.h"
#include "kerf/program/post.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::vector<kerf::PostProfile>& posts = kerf::built_in_posts();
  const kerf::PostProfile& profile = posts[data[0] % posts.size()];
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  kerf::GcodeReadOptions read;
  read.max_steps = 500;
  read.max_line_bytes = 1000;
  kerf::Diagnostics diagnostics(5);
  const kerf::GcodeProgram program = kerf::read_gcode(text, read, diagnostics);
  const kerf::Drawing drawing = kerf::toolpath_drawing(program.path, {});
  (void)kerf::write_dxf(drawing, size % 2 == 0 ? kerf::DxfVersion::r2000 : kerf::DxfVersion::r12);
  (void)kerf::write_svg(drawing);
  kerf::PostOptions options;
  options.program_name = text.substr(0, 40);
  if (size % 2 != 0) options.unit = kerf::LengthUnit::inch;
  for (const kerf::PostedFile& file : kerf::post(program.path, profile, options, diagnostics)) {
    kerf::Diagnostics found(5);
    if (diagnostics.has_errors() || kerf::lint_gcode(file.text, profile, "written", found)) continue;
    for (const kerf::Diagnostic& d : found.list()) std::fprintf(stderr, "%s\n", to_string(d).c_str());
    std::abort();
  }
  return 0;
}

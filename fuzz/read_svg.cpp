// Any bytes as an SVG drawing: read with and without a unit of its own, and its outlines, which are finite.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kerf/drawing/drawing_outlines.h"
#include "kerf/drawing/svg.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kerf;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const bool has_unit : {false, true}) {
    Diagnostics diagnostics;
    const auto drawing = read_svg(text, "fuzz.svg", {}, diagnostics);
    if (!drawing && !diagnostics.has_errors()) std::abort();
    if (!drawing) continue;
    DrawingOutlineOptions options;
    if (has_unit) options.unit = mm(0.5);
    options.within = mm(0.1);
    options.max_segments = 20'000;
    const auto drawn = drawn_outlines(*drawing, options, diagnostics);
    if (!drawn && !diagnostics.has_errors()) std::abort();
    for (std::size_t i = 0; drawn && i < drawn->outlines.size(); ++i) {
      const Outline& outline = drawn->outlines[i].outline;
      if (outline.segments.empty() || !std::isfinite(length(outline).mm())) std::abort();
    }
  }
  return 0;
}

// Any bytes as an outline file: read, cut with both ways of dividing short edges, drawn and extruded.
#include <cstdint>
#include <string_view>

#include "back/drawing/outline_drawing.h"
#include "geom/solid/extrude.h"

#include "kerf/drawing/outline_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kerf;
  Diagnostics diagnostics;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Figure figure;
  for (const NamedOutline& named : read_outline_file(text, "fuzz.json", diagnostics)) {
    for (const EdgeSharing sharing : {EdgeSharing::in_order, EdgeSharing::even}) {
      CornerOptions options;
      options.sharing = sharing;
      const auto cut = cut_corners(named.outline, named.corners, options, diagnostics);
      if (!cut) continue;
      write_svg(corner_picture({{named.outline, *cut}}, named.name));
      if (sharing == EdgeSharing::in_order) figure.emplace_back(cut->outline);
    }
  }
  extrude(figure, mm(5), {.chord = mm(0.1), .weld = mm(1e-6)}, diagnostics);
  return 0;
}

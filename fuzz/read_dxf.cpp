// Any bytes as a DXF file: read, blocks inserted, texts without codes, outlines and their region.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kerf/drawing/drawing_outlines.h"
#include "kerf/drawing/dxf.h"

namespace {

void expect(bool holds) {
  if (!holds) std::abort();
}

/// Outlines are joined end to end, and finite.
void check_outlines(const kerf::dxf::Drawing& drawing, const kerf::dxf::VisitOptions& visit,
                    kerf::Diagnostics& diagnostics) {
  using namespace kerf;
  DrawingOutlineOptions options;
  options.unit = mm(1.0);
  options.within = mm(0.1);
  options.max_segments = 20'000;
  options.visit = visit;
  const auto drawn = drawn_outlines(drawing, options, diagnostics);
  if (!drawn) return expect(diagnostics.has_errors());
  std::size_t segments = 0;
  for (const DrawnOutline& o : drawn->outlines) {
    expect(!o.outline.segments.empty() && !o.handles.empty());
    expect(std::isfinite(length(o.outline).mm()));
    segments += o.outline.segments.size();
  }
  if (segments <= 300) drawn_region(*drawn, Combining::drawn, {}, diagnostics);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kerf;
  Diagnostics diagnostics;
  const auto drawing = dxf::read_dxf({reinterpret_cast<const char*>(data), size}, "fuzz.dxf", diagnostics);
  if (!drawing) {
    expect(diagnostics.has_errors());
    return 0;
  }
  dxf::VisitOptions options;
  options.max_entities = 5000;
  dxf::for_each_placed(*drawing, options, diagnostics, [&](const dxf::Placed& placed) {
    expect(placed.style.layer < drawing->layers.size());
    expect(placed.style.linetype < drawing->linetypes.size() && placed.style.linetype >= dxf::kContinuous);
    expect(placed.inserts.size() <= options.max_depth);
    expect(!dxf::type_name(*drawing, placed.entity).empty() ||
           std::holds_alternative<dxf::Other>(placed.entity.shape));
    const dxf::Matrix axes = dxf::object_axes(drawing->extrusions[placed.entity.extrusion]);
    expect(std::abs(axes.m[0][0]) <= 1.0 + 1e-9);
    if (const auto* text = std::get_if<dxf::Boxed<dxf::Text>>(&placed.entity.shape)) {
      dxf::plain(**text);
      dxf::anchor(**text);
    }
  });
  check_outlines(*drawing, options, diagnostics);
  layer_contents(*drawing, options, diagnostics);
  return 0;
}

// Any bytes as a DXF file: read, its blocks placed, its texts without codes.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kerf/dxf.h"

namespace {

void expect(bool holds) {
  if (!holds) std::abort();
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
  return 0;
}

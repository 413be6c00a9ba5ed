// Fuzz target: tool files, tool options, tool comments, stock comments, tool numbers. The first byte selects
// the kind.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kerf/formats/workshop_files.h"
#include "kerf/stock/stock.h"

namespace {

/// An accepted tool must be a solid that answers queries without failure.
void use(const kerf::Tool& tool) {
  const double top = tool.silhouette.cutting.top();
  if (!(top > 0.0) || !(tool.diameter.mm() > 0.0)) std::abort();
  for (const double fraction : {0.0, 0.3, 1.0}) {
    const double radius = tool.silhouette.cutting.radius_at(fraction * top);
    if (!(radius >= 0.0) || !(radius <= tool.silhouette.cutting.max_radius() * (1.0 + 1e-6) + 1e-9))
      std::abort();
  }
  (void)kerf::encode_tool_number(tool);
  (void)kerf::write_tool_comment(tool.shape);
}

void read_comment(std::string_view text) {
  kerf::Diagnostics diagnostics;
  for (const double scale : {1.0, 25.4}) {
    const auto shape = kerf::read_tool_comment(text, scale, {}, diagnostics);
    const auto tool = shape ? kerf::make_tool(1, *shape, {}, {}, diagnostics) : std::nullopt;
    if (!tool) continue;
    use(*tool);
    (void)kerf::choose_tool(kerf::built_in_tools().find(102), &*tool, {}, diagnostics);
  }
}

void read_stock(std::string_view text) {
  kerf::Diagnostics diagnostics;
  kerf::StockComments comments;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = text.find('\n', start);
    (void)comments.read(text.substr(start, end - start), 1.0, {}, diagnostics);
    if (end == std::string_view::npos) break;
    start = end + 1;
  }
  const auto stock = comments.stock();
  if (!stock) return;
  if (!kerf::is_solid(*stock)) std::abort();
  (void)kerf::write_stock_comments(*stock);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  kerf::Diagnostics diagnostics;
  switch (data[0]) {
    case 'o':
      if (const auto tool = kerf::read_tool_option(text, {}, diagnostics)) use(*tool);
      break;
    case 'c': read_comment(text); break;
    case 's': read_stock(text); break;
    default: {
      kerf::ToolTable table;
      kerf::read_tool_file(text, "fuzz.toml", table, diagnostics);
      for (const auto& [number, tool] : table.tools()) use(tool);
    }
  }
  return 0;
}

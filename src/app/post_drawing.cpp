// Drawings of toolpaths for `kerf post`.
#include "app/post_drawing.h"

#include "app/job.h"

#include "kerf/names.h"
#include "kerf/tool_files.h"

namespace kerf::app {

const std::vector<DrawingFormat>& drawing_formats() {
  static const std::vector<DrawingFormat> all{{"dxf", "DXF drawing from above", ".dxf"},
                                              {"svg", "SVG drawing from above", ".svg"}};
  return all;
}

const DrawingFormat* find_drawing_format(std::string_view name) {
  const std::string folded = fold_name(name);
  for (const DrawingFormat& format : drawing_formats())
    if (format.name == folded) return &format;
  return nullptr;
}

std::optional<DxfVersion> read_dxf_version(std::string_view name) {
  const std::string folded = fold_name(name);
  if (folded == "r2000") return DxfVersion::r2000;
  if (folded == "r12") return DxfVersion::r12;
  return std::nullopt;
}

std::string draw_program(const LoadedProgram& program, const DrawingFormat& format,
                         const DrawingRequest& request) {
  ToolpathDrawingOptions options;
  options.unit = request.unit;
  options.rapids = request.rapids;
  options.title = request.title;
  for (const auto& [number, tool] : request.tools) {
    options.tool_names[number] = short_name(tool);
    options.tool_diameters[number] = tool.diameter;
  }
  const Drawing drawing = toolpath_drawing(program.path, options);
  return format.name == "svg" ? write_svg(drawing) : write_dxf(drawing, request.version);
}

}  // namespace kerf::app

// What `kerf post --to` writes besides G-code: drawings of the toolpath from above.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/program.h"
#include "kerf/tool.h"
#include "kerf/toolpath_drawing.h"

namespace kerf::app {

struct DrawingFormat {
  std::string_view name, title, file_ending;
};
const std::vector<DrawingFormat>& drawing_formats();
const DrawingFormat* find_drawing_format(std::string_view name);

/// `--dxf-version`: "r2000" or "r12"; nothing for another text.
std::optional<DxfVersion> read_dxf_version(std::string_view name);

struct DrawingRequest {
  DrawingUnit unit = DrawingUnit::mm;
  RapidLines rapids = RapidLines::left_out;
  DxfVersion version = DxfVersion::r2000;
  std::string title;
  std::map<int, Tool> tools;  // by number; their sizes are those of drilled holes
};
/// The file's text.
std::string draw_program(const LoadedProgram& program, const DrawingFormat& format,
                         const DrawingRequest& request);

}  // namespace kerf::app

// Toolpaths as flat drawings, seen from above, for DXF and SVG files.
//
//   write_dxf(toolpath_drawing(path, {}));
//
// Repeated passes are drawn once, as LINE, ARC, CIRCLE or a polyline with bulges; a plunge alone is a circle
// of the tool's diameter. Layers are those of the toolpath, else one for each tool.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/drawing/drawing_files.h"
#include "kerf/path/toolpath.h"

namespace kerf {

enum class RapidLines : std::uint8_t { left_out, drawn };

struct ToolpathDrawingOptions {
  DrawingUnit unit = DrawingUnit::mm;               // of the coordinates
  RapidLines rapids = RapidLines::left_out;         // drawn: dashed, on a layer of their own
  Length chord = default_tolerance::kDrawingChord;  // of chords from arcs that do not lie in XY
  std::string title = {};                           // of the SVG
  std::map<int, std::string> tool_names = {};       // for the layers' names
  std::map<int, Length> tool_diameters = {};        // for drilled holes; 1 mm for other tools
};

/// Motions with unknown positions in X or Y are skipped.
Drawing toolpath_drawing(const Toolpath& path, const ToolpathDrawingOptions& options);

}  // namespace kerf

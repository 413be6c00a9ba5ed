// Toolpaths as flat drawings, seen from above, for DXF and SVG files.
//
//   write_dxf(toolpath_drawing(path, {}));
//
// Chains of cuts are drawn once, however many passes follow them, as LINE, ARC, CIRCLE or a polyline with
// bulges; a cut that only goes down is a circle of its tool's diameter. Layers are those that the toolpath
// names, else one for each tool.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "kerf/drawing_files.h"
#include "kerf/tolerance.h"
#include "kerf/toolpath.h"
#include "kerf/units.h"

namespace kerf {

enum class RapidLines : std::uint8_t { left_out, drawn };

struct ToolpathDrawingOptions {
  DrawingUnit unit = DrawingUnit::mm;               // the coordinates are told in it
  RapidLines rapids = RapidLines::left_out;         // drawn: dashed, on a layer of their own
  Length chord = default_tolerance::kDrawingChord;  // of chords from arcs that do not lie in XY
  std::string title = {};                           // of the SVG
  std::map<int, std::string> tool_names = {};       // for the layers' names
  std::map<int, Length> tool_diameters = {};        // for drilled holes; 1 mm where a tool has none
};

/// Moves whose place in X and Y is not known in work coordinates are left out.
Drawing toolpath_drawing(const Toolpath& path, const ToolpathDrawingOptions& options);

}  // namespace kerf

// Toolpaths as the drawings that gcmc writes: SVG for Inkscape and DXF (AC1015), in the forms of the real
// program.
#pragma once

#include <string>
#include <vector>

#include "kerf/path/toolpath.h"

namespace kerf {

struct GcmcDrawingOptions {
  bool imperial = false;            // unit of the drawing: inch, else mm
  std::vector<std::string> layers;  // from the bottom; other layers of the path follow
  double tool_width = 0.0;          // stroke width of cuts, in the drawing's unit; 0: 3 mm or 0.125 inch
  double opacity = 0.1;             // of that stroke
  bool flip = true;                 // SVG: Y upwards, as on the machine
  bool show_moves = true;           // SVG: rapids on a layer of their own
  bool show_grid = true;            // SVG: Inkscape's grid
  bool hex_handles = false;         // DXF: valid entity handles instead of the real program's "path1"
};

/// The text of the drawing. Arcs outside of the XY plane become chords; probing motions and beads are
/// straight lines.
std::string gcmc_svg(const Toolpath& path, const GcmcDrawingOptions& options);
std::string gcmc_dxf(const Toolpath& path, const GcmcDrawingOptions& options);

}  // namespace kerf

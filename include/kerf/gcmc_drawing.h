// Toolpaths as the drawings that gcmc writes: SVG for Inkscape and DXF (AC1015), in the forms of the real
// program.
#pragma once

#include <string>
#include <vector>

#include "kerf/toolpath.h"

namespace kerf {

struct GcmcDrawingOptions {
  bool imperial = false;  // the drawing is in inch, else in mm
  std::vector<std::string>
      layers;               // in the order they lie; layers of the path that are missing here come after them
  double tool_width = 0.0;  // stroke of what is cut, in the drawing's unit; 0: 3 mm or 0.125 inch
  double opacity = 0.1;     // of that stroke
  bool flip = true;         // SVG: Y up, as on the machine
  bool show_moves = true;   // SVG: rapids on a layer of their own
  bool show_grid = true;    // SVG: Inkscape's grid
  bool hex_handles = false;  // DXF: entity handles as the format wants them, not "path1" as the real program
};

/// The drawing's text. Arcs outside of the XY plane become chords; probes and beads are drawn as straight
/// moves.
std::string gcmc_svg(const Toolpath& path, const GcmcDrawingOptions& options);
std::string gcmc_dxf(const Toolpath& path, const GcmcDrawingOptions& options);

}  // namespace kerf

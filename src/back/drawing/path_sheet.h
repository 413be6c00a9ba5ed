// A sheet for the workshop: a path drawing with its cuts in order, depths, probes, dimensions and faulty
// elements, as a drawing of true size (write_svg of kerf/drawing/drawing_files.h).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/units.h"
#include "kerf/drawing/drawing_files.h"
#include "kerf/geom/geometry.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// All points are coordinates of the path drawing.
struct PathSheet {
  struct Mark {
    Point2 at;
    std::string text;
  };
  std::string title;               // of the sheet and of the SVG
  std::vector<std::string> lines;  // below it: material, tool, heights
  const Toolpath* path = nullptr;  // may be null: nothing was compiled
  Point2 start;                    // of the path: X0 Y0 of the toolpath
  Length tool_diameter;
  std::vector<Mark> probes;  // in the order of measuring
  std::vector<Mark> faults;  // elements with errors, circled; their texts are listed
};

/// Layers, from below: "room" (the width that the tool cuts, to be free of clamps), "drawn" (empty, for the
/// elements as drawn), "cuts", "rapids", "order" (numbers and depths of elements in the order of milling),
/// "probes", "dimensions", "faults", "text".
Drawing path_sheet(const PathSheet& sheet);
/// The index of one of these layers.
std::size_t sheet_layer(std::string_view name);

}  // namespace kerf

// kerf outline for DXF drawings: outlines, and the region that they bound, from layers.
#pragma once

#include <string>
#include <vector>

#include "app/options/parser.h"
#include "app/report/console.h"
#include "app/report/status.h"

#include "kerf/drawing/drawing_outlines.h"
#include "kerf/geom/region.h"

namespace kerf::app {

struct DrawingOptions {
  std::vector<std::string> layers;
  double mm_per_unit = 0.0;  // 0: as the drawing specifies
  double within = 0.01, join = 0.01;
  Combining combining = Combining::drawn;
  StrokeShapes strokes = StrokeShapes::lines;
  std::string texts = "drawn";
  bool region = false, list_layers = false, without_clips = false;
};

/// Adds the options that concern drawings only.
void add_drawing_options(CommandParser& parser, DrawingOptions& options);
/// The names of those that are given; after CommandLine::parse.
std::vector<std::string> given_drawing_options(const CommandParser& parser);
bool is_drawing(const std::string& file);

Status run_drawing(Console& console, const std::string& file, const std::string& svg, const std::string& dxf,
                   const DrawingOptions& options);

}  // namespace kerf::app

// The plan view of a job's setup: stock, fixtures, cuts by tool, operations and zero, for a setup sheet.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kerf/base/units.h"
#include "kerf/drawing/drawing_files.h"
#include "kerf/geom/geometry.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// All points are mm in work coordinates.
struct SetupPlan {
  struct Mark {
    Point2 at;
    std::string text;
  };
  const Toolpath* path = nullptr;
  std::map<int, Length> tool_diameters;
  Box2 stock;                    // empty: there is none
  Box2 cuts;                     // what the tools move over while cutting; may be empty
  std::vector<Mark> operations;  // where each starts, with its number
  std::vector<std::pair<std::string, Box2>> fixtures;
  double unit = 1.0;                     // mm, of the dimensions' values
  double width = 170.0, height = 110.0;  // mm on paper that the drawing fits in, without its dimensions
};

/// The drawing in mm on paper. Layers: "stock", "fixtures", "dimensions", "zero", "operations", then those of
/// toolpath_drawing(), which differ in shade and dashes so that they do without colours.
Drawing setup_plan(const SetupPlan& plan);
/// The index of the layer in which a tool cuts; nothing if it does not.
std::optional<std::size_t> layer_of_tool(const Drawing& plan, int tool);

}  // namespace kerf

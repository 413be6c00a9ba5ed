// A tool as a drawing of its silhouette and as a solid.
#pragma once

#include <string>
#include <string_view>

#include "kerf/tool/tool.h"

namespace kerf::design {

enum class Sides : unsigned char { one, both };
/// SVG in true size: the cutting part on one layer, what is above it on another.
std::string tool_svg(const Tool& tool, Sides sides, std::string title);
/// Binary STL of the whole tool, arcs and circles as chords.
std::string tool_stl(const Tool& tool, std::string_view name);

}  // namespace kerf::design

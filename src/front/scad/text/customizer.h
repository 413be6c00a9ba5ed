// The parameters of a program for its user, as the customizer of OpenSCAD lists them: the assignments of
// literals before the first module or function, with the comments around them.
//
//   /* [Stock] */
//   // mm along X
//   width = 220;  // [10:500]
#pragma once

#include <string_view>
#include <vector>

#include "front/scad/text/syntax.h"

namespace kerf::scad {

std::vector<CustomParameter> custom_parameters(std::string_view text, std::uint32_t source);

}  // namespace kerf::scad

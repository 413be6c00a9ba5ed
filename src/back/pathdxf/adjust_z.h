// Programs of path drawings with their heights corrected by measured values, as PathGCodeAdjustZ makes them
// from the text alone.
//
// A corrected height is a number followed by its formula: "Z0.800(=0.800+1.000*[#51-2.000])" becomes
// "Z0.849(==0.800+1.000*[#51-2.000])".
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"

namespace kerf {

/// Replaces the first number with a formula in each line. Nothing, with errors, where a formula is malformed
/// or uses a variable without value. Lines with more formulas are warned of.
std::optional<std::string> adjust_z(std::string_view program, const std::string& file,
                                    const std::map<int, double>& values, Language language,
                                    Diagnostics& diagnostics);

/// The expected heights in the formulas of a program: 2.000 of "[#51-2.000]".
std::map<int, double> expected_heights(std::string_view program);

/// X and Y of the probing motions of a probing program, in its order.
std::vector<std::array<double, 2>> probed_positions(std::string_view program);

}  // namespace kerf

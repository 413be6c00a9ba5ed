// What the first comments of Kerf's posts state and its reader of G-code understands.
#pragma once

#include <string_view>

namespace kerf {

/// Follows the name of a post for mills in a program for a laser, "(Kerf 0.2.0, linuxcnc for a laser)":
/// M3, M4 and S are those of a beam.
inline constexpr std::string_view kForBeam = " for a laser";

/// Between the name of a post and the controller as which it is read: "(Kerf 0.2.0, mymill for grbl)".
inline constexpr std::string_view kForDialect = " for ";

}  // namespace kerf

// Programs in the languages of machines that do not read G-code: OpenSBP of ShopBot, RML-1 of Roland.
#pragma once

#include <string>
#include <string_view>

#include "kerf/base/diagnostics.h"
#include "kerf/path/toolpath.h"

namespace kerf {

struct NativeProgram {
  Toolpath path;
  bool inch = false;
  bool units_given = false;  // the program itself says its unit, or the length of its steps
  bool ended = false;
};

/// OpenSBP: moves and jogs (MX to M3, JX to J3), arcs (CG), speeds (MS, VS), spindle and outputs (TR, C6, C7,
/// SO,1), tools (&Tool, C9), PAUSE, END. Other commands, relative distances, variables and branches are
/// errors with their line, except for the test of the unit. Comments become notes.
NativeProgram read_opensbp(std::string_view text, const std::string& file_name, Diagnostics& diagnostics);
/// Whether a text is one, for files of other endings.
bool looks_like_opensbp(std::string_view text);

/// RML-1 in both of its modes; a file that starts with ^DF has steps of 0.01 mm, others of 0.025 mm. A motion
/// at the highest speed that ends at Z0 or above is a rapid.
NativeProgram read_rml(std::string_view text, const std::string& file_name, Diagnostics& diagnostics);
bool looks_like_rml(std::string_view text);

}  // namespace kerf

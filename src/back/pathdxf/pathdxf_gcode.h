// The G-code text of PathDxf2GCode, from a toolpath alone. Why it is no post profile: see
// docs/decisions/0025-pathdxf-gcode.md.
#pragma once

#include <string>

#include "kerf/base/diagnostics.h"
#include "kerf/path/toolpath.h"

namespace kerf {

struct PathdxfGcodeOptions {
  std::string program_line;  ///< the first comment: program and version
  std::string file_name;     ///< the second comment: the drawing
};

/// Words, their order and their decimals are those of PathDxf2GCode: a motion has the axes that its step
/// names (Step::named_axes), corrected heights are followed by "(=expression)", a note that starts with a
/// semicolon is a comment of that kind. Kinds of steps that path drawings do not have are errors.
std::string pathdxf_gcode(const Toolpath& path, const PathdxfGcodeOptions& options, Diagnostics& diagnostics);

}  // namespace kerf

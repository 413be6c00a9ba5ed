// The sheet of `kerf pathdxf --svg`.
#pragma once

#include <string>

#include "kerf/diagnostics.h"
#include "kerf/pathdxf.h"

namespace kerf::app {

/// Writes the sheet of a drawing, with the elements that `diagnostics` names; `run` may have no program.
void write_path_sheet(const std::string& file, const PathdxfRun& run, const std::string& sheet_file,
                      Diagnostics& diagnostics);

}  // namespace kerf::app

// Reading G-code: RS274 text becomes a toolpath, with the tools and the stock that its comments describe.
#pragma once

#include <map>
#include <optional>
#include <string_view>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/path/toolpath.h"
#include "kerf/program/gcode_options.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf {

/// How the centres of a program's arcs fit the ends of the arcs, where the program does not say what I, J and
/// K are. Arcs that fit both ways are not counted.
struct ArcEvidence {
  int as_offsets = 0, as_coordinates = 0, neither = 0;
  std::uint32_t first_line = 0;  // of the arcs that fit as coordinates
  bool is_for_coordinates() const { return as_coordinates > 0 && as_offsets == 0 && neither == 0; }
};

struct GcodeProgram {
  Toolpath path;
  bool inch = false;           // units at the first motion
  std::map<int, Tool> tools;   // described in the program's comments, by tool number
  std::optional<Stock> stock;  // from STOCK/BLOCK or stockMin/stockMax comments
  bool ended = false;          // M2, M30 or a closing % was read
  bool units_given = false;    // G20 or G21 was read
  double filament_diameter =
      1.75;  // mm, of a printer's program: by the options, its comments, else the default
  std::optional<double> filament_density;  // g/cm3, by a printer's comments
  bool assumed_diameter = false;           // the option was used
  ArcEvidence arcs;
  bool cut_short = false;  // a limit was reached or the input is not text; the end is unknown
  GcodeDialect dialect = GcodeDialect::rs274;
  bool torch = false;  // detected: a plasma torch or a water jet, whose S words are no power
};

/// Reads a whole program. Continues after an error; a program with errors still holds the steps that were
/// understood. Nothing is thrown; limits are errors. A stopped run returns an empty program.
GcodeProgram read_gcode(std::string_view text, const GcodeReadOptions& options, Diagnostics& diagnostics,
                        Progress* progress = nullptr);

}  // namespace kerf

// Foreign G-code in: RS274 text becomes a toolpath, with the tools and the stock that its comments describe.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/progress.h"
#include "kerf/stock.h"
#include "kerf/tool.h"
#include "kerf/toolpath.h"

namespace kerf {

/// What is done with text that follows M2, M30 or a closing %: LinuxCNC and most controllers stop there; a
/// sender streaming to GRBL goes on, so that a file of several programs runs through.
enum class AfterEnd : unsigned char { stop, read_on };

struct GcodeReadOptions {
  std::string file_name = "<text>";        // for origins
  std::size_t max_steps = 50'000'000;      // more is an error
  std::size_t max_line_bytes = 1'000'000;  // a longer line is an error
  bool strict = false;                     // warnings of unusual words become errors
  AfterEnd after_end = AfterEnd::stop;     // either way it is said that there is more text
};

/// What a program's text yields.
struct GcodeProgram {
  Toolpath path;
  bool inch = false;           // units at the first motion
  std::map<int, Tool> tools;   // described in the program's comments, by the T word they stand with
  std::optional<Stock> stock;  // from STOCK/BLOCK or stockMin/stockMax comments
  bool ended = false;          // M2, M30 or a closing % was seen
};

/// Reads a whole program. Goes on after an error; a program with errors still holds the steps that were
/// understood. Nothing is thrown; limits are errors. A stopped run returns an empty program.
GcodeProgram read_gcode(std::string_view text, const GcodeReadOptions& options, Diagnostics& diagnostics,
                        Progress* progress = nullptr);

}  // namespace kerf

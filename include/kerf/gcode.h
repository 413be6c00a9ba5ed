// Foreign G-code in: RS274 text becomes a toolpath, with the tools and the stock that its comments describe.
#pragma once

#include <cstdint>
#include <functional>
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
/// sender streaming to GRBL goes on, so that a file of several programs runs through. Subprograms that stand
/// there run only where they are called.
enum class AfterEnd : unsigned char { stop, read_on };

/// What is done with lines that begin with '/': run, or left out as with the controller's switch on.
enum class BlockDelete : unsigned char { run, skip };

/// Which controller a program is written for, where that changes what its words mean.
enum class GcodeDialect : unsigned char {
  rs274,    // LinuxCNC, and what all millers share
  grbl,     // GRBL and grblHAL: as rs274, streamed line by line
  mach3,    // G4 in the seconds or milliseconds that P tells; scaling (G51) and rotation (G68)
  fanuc,    // O-numbered programs, M98, M99
  laser,    // GRBL with a laser: M3 and M4 are the beam, S its power on each line
  marlin,   // printers: E, heaters, fans; G4 P in milliseconds
  klipper,  // as marlin, with commands in words
};
std::string_view to_string(GcodeDialect dialect);
/// The dialect of a name such as "linuxcnc", "GRBL", "grblhal", "Mach3"; nothing for an unknown one.
std::optional<GcodeDialect> dialect_named(std::string_view name);
/// Every name that dialect_named knows, for messages.
const std::vector<std::string>& dialect_names();
/// What a text's remarks and words say of the controller it is for; rs274 where they say nothing.
struct DialectGuess {
  GcodeDialect dialect = GcodeDialect::rs274;
  std::string from = {};   // what told it, for a message: "M104 in line 3 and E in line 20"
  std::uint32_t line = 0;  // the first such line
};
DialectGuess guess_dialect(std::string_view text);

struct GcodeReadOptions {
  std::string file_name = "<text>";    // for origins
  std::size_t max_steps = 50'000'000;  // more is an error
  /// Of these, how many a program may make beyond what its own length explains (a step for two bytes), by
  /// cycles, loops and curves; a small file must not fill the memory.
  std::size_t max_made_steps = 4'000'000;
  std::size_t max_line_bytes = 1'000'000;  // a longer line is an error
  bool strict = false;                     // warnings of unusual words become errors
  /// Either way it is said that there is more text. Nothing: read on for lasers, printers, Fanuc's numbered
  /// programs, and for GRBL where `dialect` names it.
  std::optional<AfterEnd> after_end = {};
  BlockDelete block_delete = BlockDelete::run;
  std::optional<GcodeDialect> dialect = {};  // nothing: guessed from the text, and said
  /// mm; turns a printer's E into volume. Nothing: what the slicer's remarks say, else 1.75.
  std::optional<double> filament_diameter = {};
  /// Text of the file "name.ngc" that `o<name> call` asks for (letters, digits, '_', '-' only); null: none.
  std::function<std::optional<std::string>(const std::string& file_name)> read_file = {};
  /// Diameter in mm of a tool, for G41 and G42; `described` is what the program's remarks say of it, or null.
  /// No function: the remarks count.
  std::function<std::optional<double>(int tool, const Tool* described)> tool_diameter = {};
  std::size_t max_rerun_bytes = 500'000'000;  // of lines read after a jump; more is an error
};

/// What a program's text yields.
struct GcodeProgram {
  Toolpath path;
  bool inch = false;           // units at the first motion
  std::map<int, Tool> tools;   // described in the program's comments, by the T word they stand with
  std::optional<Stock> stock;  // from STOCK/BLOCK or stockMin/stockMax comments
  bool ended = false;          // M2, M30 or a closing % was seen
  bool cut_short = false;      // a limit was reached, or it is no text; its end is not known
  GcodeDialect dialect = GcodeDialect::rs274;
};

/// Reads a whole program. Goes on after an error; a program with errors still holds the steps that were
/// understood. Nothing is thrown; limits are errors. A stopped run returns an empty program.
GcodeProgram read_gcode(std::string_view text, const GcodeReadOptions& options, Diagnostics& diagnostics,
                        Progress* progress = nullptr);

}  // namespace kerf

// Options of read_gcode (kerf/gcode.h).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "kerf/gcode_dialect.h"

namespace kerf {

struct Tool;

/// What happens with text after M2, M30 or a closing %. LinuxCNC and most controllers stop there; a sender
/// that streams to GRBL continues, so that a file of several programs runs to its end. Subprograms after the
/// program's end run only where they are called.
enum class AfterEnd : unsigned char { stop, read_on };

/// What happens with lines that start with '/': run, or skipped as with the controller's switch on.
enum class BlockDelete : unsigned char { run, skip };

struct GcodeReadOptions {
  std::string file_name = "<text>";    // for origins
  std::size_t max_steps = 50'000'000;  // more is an error
  /// Of these, the maximum that cycles, loops and curves may add to the number that the length of the text
  /// explains (one step per two bytes): a small file must not fill the memory.
  std::size_t max_made_steps = 4'000'000;
  std::size_t max_line_bytes = 1'000'000;  // a longer line is an error
  bool strict = false;                     // warnings of unusual words become errors
  /// Text after the end is reported either way. Nothing: read_on for lasers, printers, Fanuc's numbered
  /// programs, and for GRBL where `dialect` names it.
  std::optional<AfterEnd> after_end = {};
  BlockDelete block_delete = BlockDelete::run;
  std::optional<GcodeDialect> dialect = {};  // nothing: detected from the text, with a note
  /// mm; converts a printer's E to volume. Nothing: from the slicer's comments, else 1.75.
  std::optional<double> filament_diameter = {};
  /// Text of the file "name.ngc" that `o<name> call` names (letters, digits, '_', '-' only); null: no files.
  std::function<std::optional<std::string>(const std::string& file_name)> read_file = {};
  /// Diameter in mm of a tool, for G41 and G42; `described` is the tool of the program's comments, or null.
  /// No function: the diameter of the comments.
  std::function<std::optional<double>(int tool, const Tool* described)> tool_diameter = {};
  /// Diameter in mm that cutter compensation assumes for an unknown one, with a warning; nothing: an error.
  std::optional<double> assumed_diameter = {};
  std::size_t max_rerun_bytes = 500'000'000;  // of lines read after a jump; more is an error
};

}  // namespace kerf

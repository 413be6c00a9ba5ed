// Options of read_gcode (kerf/program/gcode.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

// Dialects of G-code: their names, and the detection of a program's dialect from its text.

/// The controller that a program is written for, where that changes the meaning of its words.
enum class GcodeDialect : unsigned char {
  rs274,    // LinuxCNC, and what all milling controllers have in common
  grbl,     // GRBL and grblHAL: as rs274, streamed line by line
  mach3,    // scaling (G51) and rotation (G68)
  fanuc,    // O-numbered programs, M98, M99
  haas,     // as fanuc, with the M codes of Haas' mills
  laser,    // GRBL with a laser: M3 and M4 switch the beam, S is its power on each line
  marlin,   // printers: E, heaters, fans; G4 P in milliseconds
  klipper,  // as marlin, with commands in words
  reprap,   // RepRapFirmware: as marlin, speeds of M203 and M566 in mm/min, fans from 0 to 1
};
constexpr bool is_fanuc(GcodeDialect dialect) {
  return dialect == GcodeDialect::fanuc || dialect == GcodeDialect::haas;
}
/// Whether the controller is that of a printer.
constexpr bool is_printer(GcodeDialect dialect) { return dialect >= GcodeDialect::marlin; }
std::string_view to_string(GcodeDialect dialect);
/// The dialect of a name such as "linuxcnc", "GRBL", "grblhal", "Mach3"; nothing for an unknown name.
std::optional<GcodeDialect> dialect_named(std::string_view name);
/// Every name that dialect_named accepts, for messages.
const std::vector<std::string>& dialect_names();

/// The dialect detected from comments and words; rs274 without evidence.
struct DialectGuess {
  GcodeDialect dialect = GcodeDialect::rs274;
  std::string from = {};   // the evidence, for a message: "M104 in line 3 and E in line 20"
  std::uint32_t line = 0;  // the first line with evidence
  bool torch = false;      // a plasma torch or a water jet: its S words are no power
};
DialectGuess guess_dialect(std::string_view text);

/// A program for a control or a process that is not supported, such as Heidenhain's or turning.
struct ForeignProgram {
  std::string_view control;  // "a Heidenhain control", "a lathe"
  std::string word;          // without blanks, gives it away
  std::uint32_t line = 0;
};
std::optional<ForeignProgram> find_foreign_language(std::string_view text);

struct Tool;

/// What happens with text after M2, M30 or a closing %. LinuxCNC and most controllers stop there; a sender
/// that streams to GRBL continues, so that a file of several programs runs to its end. Subprograms after the
/// program's end run only where they are called.
enum class AfterEnd : unsigned char { stop, read_on };

/// What happens with lines that start with '/': run, or skipped as with the controller's switch on.
enum class BlockDelete : unsigned char { run, skip };

/// What I, J and K of arcs are where the program does not say so (G90.1, G91.1): offsets from the start, or
/// coordinates. `detect`: offsets, unless no arc of the program fits so and all fit as coordinates.
enum class ArcCentres : unsigned char { detect, offsets, absolute };
/// The value that "offsets" or "absolute" names; nothing for other texts.
std::optional<ArcCentres> arc_centres_named(std::string_view name);

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
  ArcCentres arc_centres = ArcCentres::detect;
  /// Radius in mm by which G41 and G42 offset the path, by the number of their D, instead of the tool's: the
  /// wear of a tool for which the program is compensated already.
  std::map<int, double> compensation_radii = {};
  /// Diameter in mm that cutter compensation assumes for an unknown one, with a warning; nothing: an error.
  std::optional<double> assumed_diameter = {};
  std::size_t max_rerun_bytes = 500'000'000;  // of lines read after a jump; more is an error
};

}  // namespace kerf

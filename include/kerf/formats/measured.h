// Files of measured heights, and the points that they belong to.
//
// Formats, recognised by their text:
// - lists of probes of path drawings: "([1.000 2.000]/L:left/T=5.000) #51=5.1", also "@[1|2] #2001=5,1";
// - a saved console log of GRBL and its relatives: "[PRB:1.000,2.000,-3.100:1]". Its positions are machine
//   coordinates; the work offset in force before each probe is taken from "WCO:x,y,z" of status reports, or
//   from the active system, G92 and TLO in the answer to $#. Touch-offs, probes along X or Y, and the probe
//   that the answer to $# repeats are left out with a note;
// - a log of Marlin ("Bed X: 1 Y: 2 Z: 0.1") or Klipper ("probe at 1,2 is z=0.1");
// - height maps of Candle, of OpenCNCPilot and its kin (XML), gSender (JSON), Duet (CSV), Klipper
//   (printer.cfg, or its state as JSON), and grids without positions as Marlin and Klipper print them;
// - bCNC's .probe files: limits and counts in two lines, a line of Z limits, blank lines, then "x y z" lines;
// - a file of LinuxCNC's PROBEOPEN: nine numbers per line, X Y Z first;
// - lines "x y z", separated by blanks, commas or semicolons; lines that start with ; or ( are comments. A
//   first line of names ("N;X;Y;Z", "# y x z") says which columns are X, Y and Z.
//
// A file that starts as one form is read as that form alone. A map whose points are not those that it states
// (missing, more, twice, elsewhere) is an error at its line, and so is any field that is no number.
//
// Lengths are mm; logs in inches say so ("$13=1").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/units.h"

namespace kerf {

enum class HeightsFormat : std::uint8_t {
  probe_list,
  controller_log,
  positions,
  candle,
  xml,
  json,
  duet,
  klipper,
  printed_grid
};

struct MeasuredHeight {
  std::optional<int> variable;              ///< of a probe list: 51 for #51
  std::optional<std::array<double, 2>> at;  ///< work; of a probe list: in its drawing
  std::optional<double> height;             ///< nothing: measured without contact, or not yet
  std::optional<double> expected;           ///< T of a probe list
  std::string label;                        ///< L of a probe list
  std::size_t line = 0;
};

struct MeasuredFile {
  std::string file;
  HeightsFormat format = HeightsFormat::positions;
  std::vector<MeasuredHeight> heights;
};

struct MeasuredOptions {
  Language language = Language::english;
  /// Of machine coordinates in logs, precedes that of the log itself: work = machine - offset.
  std::optional<std::array<double, 3>> work_offset;
  std::size_t max_heights = 1'000'000;
  std::optional<double> mm_per_unit{};          ///< precedes the unit that the file states
  std::optional<std::array<double, 4>> area{};  ///< X0 Y0 X1 Y1 in mm, of grids without positions
};

/// Reads a file of any format. Lines that cannot be read are errors; the others are returned. A log without
/// work offset is an error, with the hint how to get one. Heights within 0.05 mm of each other that differ by
/// more than 0.001 mm are a warning; the last one counts.
MeasuredFile read_measured(std::string_view bytes, const std::string& file, const MeasuredOptions& options,
                           Diagnostics& diagnostics);

/// A point to be measured, of work coordinates.
struct HeightTarget {
  int variable = 0;
  std::array<double, 2> at{};
  std::optional<double> expected;
};

/// The height of each target: by its variable from a probe list, else by position, where the last height
/// within `within` of the target counts, with a warning where another one differs. Missing heights, and
/// heights that differ from the expected ones by more than `max_correction`, are errors; a position measured
/// that is no target is a warning.
std::map<int, double> heights_of(const MeasuredFile& measured, const std::vector<HeightTarget>& targets,
                                 Length within, Length max_correction, Language language,
                                 Diagnostics& diagnostics);

}  // namespace kerf

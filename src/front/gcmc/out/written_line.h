// A line of G-code that a program writes itself, with literal(): what of it a toolpath can carry.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/toolpath.h"

namespace kerf::gcmc {

/// What a line does, in the order in which a controller does it.
struct WrittenLine {
  std::vector<std::string> notes;   // its comments
  std::optional<double> speed;      // S, rpm
  std::optional<int> selected;      // T
  bool changes_tool = false;        // M6
  std::optional<SpindleTurn> turn;  // M3, M4, M5
  bool mist = false, flood = false, no_coolant = false;
  std::optional<step::Dwell> dwell;
  std::optional<step::PathMode> path_mode;  // its tolerance as written, in the program's unit of length
  std::string verbatim;                     // a call of a macro or of an M code that Kerf does not know
  std::optional<step::Pause> pause;
  std::optional<step::End> end;
};

/// Reads one line without its end. For a line that does more than a toolpath can carry (moves, modes, feeds,
/// parameters), or is not G-code, nothing; `obstacle` is then what was found and why it is refused.
std::optional<WrittenLine> read_written_line(std::string_view text, std::string& obstacle);

}  // namespace kerf::gcmc

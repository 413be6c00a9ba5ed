// A line of G-code written by literal(), as values that become steps of a toolpath.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/path/toolpath.h"

namespace kerf::gcmc {

/// The effects of a line, in the order of execution by a controller.
struct WrittenLine {
  std::vector<std::string> notes;   // its comments
  std::optional<double> speed;      // S, rpm
  std::optional<int> selected;      // T
  bool changes_tool = false;        // M6
  std::optional<SpindleTurn> turn;  // M3, M4, M5
  bool mist = false, flood = false, no_coolant = false;
  std::optional<step::Dwell> dwell;
  std::optional<step::PathMode> path_mode;  // its tolerance as written, in the program's unit of length
  std::string verbatim;                     // a call of a macro or of an unknown M code
  std::optional<step::Pause> pause;
  std::optional<step::End> end;
};

/// Reads one line without its end. Nothing, with the reason in `problem`, for a line that cannot be
/// represented (motions, modes, feeds, parameters) or is not G-code.
std::optional<WrittenLine> read_written_line(std::string_view text, std::string& problem);

}  // namespace kerf::gcmc

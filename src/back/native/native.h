// Programs in the languages of machines that do not read G-code: OpenSBP of ShopBot, RML-1 of Roland. Why
// they are no post profiles: docs/decisions/0054-languages-of-machines.md.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/units.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// `files`: one file per tool. `ignore`: nothing is written; the machine's operator knows.
enum class NativeToolChange : std::uint8_t { command, pause, files, ignore };

struct NativeOptions {
  std::string title = {};                            // of the program, for a comment
  std::string writer = {};                           // "Kerf 0.2.0"
  std::vector<std::string> comments = {};            // at the start: stock, the tool in the spindle
  std::optional<NativeToolChange> tool_change = {};  // nothing: the language's own
  bool inch = false;
  bool skip_left_out = false;  // codes that were left out and may have moved the tool are no error
  Feed missing_feed = {};      // for cuts without a feed; 0: an error
  std::map<int, std::string> tool_names = {};  // for comments, as write_tool_description
};

struct NativeFile {
  std::optional<int> tool;  // set if each tool has its own file
  std::string text;
};

/// Both append errors for steps that the machine cannot do and that change the part, warnings for others,
/// each with the line of the source. After an error the files must not be used; a stopped run returns none.
std::vector<NativeFile> write_opensbp(const Toolpath& path, const NativeOptions& options,
                                      Diagnostics& diagnostics, Progress* progress = nullptr);

/// Machines with RML-1 differ in the length of a step, in mm, and in the highest speed.
struct RmlMachine {
  double step = 0.025;
  double fastest = 15.0;  // mm/s
};
std::vector<NativeFile> write_rml(const Toolpath& path, const RmlMachine& machine,
                                  const NativeOptions& options, Diagnostics& diagnostics,
                                  Progress* progress = nullptr);

}  // namespace kerf

// Options of path drawings that change what is milled: those of `kerf pathdxf`, and of every command that
// reads a path drawing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kerf/base/units.h"

namespace kerf {

struct PathDrawingOptions {
  std::optional<Feed> feed;            ///< of paths without F; default 150 mm/min, with a note
  std::optional<Feed> probe_feed;      ///< of probes without Z; default: that of milling
  std::optional<Feed> rapid_speed;     ///< of rapids, for the statistics; default: feed
  std::optional<Length> rapid_height;  ///< of a main path without S; default T + O, with a note
  std::string path_names = "([0-9]{4})[.]([0-9]+)([A-Z])";   ///< expression for path names
  std::string file_patterns = "([0-9]{4})(?:[.]([0-9]+))?";  ///< for patterns in file names
  /// "PARENT:CHILD", expressions for path names: a path that matches PARENT (anywhere in its name) may embed
  /// only paths that match CHILD. E of the path goes first, then the first one of these whose PARENT matches.
  std::vector<std::string> restrictions;
  std::vector<std::string> variables;  ///< of the main path: "A=2"
  /// Names of those that a command line has ("--feed"): an error where the program is no path drawing.
  std::vector<std::string> given;
};

}  // namespace kerf

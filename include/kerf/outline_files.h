// Outlines as JSON files: what `kerf outline FILE.json` reads.
//
//   {"unit": "mm", "outlines": [{"name": "plate", "closed": true, "first": {"at": [0, 0], "corner": 3},
//     "segments": [{"to": [40, 0], "corner": 3}, {"to": [40, 20], "via": [45, 10]}, {"to": [0, 0]}]}]}
//
// `via` makes an arc, `corner` is the request for the router bit's radius (outline.h). "unit" is "mm" or
// "inch". "closed": true adds the closing line where the last end is not the first point.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/outline.h"

namespace kerf {

struct NamedOutline {
  std::string name;
  Outline outline;  // mm
};

/// Reads the text of an outline file; `file_name` is for messages. Empty, with errors appended that name the
/// outline and the element, where it is not well-formed.
std::vector<NamedOutline> read_outline_file(std::string_view text, const std::string& file_name,
                                            Diagnostics& diagnostics);

}  // namespace kerf

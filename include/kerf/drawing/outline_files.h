// Outlines as JSON files, the input of `kerf outline FILE.json`.
//
//   {"unit": "mm", "outlines": [{"name": "plate", "closed": true, "first": {"at": [0, 0], "corner": 3},
//     "segments": [{"to": [40, 0], "corner": 3}, {"to": [40, 20], "via": [45, 10]}, {"to": [0, 0]}]}]}
//
// `via` makes an arc, `corner` is the request for the router bit's radius (outline.h). "unit" is "mm" or
// "inch". "closed": true adds a closing line if the last point differs from the first one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/geom/outline.h"

namespace kerf {

struct NamedOutline {
  std::string name;
  Outline outline;         // mm
  CornerRequests corners;  // one for each element
};

/// Reads the text of an outline file; `file_name` is for messages. Empty, with errors that name the outline
/// and the segment, if it is invalid.
std::vector<NamedOutline> read_outline_file(std::string_view text, const std::string& file_name,
                                            Diagnostics& diagnostics);

}  // namespace kerf

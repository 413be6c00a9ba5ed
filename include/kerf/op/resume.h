// A program from a line on, after an interruption: the state that the lines before have left, a safe
// approach, and the rest of the steps.
//
//   Diagnostics diagnostics;
//   const auto rest = resume_from(path, {.line = 1200, .safe_z = 10}, diagnostics);
//
// The tool, the spindle, the coolant and the path mode in force before the line are set again, the tool rises
// to `safe_z`, moves above where the first motion starts, and is fed down to it. Feeds, units, planes and
// offsets need nothing: a toolpath has complete positions, and posts write the words that they require.
#pragma once

#include <cstdint>
#include <optional>

#include "kerf/diagnostics.h"
#include "kerf/toolpath.h"
#include "kerf/units.h"

namespace kerf {

struct ResumeOptions {
  std::uint32_t line = 0;  ///< of the program's text, from 1
  double safe_z = 0.0;     ///< Z at which rapids across are free
  Feed approach{};         ///< down to the start; 0: that of the first cut
};
struct Resumed {
  Toolpath path;
  std::size_t first = 0;  ///< the first step of the original that is run
};
/// Nothing, with an error: no motion at or after the line, an unknown position before it (code resume_line),
/// or a path that prints or engraves by laser (pass_refused).
std::optional<Resumed> resume_from(const Toolpath& path, const ResumeOptions& options,
                                   Diagnostics& diagnostics);

}  // namespace kerf

// What the path drawing commands print on standard error, in the form of the programs that they replace.
#pragma once

#include <string_view>

#include "kerf/base/diagnostics.h"

namespace kerf::app {

/// Exit statuses of those programs.
inline constexpr int kDropInErrors = 1, kDropInUsage = 2, kDropInNoFile = 3;

inline constexpr Bilingual kReadingFile{"Reading {}", "Lese {}"};
inline constexpr Bilingual kWritingFile{"Writing {}", "Schreibe {}"};

/// "---- text"
void print_line(std::string_view text);
/// Errors as "**** ...", warnings and notes as "---- ...". Notes and hints with `explain` only.
void print_messages(const Diagnostics& diagnostics, bool explain);

}  // namespace kerf::app

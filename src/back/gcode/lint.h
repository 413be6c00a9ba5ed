// The check of G-code against a profile, for whole programs and for single lines within one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "kerf/program/post.h"

namespace kerf::gcode {

/// `of_program`: the text is a whole program. `foreign_line`: the text is a line of unknown origin within a
/// program; it must neither move the machine nor change a mode.
enum class LintStart : std::uint8_t { of_program, foreign_line };

/// True without errors; see lint_gcode().
bool lint(std::string_view text, const PostProfile& profile, const std::string& file_name, LintStart start,
          Diagnostics& diagnostics);

}  // namespace kerf::gcode

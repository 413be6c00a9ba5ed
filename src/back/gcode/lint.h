// The check of G-code against a profile, for whole programs and for single lines in the middle of one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "kerf/post.h"

namespace kerf::gcode {

/// What comes before the text: nothing, or an unknown part of a program, of which the text is a line that was
/// not made for it. Such a line may neither move the machine nor change a mode.
enum class LintStart : std::uint8_t { of_program, foreign_line };

/// True if nothing was found; see lint_gcode().
bool lint(std::string_view text, const PostProfile& profile, const std::string& file_name, LintStart start,
          Diagnostics& diagnostics);

}  // namespace kerf::gcode

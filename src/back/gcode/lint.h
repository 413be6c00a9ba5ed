// The check of G-code against a profile, for whole programs and for single lines in the middle of one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "kerf/post.h"

namespace kerf::gcode {

/// At a program's begin nothing is known; within one, a feed and a position are.
enum class LintStart : std::uint8_t { of_program, in_program };

/// True if nothing was found; see lint_gcode().
bool lint(std::string_view text, const PostProfile& profile, const std::string& file_name, LintStart start,
          Diagnostics& diagnostics);

}  // namespace kerf::gcode

// Random G-code programs with state of every kind, as text: for mills, lasers and printers.
#pragma once

#include <string>

#include "kerf/program/gcode_options.h"

namespace kerf {

enum class ProgramKind : unsigned char { mill, laser, print };

struct RandomProgram {
  ProgramKind kind = ProgramKind::mill;
  GcodeDialect dialect = GcodeDialect::rs274;  // that it is read as
  std::string text;
};

/// The same program for the same number.
RandomProgram random_program(unsigned seed);

}  // namespace kerf

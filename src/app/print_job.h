// A printing program, as kerf simulate does it: material is added, not cut.
#pragma once

#include "app/outputs.h"

#include "kerf/print.h"

namespace kerf::app {

/// How much of the grooves between roads a written surface shows.
enum class Grooves { closed, kept };

/// Lays the program's roads, writes the outputs, tells the result.
Status simulate_printing(Console& console, const LoadedProgram& program, const PrintOptions& how,
                         Grooves grooves, const std::vector<OutputFile>& outputs, const View& view,
                         Diagnostics& diagnostics);

}  // namespace kerf::app

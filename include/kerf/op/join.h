// Programs one after another as one program, with a safe way from the end of each to the start of the next.
//
//   Diagnostics diagnostics;
//   auto path = joined({&pockets, &holes}, diagnostics);
//
// Frame and units as in toolpath.h.
#pragma once

#include <optional>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/limits.h"
#include "kerf/toolpath.h"

namespace kerf {

/// Appends the steps of a program to `path`, without the ends of both. Spindle, coolant and laser that `path`
/// has left on are switched off, as its end would. From a known position the tool rises to the height of the
/// program's first known position, or stays higher, and moves across before it goes down. False, with an
/// error (code pass_refused) and `path` as it was, if the program starts with a cut, if either sets work
/// zeros, or for a path with more than limits::kMaxPathSteps steps.
bool append_program(Toolpath& path, const Toolpath& program, Diagnostics& diagnostics);

/// The programs in their order, with one end. Nothing, with an error, as above.
std::optional<Toolpath> joined(const std::vector<const Toolpath*>& programs, Diagnostics& diagnostics);

}  // namespace kerf

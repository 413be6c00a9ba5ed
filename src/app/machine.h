// What is told of the machine with --machine: so far GRBL's `$$` settings, of which the rapid rates are used.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "kerf/diagnostics.h"
#include "kerf/units.h"

namespace kerf::app {

struct Machine {
  std::array<Feed, 3> rapid;  // X, Y, Z: $110, $111, $112
};

/// Reads a file of lines such as "$110=3000.000" (text behind a number is passed over). Errors where it has
/// none of the rapid rates, or one that is not above 0.
std::optional<Machine> read_machine(const std::string& path, Diagnostics& diagnostics);

}  // namespace kerf::app

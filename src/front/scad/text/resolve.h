// Gives every variable its frame and slot, and every call its function or module.
#pragma once

#include "front/scad/text/parser.h"

namespace kerf::scad {

/// Slot 0 of the frame around those of all files: PI.
inline constexpr std::uint32_t kPiSlot = 0;

void resolve(Program& program, const KnownNames& known, Diagnostics& diagnostics);

}  // namespace kerf::scad

// Values of a program as values of the machine's commands, and back.
#pragma once

#include "design/call/value.h"
#include "front/scad/value/command.h"

namespace kerf::scad {

/// A function of the program is called at `site`, which the result must not outlive.
design::Value to_design(const Value& value, CallSite& site);
Value from_design(const design::Value& value);

}  // namespace kerf::scad

// The commands of gcodepreview for OpenSCAD programs: a thin layer over the machine of src/design.
//
//   const std::unique_ptr<CommandState> state = make_state({.tools = &built_in_tools()});
//   // the interpreter runs a program with {&commands(), state.get()}
//   design::Results results = finish(*state, diagnostics);
//
// An outline is a vector: the first element is a point [x, y], each further one a straight segment to [x, y]
// or an arc [via x, via y, x, y].
#pragma once

#include <memory>
#include <vector>

#include "design/machine/outputs.h"
#include "front/scad/value/command.h"

namespace kerf::scad {

const std::vector<Command>& commands();
std::unique_ptr<CommandState> make_state(const design::MachineOptions& options);
/// Ends a run. Files that were opened and not closed are not written, with a warning.
design::Results finish(CommandState& state, Diagnostics& diagnostics);

}  // namespace kerf::scad

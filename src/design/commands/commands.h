// The commands of gcodepreview as one table, for every language that calls them.
//
//   Machine machine({.tools = &built_in_tools()});
//   const Value arguments[] = {10.0, 20.0, -1.0};
//   Call call(commands()[i], site, arguments);
//   const Value result = run(machine, call);
//   Results results = finish(machine, [&](std::string text) { ... });
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "design/machine/machine.h"

namespace kerf::design {

const std::vector<Command>& commands();
/// Runs the command of a call. Its errors and warnings go to the call's site; after an error the value is
/// undefined.
Value run(Machine& machine, Call& call);
/// Ends a design. Files that were opened and not closed are not written, with a warning.
Results finish(Machine& machine, const std::function<void(std::string)>& warn);

}  // namespace kerf::design

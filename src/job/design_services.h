// What the machine of src/design needs of other modules: tools, files of stock and of G-code, the stock that
// is left after cuts; and its G-code files.
#pragma once

#include <map>
#include <vector>

#include "design/machine/outputs.h"

#include "kerf/base/progress.h"

namespace kerf {

design::MachineOptions machine_services(Progress* progress);

/// Appends the texts of a G-code file: several where its post writes one for each tool. `own` are the tools
/// of the design. Adds nothing, with errors, if the post refuses the toolpath.
void post_design(const DesignProgram& made, const std::map<int, Tool>& own, std::vector<DesignFile>& files,
                 Diagnostics& diagnostics, Progress* progress);

}  // namespace kerf

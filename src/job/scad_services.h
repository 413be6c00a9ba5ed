// What the commands of OpenSCAD programs need of other modules: tools, files of stock and of G-code, and the
// stock that is left after cuts.
#pragma once

#include "front/scad/commands/commands.h"

#include "kerf/base/progress.h"

namespace kerf {

scad::CommandOptions command_services(Progress* progress);

}  // namespace kerf

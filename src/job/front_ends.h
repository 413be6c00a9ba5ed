// The table of front ends that program.cpp selects from.
#pragma once

#include <string>

#include "kerf/job/program.h"

namespace kerf {

FrontEnd gcode_front_end();
FrontEnd gcmc_front_end();
FrontEnd pathdxf_front_end();
FrontEnd cut_front_end();
FrontEnd scad_front_end();
FrontEnd kerf_front_end();
FrontEnd opensbp_front_end();
FrontEnd rml_front_end();

/// The tools of LinuxCNC's tool.tbl in the folder of a G-code program, with diameters in the program's unit,
/// and a note that says so; empty if there is none.
ToolTable tool_table_beside(const InputFile& program, Diagnostics& diagnostics);

}  // namespace kerf

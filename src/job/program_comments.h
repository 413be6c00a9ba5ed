// Tools and stock from the comments of a program whose front end keeps them as notes.
#pragma once

#include "kerf/job/program.h"

namespace kerf {

/// Reads the comments of CutViewer's form, those of the stock, and Kerf's own of tools ("tool 3: ball,
/// diameter 6 mm") into the program.
void read_comments(Program& program, Diagnostics& diagnostics);

}  // namespace kerf

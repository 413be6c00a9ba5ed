// Which kinds of tools an operation can be cut with.
#pragma once

#include "kerf/program/cut_job.h"

namespace kerf::cut_detail {

/// Whether the kind of the tool can do the operation; an error names those that can.
bool suits(const Tool& tool, const CutOperation& operation, Diagnostics& diagnostics);

}  // namespace kerf::cut_detail

// The beam of a laser in the tool table of a job: an assumed tool.
#pragma once

#include "kerf/job/job.h"

namespace kerf {

/// Whether tool `number` is the beam of a laser, which has no flutes; no file describes it.
bool is_beam(const Job& job, int number);

}  // namespace kerf

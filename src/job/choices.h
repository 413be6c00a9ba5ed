// The steps of make_job.
#pragma once

#include "kerf/job.h"

namespace kerf {

/// Fills in tools and their sources; where motions precede the first tool change and a tool is given for
/// them, the path gets a tool change in front.
void choose_tools(Job& job, const JobSettings& settings, UnknownTool unknown, Diagnostics& diagnostics);
/// Fills in stock or bar, and fixtures. The tools must have been chosen.
void choose_stock(Job& job, const JobSettings& settings, Diagnostics& diagnostics);

}  // namespace kerf

// Choosing the tools and the stock of a job, for make_job.
#pragma once

#include "kerf/job/job.h"

namespace kerf {

/// Sets the tools and their sources. If motions precede the first tool change and a tool is given for them, a
/// tool change is inserted at the start of the path.
void choose_tools(Job& job, const JobSettings& settings, UnknownTool unknown, Diagnostics& diagnostics);
/// The hint for a tool of unknown shape; without a number: for the cuts before the first tool change.
std::string hint_for_unknown(std::optional<int> number, std::string_view diameter);
/// Sets stock or bar, and fixtures; after choose_tools.
void choose_stock(Job& job, const JobSettings& settings, Diagnostics& diagnostics);

}  // namespace kerf

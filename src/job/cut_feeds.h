// Feeds of a cutting job that are not given.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "kerf/program/cut_job.h"

namespace kerf::job_detail {

/// Sets the feed of each operation that has none, by the chip load in its material, and says so in a note.
/// `file`: of the job; beside it are files of machines, which are added to `files`. False, with errors, where
/// something is missing for it.
bool choose_feeds(CutJob& job, const std::map<int, Tool>& tools, const std::string& file,
                  std::vector<std::string>& files, Diagnostics& diagnostics);

}  // namespace kerf::job_detail

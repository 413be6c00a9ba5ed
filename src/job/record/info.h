// The figures of a program as JSON: motions, times, tools, feeds, stock.
#pragma once

#include "job/record/record.h"

#include "kerf/job/job.h"

namespace kerf {

inline constexpr const char* kPlainMethod = "programmed feeds and rapid rates, without acceleration";
inline constexpr const char* kPlannedMethod = "planned with the accelerations of the machine profile";

/// The object of `kerf info --json` for a program that cuts.
Record info_record(const Job& job, const JobTimes& times, const Diagnostics& diagnostics);

}  // namespace kerf

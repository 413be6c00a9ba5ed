// The figures of a program as JSON: motions, times, tools, feeds, stock.
#pragma once

#include "app/report/json.h"

#include "kerf/job/job.h"

namespace kerf::app {

inline constexpr const char* kPlainMethod = "programmed feeds and rapid rates, without acceleration";
inline constexpr const char* kPlannedMethod = "planned with the accelerations of the machine profile";

/// The object of `kerf info --json` for a program that cuts.
Json info_json(const Job& job, const JobTimes& times, const Diagnostics& diagnostics);

}  // namespace kerf::app

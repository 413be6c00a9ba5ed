// What kerf info prints for a printing program.
#pragma once

#include "app/report/console.h"

#include "kerf/job.h"

namespace kerf::app {

/// The filament, layers and time of a print. `density` in g/cm3; 0: that of the program, else that of PLA.
void print_info_of_print(Console& console, const Job& job, const JobTimes& times, double density,
                         const Diagnostics& diagnostics);

}  // namespace kerf::app

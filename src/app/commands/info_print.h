// What kerf info prints for a printing program.
#pragma once

#include "app/report/console.h"

#include "kerf/formats/printer_files.h"
#include "kerf/job/job.h"

namespace kerf::app {

struct PrintInfoOptions {
  double density = 0.0;  ///< g/cm3; 0: that of the program or the filament, else that of PLA
  const PrinterChoice* printer = nullptr;  ///< its limits of motions, where the program sets none
  Volume target{};                         ///< of the part that is printed; 0: not known
};
/// The filament, layers, flow and time of a print.
void print_info_of_print(Console& console, const Job& job, const JobTimes& times,
                         const PrintInfoOptions& options, const Diagnostics& diagnostics);

}  // namespace kerf::app

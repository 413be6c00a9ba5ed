// The result of `kerf simulate`, one function per kind of job.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/report/console.h"

#include "kerf/job/outputs.h"

namespace kerf::app {

/// A finished simulation and the files written.
struct SimulationReport {
  const Job& job;
  const JobRun& run;
  const std::vector<PartFile>& files;
  const Diagnostics& diagnostics;
  /// Of the beads of a print, with their colours; may be empty.
  std::vector<std::pair<std::string, std::array<std::uint8_t, 3>>> legend = {};
  /// Of the meshes among the files.
  std::optional<Length> mesh_tolerance = {};
};
/// The result as JSON, or as text without the diagnostics.
void report_milling(Console& console, const SimulationReport& report);
void report_rotary(Console& console, const SimulationReport& report);
void report_print(Console& console, const SimulationReport& report);
/// A program that cuts nothing, of which pictures of the toolpath were written.
void report_drawing(Console& console, const Job& job, const std::vector<PartFile>& files,
                    const Diagnostics& diagnostics);

}  // namespace kerf::app

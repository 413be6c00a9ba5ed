// The options of commands that read a map of measured heights.
#pragma once

#include <string>

#include "app/options/parser.h"
#include "job/heights.h"

namespace kerf::app {

struct MapOptions {
  std::string unit, zero, area;  // empty: as the file states
};
void add_map_options(CommandParser& parser, MapOptions& options);
/// `work_offset`: of --work-offset.
SurfaceReading surface_reading(const MapOptions& options, const std::string& work_offset);

}  // namespace kerf::app

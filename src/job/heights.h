// Measured heights for programs: corrections of path drawings, and levelling.
//
//   load_program("part.dxf", {.measured = {.file = "part_Z.txt"}}, diagnostics);      // corrected heights
//   level_program(program, "map.txt", {}, {.max_correction = mm(1)}, diagnostics);    // follows a surface
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/units.h"
#include "kerf/formats/measured.h"
#include "kerf/geom/geometry.h"
#include "kerf/job/program.h"
#include "kerf/op/level.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// Replaces the formulas of a program's heights by their values. False with errors.
bool apply_measured(Program& program, const MeasuredSettings& settings, Diagnostics& diagnostics);

/// How the heights of a map count.
enum class MapZero : std::uint8_t { as_measured, mean, point };

struct SurfaceReading {
  MeasuredOptions reading;
  MapZero zero = MapZero::as_measured;
  Point2 zero_at{};  // of MapZero::point
};

/// A file of measured heights (kerf/formats/measured.h; of a probe list: measured less expected heights) as a
/// surface.
struct MeasuredSurface {
  MeasuredFile file;
  std::vector<Point3> points;
  HeightMap map;
  std::vector<std::size_t> outliers;  // of the points
};
std::optional<MeasuredSurface> read_surface(const std::string& file, const SurfaceReading& reading,
                                            Diagnostics& diagnostics);

/// Lets the program follow such a surface. Cuts beyond its area are a warning.
std::optional<LevelReport> level_program(Program& program, const std::string& file,
                                         const SurfaceReading& reading, const LevelOptions& options,
                                         Diagnostics& diagnostics, Progress* progress = nullptr);

}  // namespace kerf

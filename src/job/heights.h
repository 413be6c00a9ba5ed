// Measured heights for programs: corrections of path drawings, levelling, and the programs that measure.
//
//   load_program("part.dxf", {.measured = {.file = "part_Z.txt"}}, diagnostics);      // corrected heights
//   level_program(program, "map.txt", {}, {.max_correction = mm(1)}, diagnostics);    // follows a surface
#pragma once

#include <optional>
#include <string>

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

/// Lets the program follow the surface of a file of measured heights (kerf/formats/measured.h; of a probe
/// list: measured less expected heights). Cuts beyond its area are a warning.
std::optional<LevelReport> level_program(Program& program, const std::string& file,
                                         const MeasuredOptions& reading, const LevelOptions& options,
                                         Diagnostics& diagnostics, Progress* progress = nullptr);

struct ProbingGrid {
  int columns = 0, rows = 0;  // at least 2 each
  Box2 area;                  // mm; its corners are measured
  Length clearance = mm(5);   // above the nominal surface Z0, of rapids
  Length depth = mm(2);       // below it, where probing without contact ends
  Feed feed = mm_per_min(50);
};
/// A program that measures the points of a grid row by row, back and forth, with G38.2.
Toolpath probing_program(const ProbingGrid& grid);

}  // namespace kerf

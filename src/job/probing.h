// Programs that measure the heights of a grid, for each controller that shows or stores them.
#pragma once

#include <optional>
#include <string>

#include "kerf/base/diagnostics.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/job/posting.h"
#include "kerf/path/toolpath.h"

namespace kerf {

struct ProbingGrid {
  int columns = 0, rows = 0;  // at least 2 each
  Box2 area;                  // mm; its corners are measured
  Length clearance = mm(5);   // above the nominal surface Z0, of rapids
  Length depth = mm(2);       // below it, where probing without contact ends
  Feed feed = mm_per_min(50);
};
/// The motions that measure the points of a grid row by row, back and forth, with G38.2.
Toolpath probing_program(const ProbingGrid& grid, ProbeKind kind = ProbeKind::contact_or_error);

/// About how long it takes: each point is at Z0.
Duration probing_time(const ProbingGrid& grid);

struct ProbingText {
  std::string text;
  std::string result;  ///< where the heights are afterwards, one sentence
};
/// The program for a controller; `name`: of its file, without ending. Nothing, with an error, for a
/// controller that neither shows nor stores what it measures.
std::optional<ProbingText> write_probing(const ProbingGrid& grid, const PostTarget& target,
                                         const std::string& name, Diagnostics& diagnostics);

}  // namespace kerf

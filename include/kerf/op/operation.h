// What all milling operations have in common: levels, passes, feeds, entry, and what they return.
//
//   const CutOptions cut{.depth = mm(6), .stepdown = mm(2), .feed = mm_per_min(900), .plunge =
//   mm_per_min(300)}; const auto made = pocket(region, tool, {.cut = cut, .stepover = 0.4}, diagnostics);
//   append(path, made->path);
//
// Frame: work coordinates, mm, Z up. An operation makes motions only: tool change, spindle and coolant are
// the caller's. Its path starts and ends on the retract plane. The tool is fed into material, and a rapid
// goes down no further than to CutOptions::clearance above what the operation itself has cleared.
//
// Errors (codes 10xxx) go to Diagnostics: options out of range, regions that are empty or open, tools that do
// not fit. Where a tool fits in some parts only, these are cut, and the result says what is left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/limits.h"
#include "kerf/base/progress.h"
#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/geom/region.h"
#include "kerf/path/toolpath.h"
#include "kerf/tool/tool.h"

namespace kerf {

/// With a spindle that turns clockwise (M3): climb has the wall on the right of the direction of travel.
enum class CutDirection : std::uint8_t { climb, conventional };

/// How a tool gets from one level to the next. What does not fit is replaced: a helix by a ramp, a ramp on a
/// path too short for it by a plunge.
enum class EntryKind : std::uint8_t {
  plunge,  ///< straight down
  ramp,    ///< down along the path that is cut next
  helix    ///< down a circle inside the region
};
struct Entry {
  EntryKind kind = EntryKind::helix;
  Angle angle = degrees(3);  ///< maximum descent of a ramp or helix
  Length radius{};           ///< of a helix; 0: 0.45 times the diameter of the tool
};

struct CutOptions {
  double top = 0.0;            ///< Z of the surface of the material
  Length depth{};              ///< below `top`, > 0
  Length stepdown{};           ///< maximum depth of a pass; 0: one pass. All passes have the same depth
  Feed feed{};                 ///< > 0
  Feed plunge{};               ///< maximum feed downwards; 0: half of `feed`
  double retract_plane = 5.0;  ///< Z of rapids between cuts, above `top`
  Length clearance = mm(0.5);  ///< above material, where the tool changes from rapid to feed
  Length allowance{};          ///< left on walls for a finishing pass
  CutDirection direction = CutDirection::climb;
  Entry entry{};
  Tolerance tolerance{};  ///< chord: of the width of a slot that a tool may exceed and still cut it
  std::size_t max_steps = limits::kMaxGeneratedSteps;
  std::string name{};            ///< of the operation, in messages
  Origin where{};                ///< of the steps and messages
  Progress* progress = nullptr;  ///< may stop the work: then there is no value, and no error
};

enum class ContourSide : std::uint8_t {
  outside,  ///< the region is the part that remains: around it, and inside its holes
  inside    ///< the region is cut out: along its walls
};
/// How the tool gets to the wall and leaves it.
enum class LeadKind : std::uint8_t {
  none,
  arc,  ///< a quarter circle tangent to the wall
  line  ///< square to the wall
};
/// Left out where it does not fit.
struct Lead {
  LeadKind kind = LeadKind::none;
  Length size{};  ///< the radius of the arc, or the length of the line
};

/// A part of the region that a tool is too wide for.
struct NarrowPart {
  Point2 at;        ///< where the circle below is centred
  Length diameter;  ///< of the largest tool that fits there
};

struct Operation {
  Toolpath path;
  Region unreached;                  ///< what is left of the region; of a contour: of its corners
  std::vector<NarrowPart> narrow{};  ///< parts of it wider than corners are; each has a warning
};

/// Appends the steps of `piece` to a path; both sources are kept apart by their origins. The first rise of
/// the piece starts where `path` ends, and no lower.
void append(Toolpath& path, const Toolpath& piece);

/// The radius that a tool cuts with where its tip is at `depth` below the surface: the maximum of its cutting
/// part up to that height.
Length cutting_radius(const Tool& tool, Length depth);

/// The levels of the passes, from the first to the bottom.
std::vector<double> pass_levels(double top, Length depth, Length stepdown);

// Tabs: bridges of material that hold a part until all cuts are done. Where a tab is, the tool stays above
// it.
//
//   Diagnostics diagnostics;
//   const auto held = add_tabs(path, {.height = mm(1.5), .length = mm(6), .count = 4}, mm(6), diagnostics);
//
// Tabs are placed on the closed paths that are cut to the bottom, at equal distances and, if possible, on
// straight parts. All cuts along the same path that go below the top of a tab rise over it.

enum class TabShape : std::uint8_t {
  rectangular,  ///< the tool rises and descends straight
  triangular    ///< it rises and descends along the path: no stops, less material to remove
};
struct TabOptions {
  Length height{};   ///< above the bottom; 0: no tabs
  Length length{};   ///< of the material that remains, at the bottom; 0: the diameter of the tool
  int count = 4;     ///< on each path, unless `spacing` is given
  Length spacing{};  ///< distance of tabs along the path; 0: by `count`
  TabShape shape = TabShape::rectangular;
  Feed plunge{};  ///< maximum feed downwards; 0: half of the feed of the cut
  std::size_t max_steps = limits::kMaxPathSteps;
};
/// `diameter`: of the tool. Nothing, with an error (code pass_option), for options out of range; a path that
/// is too short for its tabs gets fewer, with a warning (pass_refused).
std::optional<Toolpath> add_tabs(const Toolpath& path, const TabOptions& options, Length diameter,
                                 Diagnostics& diagnostics);

}  // namespace kerf

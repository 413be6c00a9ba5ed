// Holes: drilled at points by cycles, or bored larger than the tool by helices.
//
//   const auto made = drill(points, tool, {.kind = DrillKind::peck, .depth = mm(12), .peck = mm(3),
//       .feed = mm_per_min(100)}, diagnostics);
//
// Frame and errors as in operation.h. Holes are in the order of short rapid travel.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/limits.h"
#include "kerf/base/origin.h"
#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/op/operation.h"
#include "kerf/path/toolpath.h"

namespace kerf {

// Canned cycles expanded into motions: the holes of G73, G74 and G81 to G89.
//
// All front ends with canned cycles use it, so that a hole is the same sequence of steps in every format.
// Order of motions, retract levels and the clearance above a peck are those of LinuxCNC's interpreter (its
// page "G-Codes", canned cycles).
//
//   DrillCycle hole;
//   hole.kind = DrillKind::peck;
//   hole.at = {10, 10, 0};
//   hole.retract_plane = 2, hole.bottom = -12, hole.start_level = 5;
//   hole.peck = mm(3);
//   add_cycle(path, hole, {0, 0, 5}, {mm_per_min(100), rpm(3000)}, origin);
//
// Levels are coordinates in mm along the axis of the holes, the third axis of `plane`; larger is farther out
// of the material.

enum class DrillKind : std::uint8_t {
  plain,         // G81: down at feed, out at rapid
  dwell,         // G82: with a dwell at the bottom
  chip_break,    // G73: pecks, the tool retracts by the clearance only
  peck,          // G83: pecks, the tool retracts to the retract plane
  tap,           // G84: the spindle reverses at the bottom; right-hand thread
  left_tap,      // G74
  bore,          // G85: out at feed
  stopped_bore,  // G86: dwell, spindle stopped, out at rapid
  back_bore,     // G87: in beside the hole with the spindle stopped, then bored outwards
  manual_bore,   // G88: dwell, spindle stopped, pause for the operator
  dwell_bore,    // G89: dwell, out at feed
};

/// Where a hole ends: at the retract plane (G99), or where the series of cycles started if that is higher
/// (G98).
enum class DrillRetract : std::uint8_t { plane, start };

struct DrillCycle {
  DrillKind kind = DrillKind::plain;
  Plane plane = Plane::xy;
  Point3 at;         // of the first hole; its coordinate along the third axis is not used
  Point3 increment;  // from one hole to the next
  int holes = 1;
  double retract_plane = 0.0;  // below it the tool moves at feed
  double bottom = 0.0;
  DrillRetract retract = DrillRetract::plane;
  double start_level = 0.0;           // of the tool before the first cycle of the series
  Length peck;                        // depth of the first peck, > 0; chip_break and peck
  Length peck_less;                   // each further peck is smaller by this, but not smaller
  Length peck_least;                  // than this
  Length peck_clearance = mm(0.254);  // the rapid before the next peck ends this far above the depth reached
  Length weld = Tolerance{}.weld;     // levels closer than this are one: rounding makes no peck of its own
  Duration dwell;                     // at the bottom; 0: none
  double back_level = 0.0;            // back_bore: end of the cut
  Point3 aside;                       // back_bore: from the axis of the hole to where the tool enters
  SpindleTurn turn = SpindleTurn::off;  // in force; the boring cycles that stop the spindle restore it

  Length smallest_peck() const { return peck_less > Length() ? std::min(peck, peck_least) : peck; }
  bool has_pecks() const { return kind == DrillKind::chip_break || kind == DrillKind::peck; }
};

/// The error of a cycle that cannot be expanded.
struct DrillFault {
  Code code;            // cycle_upside_down, word_missing (peck) or word_out_of_range (too many pecks)
  std::string message;  // without a final period
};
std::optional<DrillFault> fault_of(const DrillCycle& cycle, double max_pecks = limits::kMaxPecks);

/// A lower bound of the number of steps, to be compared with a limit before the steps are made.
double min_steps(const DrillCycle& cycle);

/// Receives the motions of a cycle, one after the other.
class DrillSink {
 public:
  virtual ~DrillSink() = default;
  virtual void rapid(Point3 to) = 0;
  virtual void cut(Point3 to) = 0;
  virtual void dwell(Duration time) = 0;
  virtual void spindle(SpindleTurn turn) = 0;
  /// The operator retracts the tool by hand, which the rapid that follows represents.
  virtual void pause() = 0;
  /// True ends the cycle early.
  virtual bool is_full() const { return false; }
};

/// The motions of all holes, the tool being at `from`. The cycle must have no fault.
void expand(const DrillCycle& cycle, Point3 from, DrillSink& sink);

/// True if the first motion is a rapid along the third axis to the retract plane, before the tool moves to
/// the first hole.
inline bool rises_first(const DrillCycle& cycle) { return cycle.start_level < cycle.retract_plane; }

struct DrillRates {
  Feed feed;
  SpindleSpeed speed;
};
/// Appends the steps of a cycle to a toolpath. The cycle must have no fault.
void add_cycle(Toolpath& path, const DrillCycle& cycle, Point3 from, const DrillRates& rates,
               OriginId origin);

/// What of the tool reaches the depth of a hole.
enum class DrillDepth : std::uint8_t {
  tip,
  diameter  ///< its full diameter: the tip goes deeper by `point_length`
};
/// The height of the point of a tool: from its tip to where it has its diameter.
Length point_length(const Tool& tool);

struct DrillOptions {
  DrillKind kind = DrillKind::plain;  ///< plain, dwell, chip_break, peck, bore or dwell_bore
  double top = 0.0;                   ///< Z of the surface
  Length depth{};                     ///< below `top`, > 0
  DrillDepth depth_of = DrillDepth::tip;
  Length peck{};               ///< depth of a peck
  Duration dwell{};            ///< at the bottom
  Feed feed{};                 ///< > 0
  double retract_plane = 5.0;  ///< Z of rapids between holes
  Length clearance = mm(0.5);  ///< above `top`, where the tool changes from rapid to feed
  std::string name{};
  Origin where{};
};
std::optional<Operation> drill(const std::vector<Point2>& points, const Tool& tool,
                               const DrillOptions& options, Diagnostics& diagnostics);

struct BoreOptions {
  CutOptions cut{};       ///< stepdown: the pitch of the helix; 0: by Entry::angle
  double stepover = 0.4;  ///< of the helices of a wide bore
};
/// Circular holes with a flat bottom, by a helix to the depth and a full circle there; one helix after the
/// other, from the inside, where the hole is wider than two tools.
std::optional<Operation> bore(const std::vector<Circle>& holes, const Tool& tool, const BoreOptions& options,
                              Diagnostics& diagnostics);

}  // namespace kerf

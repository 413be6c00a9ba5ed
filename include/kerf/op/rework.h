// All changes that can be made to a finished program, in one call: what `kerf post` and the bindings offer.
//
//   ReworkOptions options;
//   set_rework(options, "step-down", "2");
//   const auto changed = rework(path, {{1, mill}}, options, diagnostics);
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/limits.h"
#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/op/operation.h"
#include "kerf/op/rows.h"
#include "kerf/path/toolpath.h"
#include "kerf/tool/tool.h"

namespace kerf {

// Leads and a finishing pass for the closed paths of a finished toolpath.
//
//   Diagnostics diagnostics;
//   const auto made = add_leads(path, {.lead_in = {LeadKind::arc, mm(3)}, .finish = mm(0.3)}, diagnostics);
//
// A closed path is a chain that goes straight down and then once around on one level. The part is on one side
// of it; leads are on the other one, and are left out, with a warning, where they would cross a closed path.
// The rapids that lead to the path and up from it move along with its ends. With a finishing allowance the
// path is first cut at that distance from the part, and then, as one pass at the full depth, where it was.
// All steps keep their origins.

enum class PartSide : std::uint8_t {
  right,  ///< of the direction of travel: climb milling with a clockwise spindle
  left    ///< conventional milling
};
struct LeadOptions {
  double top = 0.0;  ///< Z of the surface of the material: only rapids at this Z and above are moved
  Lead lead_in{}, lead_out{};
  Length overlap{};  ///< how far the tool continues along the path beyond its start
  /// Left on the part by all passes but the last. The last one has an arc of twice this radius as its lead,
  /// unless one is given.
  Length finish{};
  PartSide part = PartSide::right;
  Tolerance tolerance{};
  std::size_t max_steps = limits::kMaxPathSteps;
};
struct Led {
  Toolpath path;
  /// First steps of finishing passes: of chains that are to be cut at the full depth (see
  /// StepDownOptions::whole).
  std::vector<std::size_t> whole;
};
/// Nothing, with an error (code pass_option), for options out of range. A program without a closed path, and
/// paths that keep their start, are warnings (pass_refused).
std::optional<Led> add_leads(const Toolpath& path, const LeadOptions& options, Diagnostics& diagnostics);

// The order of cuts: short rapids, and inner contours before those around them.
//
//   const Ordered made = order_cuts(path, {{1, mm(6)}});
//
// What is cut between two motions at the height of the highest rapid is a block. Blocks are put in another
// order within the steps of one tool and one spindle speed. Two blocks whose cuts come as near to each other
// as the tool is wide stay in their order (passes of one contour, a pocket in a pocket); of others, what lies
// inside a closed contour is cut before it.

struct Ordered {
  Toolpath path;
  std::size_t blocks = 0;     ///< that could be ordered
  double rapid_before = 0.0;  ///< mm, of rapids between blocks
  double rapid_after = 0.0;
};
/// `diameters`: of the tools by number; one that is missing counts as 0.
Ordered order_cuts(const Toolpath& path, const std::map<int, Length>& diameters);

// A program from a line on, after an interruption: the state that the lines before have left, a safe
// approach, and the rest of the steps.
//
//   Diagnostics diagnostics;
//   const auto rest = resume_from(path, {.line = 1200, .safe_z = 10}, diagnostics);
//
// The state in force before the line is restored: work offset, tool, its length, path mode, spindle, coolant.
// The tool rises to `safe_z`, rotary axes turn, it moves above where the first motion starts, and is fed down
// to it. Feeds, units and planes need nothing: a toolpath has complete positions, and posts write the words
// that they require. The line is the first one from the given number on that the program gets to. A line with
// a call resumes at the start of the call, a line of a subroutine in the first call of it, with a note; of a
// loop, the first pass is run, with a note.

struct ResumeOptions {
  std::uint32_t line = 0;  ///< of the program's text, from 1
  double safe_z = 0.0;     ///< Z at which rapids across are free
  Feed approach{};         ///< down to the start; 0: that of the first cut
};
struct Resumed {
  Toolpath path;
  std::size_t first = 0;  ///< the first step of the original that is run
};
/// Nothing, with an error: no motion at or after the line, an unknown position before it (code resume_line),
/// or a path that prints or engraves by laser (pass_refused).
std::optional<Resumed> resume_from(const Toolpath& path, const ResumeOptions& options,
                                   Diagnostics& diagnostics);

// Depth per pass for a finished toolpath: each chain of cuts that goes deeper than the stepdown is cut in
// passes.
//
//   Diagnostics diagnostics;
//   const auto deeper = step_down(path, {.top = 0, .stepdown = mm(2)}, diagnostics);
//
// A chain is what is cut between two rapids. Every pass but the last is the chain with all heights below the
// level of the pass raised to that level, so a curved floor is approached in steps; the last is the chain
// itself. With ramps, a chain that starts with a descent at one point goes down back and forth along its
// first level part instead. A chain that ends where it starts continues down there, after another one the
// tool rises to the height of the rapid that led to it. All other steps are kept, with their origins.

struct StepDownOptions {
  double top = 0.0;   ///< Z of the surface of the material
  Length stepdown{};  ///< maximum depth of a pass; the passes of a chain have the same depth. 0: one pass
  /// plunge: as the chain has it; ramp: along its first level part; helix: beside its start, where that
  /// crosses neither the chain nor a closed path, else as ramp.
  EntryKind entry = EntryKind::plunge;
  Angle entry_angle = degrees(3);                ///< maximum descent of a ramp or helix
  Length helix_radius{};                         ///< of the axis; required for a helix
  PartSide part = PartSide::right;               ///< a helix is on the other side of the path
  std::vector<std::size_t> whole{};              ///< first steps of chains that are cut as they are, in order
  std::set<int> undercutting{};                  ///< tools whose chains are cut as they are, with a warning
  Length chord = default_tolerance::kPostChord;  ///< of chords that replace an arc which is raised in part
  std::size_t max_steps = limits::kMaxPathSteps;
};
/// Nothing, with an error, for options out of range (code pass_option), and for a chain with an unknown
/// position, a rotary axis or a probed height (pass_refused).
std::optional<Toolpath> step_down(const Toolpath& path, const StepDownOptions& options,
                                  Diagnostics& diagnostics);

// Transforms of a finished toolpath: moved, turned, mirrored, scaled, and repeated in rows and columns.
//
//   Diagnostics diagnostics;
//   const auto moved = transformed(path, {.mirror = Mirror::x, .rotate = degrees(90), .move = {10, 0, 0}},
//                                  diagnostics);
//   const auto panel = repeated(*moved, {.columns = 3, .rows = 2, .pitch = {30, 25}}, diagnostics);
//
// All steps keep their origins. Arcs stay arcs; those in the planes XZ and YZ become chords where they are
// scaled, or rotated by other angles than quarter turns.

enum class Mirror : std::uint8_t {
  none,
  x,  ///< X changes its sign
  y   ///< Y changes its sign
};
/// In this order, about `centre`: scaled, mirrored, rotated; then moved.
struct PathTransform {
  double scale = 1.0;  ///< of X and Y, > 0; Z and feeds stay
  Mirror mirror = Mirror::none;
  Angle rotate{};  ///< counter-clockwise
  Point3 move{};   ///< mm
  Point2 centre{};
  Length chord = default_tolerance::kPostChord;  ///< of chords that replace arcs in the planes XZ and YZ
};
/// Nothing, with an error: options out of range (code pass_option), or probes, printed beads, rotary axes,
/// positions in machine coordinates, and motions of which X or Y alone is unknown (pass_refused).
std::optional<Toolpath> transformed(const Toolpath& path, const PathTransform& transform,
                                    Diagnostics& diagnostics);

// The position of a workpiece from probed points: a rotation and a shift, without a scale.
//
//   const auto found = alignment_of({.points = {{{0, 0}, {{10.2, 5.1}}}, {{100, 0}, {{110.1, 7.3}}}}},
//   diagnostics); const auto there = transformed(path, found->transform, diagnostics);

/// What was measured of one point of the program.
struct AlignPoint {
  Point2 at;  ///< in the program, mm
  /// One point: its position. Three: points on the wall of a round hole or boss around it, or, of a corner,
  /// two on the edge along X, in this direction, and one on the edge along Y.
  std::vector<Point2> measured;
  bool is_corner = false;  ///< of the part, which lies on the left of its edge along X; the only point
};
struct AlignOptions {
  std::vector<AlignPoint> points{};  ///< none: nothing is changed. One that is not a corner: a shift alone
  Length probe{};                    ///< diameter of the probe or pin that touched the edges of a corner
  Length fits = mm(0.1);             ///< a larger distance of a point from where it belongs is a warning
};
struct Alignment {
  PathTransform transform;  ///< least squares of the distances
  Length farthest;          ///< largest distance of a measured point from where the transform puts it
};
/// Nothing, with an error (code pass_option): points at one position, a hole or edge that its points do not
/// define. A warning (code align_misfit) where the points do not fit each other.
std::optional<Alignment> alignment_of(const AlignOptions& options, Diagnostics& diagnostics);

/// Reverses each closed path on a level, so that climb becomes conventional and the other way round: a
/// mirrored program cuts as the original did. Entries, leads and open paths stay.
Toolpath reversed_loops(const Toolpath& path);

struct Copies {
  int columns = 1, rows = 1;  ///< along X and Y, > 0
  Point2 pitch{};             ///< mm, from one copy to the next
  std::size_t max_steps = limits::kMaxPathSteps;
};
/// All copies are cut with one tool before the next is changed. Between copies the tool is at the height of
/// the highest rapid. Each copy starts in the state that the first motion of the program with this tool finds
/// (work offset, spindle, coolant ...). Errors as above, where the tool is at an unknown position at the end
/// of a copy, where that state cannot be restored, and for a program that counts Z downwards.
std::optional<Toolpath> repeated(const Toolpath& path, const Copies& copies, Diagnostics& diagnostics);

// A flat program around a round bar that turns about X: Y becomes turns of A.
//
//   const auto around = wrapped(path, {.diameter = mm(40)}, diagnostics);
//
// A point at X, Y, Z is cut at X and Z with the bar turned by A = -Y / (pi diameter) * 360 degrees, because
// positive A moves the tool from Z+ towards Y- (ISO 841); Y is 0, above the axis, and Z0 is the surface of
// the bar. Straight cuts stay one motion each, arcs become chords. Feeds are those that move the tool over
// the surface as fast as the flat program does, in mm/min of X and Z, or in degrees/min where the bar turns
// alone.

struct WrapOptions {
  Length diameter{};                             ///< of the bar; 0: the program stays flat
  Length chord = default_tolerance::kPostChord;  ///< of chords that replace arcs
  std::size_t max_steps = limits::kMaxPathSteps;
};
/// Nothing, with an error: a diameter that is not above 0 (code pass_option), or what transformed() refuses,
/// and cuts from or to unknown positions (pass_refused).
std::optional<Toolpath> wrapped(const Toolpath& path, const WrapOptions& options, Diagnostics& diagnostics);

// Programs one after another as one program, with a safe way from the end of each to the start of the next.
//
//   Diagnostics diagnostics;
//   auto path = joined({&pockets, &holes}, diagnostics);
//
// Frame and units as in toolpath.h.

/// Appends the steps of a program to `path`, without the ends of both. Spindle, coolant and laser that `path`
/// has left on are switched off, as its end would. From a known position the tool rises to the height of the
/// program's first known position, or stays higher, and moves across before it goes down. False, with an
/// error (code pass_refused) and `path` as it was, if the program starts with a cut, if either sets work
/// zeros, or for a path with more than limits::kMaxPathSteps steps.
bool append_program(Toolpath& path, const Toolpath& program, Diagnostics& diagnostics);

/// The programs in their order, with one end. Nothing, with an error, as above.
std::optional<Toolpath> joined(const std::vector<const Toolpath*>& programs, Diagnostics& diagnostics);

/// Applied in this order, each where it is given.
struct ReworkOptions {
  ResumeOptions resume{};    ///< line 0: from the start
  LeadOptions leads{};       ///< as `passes` has `top` and `part`; sizes 0: none
  StepDownOptions passes{};  ///< stepdown 0 and plunge: as it is
  TabOptions tabs{};         ///< height 0: none
  bool order = false;
  PathTransform transform{};
  bool reverse_loops = false;  ///< climb becomes conventional and the other way round
  Copies copies{};
  AlignOptions align{};
  WrapOptions wrap{};
};
/// Whether the part is elsewhere afterwards, has another size, or is cut several times: then the stock of the
/// program is not that of the result.
bool moves_part(const ReworkOptions& options);

/// One of the options by name: for command lines and bindings.
struct ReworkKey {
  std::string_view name;     ///< "step-down"
  std::string_view value;    ///< "MM", or empty for one that is given or not
  std::string_view meaning;  ///< one line
  /// Empty, or what it can be instead: "a whole number from 1 to 1000".
  std::string (*set)(ReworkOptions& options, const CutValue& value) = nullptr;
  std::string_view needs = {};  ///< another option without which it has no effect
};
const std::vector<ReworkKey>& rework_keys();
/// Empty, or why it is not set: that there is no such key, or what its value can be. Numbers may be texts, as
/// the command line has them.
std::string set_rework(ReworkOptions& options, std::string_view name, const CutValue& value);

struct Reworked {
  Toolpath path;
  std::optional<Ordered> ordered;      ///< without its path; if requested
  std::optional<Alignment> alignment;  ///< if requested
};
/// `tools`: by number, those that are known. Nothing, with an error, where one of the changes is not
/// possible.
std::optional<Reworked> rework(Toolpath path, const std::map<int, Tool>& tools, const ReworkOptions& options,
                               Diagnostics& diagnostics);

}  // namespace kerf

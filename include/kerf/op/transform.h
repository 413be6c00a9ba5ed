// Transforms of a finished toolpath: moved, turned, mirrored, scaled, and repeated in rows and columns.
//
//   Diagnostics diagnostics;
//   const auto moved = transformed(path, {.mirror = Mirror::x, .rotate = degrees(90), .move = {10, 0, 0}},
//                                  diagnostics);
//   const auto panel = repeated(*moved, {.columns = 3, .rows = 2, .pitch = {30, 25}}, diagnostics);
//
// All steps keep their origins. Arcs stay arcs; those in the planes XZ and YZ become chords where they are
// scaled, or rotated by other angles than quarter turns.
#pragma once

#include <cstddef>
#include <optional>

#include "kerf/diagnostics.h"
#include "kerf/geometry.h"
#include "kerf/limits.h"
#include "kerf/tolerance.h"
#include "kerf/toolpath.h"
#include "kerf/units.h"

namespace kerf {

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

/// Reverses each closed path on a level, so that climb becomes conventional and the other way round: a
/// mirrored program cuts as the original did. Entries, leads and open paths stay.
Toolpath reversed_loops(const Toolpath& path);

struct Copies {
  int columns = 1, rows = 1;  ///< along X and Y, > 0
  Point2 pitch{};             ///< mm, from one copy to the next
  std::size_t max_steps = limits::kMaxPathSteps;
};
/// All copies are cut with one tool before the next is changed. Between copies the tool is at the height of
/// the highest rapid. Each copy starts in the state (kerf/path/state.h) that the first motion of the program
/// with this tool finds. Errors as above, where the tool is at an unknown position at the end of a copy, where
/// that state cannot be restored, and for a program that counts Z downwards.
std::optional<Toolpath> repeated(const Toolpath& path, const Copies& copies, Diagnostics& diagnostics);

}  // namespace kerf

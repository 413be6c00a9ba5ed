// What is dangerous or wrong in a toolpath by itself, before any material is thought of: cuts without a feed,
// a tool or a turning spindle, arcs whose ends do not lie on one circle, programs cut off before their end.
// With the machine, the tools, the stock or the material told also: moves outside the travel, speeds that the
// spindle does not have, plunges with tools that cannot, tool changes too low, feeds that break teeth.
//
// What a toolpath does to material (rapids through the stock, shank and holder contact) is simulate.h's
// matter; `kerf check` shows both.
//
//   std::vector<PathHazard> found = check_path(path, {});
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/geometry.h"
#include "kerf/machine.h"
#include "kerf/material.h"
#include "kerf/tolerance.h"
#include "kerf/tool.h"
#include "kerf/toolpath.h"
#include "kerf/units.h"

namespace kerf {

/// What the front end knows of a program's end. Toolpaths made by calls have none and need none.
enum class ProgramEnd : std::uint8_t { not_asked, seen, missing };

struct CheckOptions {
  ArcMismatch arc_radii = {};
  ProgramEnd end = ProgramEnd::not_asked;
  // What is not told (nullptr, nothing) is not looked at. They must outlive the check.
  const Machine* machine = nullptr;          // travel and spindle
  const ToolTable* tools = nullptr;          // plunges and chip loads
  const Material* material = nullptr;        // chip loads
  std::optional<Box3> stock = std::nullopt;  // tool changes; plunges only below its top
};

/// Something wrong from step `step` on. Neighbouring motions with the same trouble are one entry.
struct PathHazard {
  Code code{};              // a 5xxx code; its name is the hazard's kind
  std::uint32_t step = 0;   // index in the toolpath of the first motion concerned
  std::uint32_t steps = 1;  // motions concerned, this one and those after it
  Point3 at;                // mm, where the first motion concerned ends
  std::string message;
  std::string hint = {};  // what to do about it; may be empty
};

/// "no_feed", "negative_feed", "no_tool", "arc_radii", "spindle_off", "no_program_end" ...
std::string_view kind_of(const PathHazard& hazard);

/// The hazard of a program written for machines whose Z counts downwards: every rapid on the way from place
/// to place runs at or below the lowest cut, where Z upwards has the stock. Of the material nothing can be
/// told then. Nothing for other programs; check_path includes it.
std::optional<PathHazard> find_z_downwards(const Toolpath& path);

/// Looks through a whole toolpath; what it finds is in the order of steps. Neither spindle nor tool is
/// asked for in programs that switch a laser or lay down beads. A spindle that turns at 0 rpm is one whose
/// speed is set by hand: the reader of G-code makes an S0 a spindle that is off.
std::vector<PathHazard> check_path(const Toolpath& path, const CheckOptions& options);

}  // namespace kerf

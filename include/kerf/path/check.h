// Hazards of a toolpath that do not depend on the material removed: cuts without a feed, a tool or a running
// spindle, arcs with different radii at their ends, truncated programs. With a machine, tools, a stock or a
// material also: motions outside the travel, spindle speeds out of range, plunges with tools that cannot
// plunge, tool changes below the stock's top, excessive chip loads. Of a laser: a beam that is on during a
// rapid, while X and Y do not move, or at the end.
//
// Hazards in the material (rapids through the stock, shank and holder contact) are found by simulate.h;
// `kerf check` reports both.
//
//   std::vector<PathHazard> found = check_path(path, {});
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/path/machine.h"
#include "kerf/path/toolpath.h"
#include "kerf/tool/material.h"
#include "kerf/tool/tool.h"

namespace kerf {

/// Whether the front end saw the end of the program. Toolpaths made by calls need none.
enum class ProgramEnd : std::uint8_t { not_asked, seen, missing };

struct CheckOptions {
  ArcMismatch arc_radii = {};
  ProgramEnd end = ProgramEnd::not_asked;
  bool manual_spindle = false;  // a program without spindle steps is run with a spindle started by hand
  // Without them (nullptr, nothing) the related checks are skipped. They must outlive the check.
  const Machine* machine = nullptr;          // travel, spindle, laser mode
  const ToolTable* tools = nullptr;          // plunges and chip loads
  const Material* material = nullptr;        // chip loads
  std::optional<Box3> stock = std::nullopt;  // tool changes; plunges only into it
};

/// A hazard from step `step` on. Consecutive motions with the same hazard are one entry.
struct PathHazard {
  Code code{};              // a 5xxx code; its name is the hazard's kind
  std::uint32_t step = 0;   // index in the toolpath of the first motion concerned
  std::uint32_t steps = 1;  // motions concerned, this one and those after it
  Point3 at;                // mm, where the first motion concerned ends
  std::string message;
  std::string hint = {};  // the remedy; may be empty
};

/// "no_feed", "negative_feed", "no_tool", "arc_radii", "spindle_off", "no_program_end" ...
std::string_view kind_of(const PathHazard& hazard);

/// The hazard of a program written for machines whose Z counts downwards: every rapid between
/// positions runs at or below the lowest cut, inside the stock if Z counted upwards. The material cannot be
/// checked then. Nothing for other programs; check_path includes it.
std::optional<PathHazard> find_z_downwards(const Toolpath& path);

/// Checks a whole toolpath; hazards are in the order of steps. Programs that switch a laser or lay beads need
/// neither spindle nor tool. A spindle running at 0 rpm has a manually set speed: the G-code reader turns S0
/// into a stopped spindle. Without a machine the beam of a laser (step::LaserPower) counts as on during
/// rapids and dwells with LaserMode::constant, and as off with LaserMode::dynamic. With one,
/// LaserDrive::follows is GRBL's laser mode, which runs no beam during rapids, and with LaserDrive::stops
/// both modes do.
std::vector<PathHazard> check_path(const Toolpath& path, const CheckOptions& options);

}  // namespace kerf

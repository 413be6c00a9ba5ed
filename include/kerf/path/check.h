// Checks of a toolpath, and of a print against the limits of its printer.
//
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

// The steps of a print against the limits of a printer: cold extrusion, flow, the bed, retractions.
//
//   for (const PrintFault& fault : check_print(path, {.max_flow = mm3_per_s(15)})) ...
//
// Positions that are unknown are not compared with the bed, and a nozzle whose temperature the program never
// sets is not called cold, nor one after a macro of the printer.

using VolumeFlow = Quantity<3, -1>;
constexpr VolumeFlow mm3_per_s(double v) { return VolumeFlow::raw(60.0 * v); }
constexpr double in_mm3_per_s(VolumeFlow v) { return v.raw() / 60.0; }

struct PrinterLimits {
  double min_celsius = 170.0;    // of a nozzle that extrudes; Marlin's and Klipper's default
  VolumeFlow max_flow{};         // of the hot end; 0: not checked
  std::optional<Box3> bed = {};  // mm, where the nozzle may be; sides that are infinite are not checked
};

enum class PrintFaultKind : std::uint8_t {
  cold_extrusion,       // filament extruded below PrinterLimits::min_celsius, or without waiting for it
  flow_high,            // more volume per time than the hot end melts
  outside_bed,          // a motion that ends or passes outside of the bed
  retracted_twice,      // filament drawn back where it is drawn back already
  extruded_drawn_back,  // a bead that starts with the filament drawn back, so that its start is missing
};
inline constexpr std::size_t kPrintFaultKinds = 5;
std::string_view to_string(PrintFaultKind kind);

/// Consecutive motions with the same fault are one entry.
struct PrintFault {
  PrintFaultKind kind{};
  std::uint32_t step = 0;  // the first motion
  std::size_t steps = 1;
  Point3 at;           // mm, where the worst motion of the entry ends
  double value = 0.0;  // of the worst: C; mm3/s; mm outside of the bed; mm3 drawn back in all; mm3 missing
};

/// In the order of steps.
std::vector<PrintFault> check_print(const Toolpath& path, const PrinterLimits& limits);

/// The volume that motion `i`, which starts at `from`, extrudes per time at its programmed feed; 0 for others
/// and for extrusion without a motion.
VolumeFlow flow_of(const Toolpath& path, std::size_t i, Point3 from);

}  // namespace kerf

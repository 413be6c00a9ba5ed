// The steps of a print against the limits of a printer: cold extrusion, flow, the bed, retractions.
//
//   for (const PrintFault& fault : check_print(path, {.max_flow = mm3_per_s(15)})) ...
//
// Positions that are unknown are not compared with the bed, and a nozzle whose temperature the program never
// sets is not called cold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/path/toolpath.h"

namespace kerf {

using VolumeFlow = Quantity<3, -1>;
constexpr VolumeFlow mm3_per_s(double v) { return VolumeFlow::raw(60.0 * v); }
constexpr double in_mm3_per_s(VolumeFlow v) { return v.raw() / 60.0; }

struct PrinterLimits {
  double min_celsius = 170.0;    // of a nozzle that extrudes; Marlin's and Klipper's default
  VolumeFlow max_flow{};         // of the hot end; 0: not checked
  std::optional<Box3> bed = {};  // mm, where the nozzle may be; sides that are infinite are not checked
};

enum class PrintFaultKind : std::uint8_t {
  cold_extrusion,       // filament extruded below PrinterLimits::min_celsius
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

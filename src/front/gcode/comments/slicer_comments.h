// What slicers tell in remarks: how wide and how high the next roads are, how thick the filament is.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace kerf::gcode {

enum class BeadMeasure : std::uint8_t { width, height };
struct BeadRemark {
  BeadMeasure measure{};
  double mm = 0.0;
};
/// "HEIGHT:0.2" and "WIDTH:0.45" (PrusaSlicer, SuperSlicer, OrcaSlicer), "LAYER_HEIGHT: 0.2" and "LINE_WIDTH:
/// 0.42" (Bambu Studio); they hold until the next one.
std::optional<BeadRemark> read_bead_remark(std::string_view text);

/// The diameter in mm that the settings at a program's begin or end tell, of the first extruder:
/// "filament_diameter = 1.75" (Slic3r and its kin), "filamentDiameters,1.75" (Simplify3D), "Filament Diameter
/// #1: 1.75" (ideaMaker).
std::optional<double> told_filament_diameter(std::string_view text);

}  // namespace kerf::gcode

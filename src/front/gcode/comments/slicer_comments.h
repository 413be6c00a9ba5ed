// Comments of slicers: kind, width and height of the beads that follow, diameter of the filament.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "kerf/path/toolpath.h"

namespace kerf::gcode {

enum class BeadMeasure : std::uint8_t { width, height };
struct BeadSize {
  BeadMeasure measure{};
  double mm = 0.0;
};
/// "HEIGHT:0.2" and "WIDTH:0.45" (PrusaSlicer, SuperSlicer, OrcaSlicer), "LAYER_HEIGHT: 0.2" and "LINE_WIDTH:
/// 0.42" (Bambu Studio); in force until the next one. 0: unknown from here on.
std::optional<BeadSize> read_bead_size(std::string_view text);

/// "TYPE:External perimeter" (PrusaSlicer, SuperSlicer), "TYPE:Outer wall" (OrcaSlicer), "FEATURE: Outer
/// wall" (Bambu Studio), "TYPE:WALL-OUTER" (Cura); nothing for other comments and BeadKind::custom for other
/// names.
std::optional<BeadKind> read_bead_kind(std::string_view text);

/// The filament diameter in mm of the first extruder, from the settings at the start or end of a program:
/// "filament_diameter = 1.75" (Slic3r and its derivatives), "filamentDiameters,1.75" (Simplify3D), "Filament
/// Diameter #1: 1.75" (ideaMaker).
std::optional<double> find_filament_diameter(std::string_view text);
/// Whether the settings say that E words are volumes: "use_volumetric_e = 1" (Slic3r and its derivatives).
bool find_volumetric(std::string_view text);
/// The density of the filament in g/cm3, likewise: "filament_density = 1.24".
std::optional<double> find_filament_density(std::string_view text);

}  // namespace kerf::gcode

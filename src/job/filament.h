// The filament that a print needs: its length, volume and mass.
//
//   const Filament filament = filament_of(program, figures_of_print(program.path, {}).extruded, {});
//   filament.grams();
#pragma once

#include <optional>

#include "kerf/base/units.h"
#include "kerf/job/program.h"

namespace kerf {

struct Filament {
  double diameter = 0.0;         // mm
  double density = 0.0;          // g/cm3
  bool density_assumed = false;  // that of PLA
  double length = 0.0;           // mm
  double volume = 0.0;           // mm3

  double grams() const;
};

/// Diameter and density (g/cm3) are those given or of the program's comments, else 1.75 mm, and PLA.
Filament filament_of(const Program& program, Volume extruded, std::optional<double> density);

}  // namespace kerf

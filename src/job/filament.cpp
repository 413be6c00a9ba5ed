// The filament that a print needs.
#include "job/filament.h"

#include <numbers>

namespace kerf {
namespace {

constexpr double kPla = 1.24;              // g/cm3
constexpr double kDefaultFilament = 1.75;  // mm
constexpr double kMm3PerCm3 = 1000.0;

}  // namespace

double Filament::grams() const { return density * volume / kMm3PerCm3; }

Filament filament_of(const Program& program, Volume extruded, std::optional<double> density) {
  Filament f;
  f.diameter = program.filament_diameter.value_or(kDefaultFilament);
  f.density_assumed = !density && !program.filament_density;
  f.density = density ? *density : program.filament_density.value_or(kPla);
  f.volume = extruded.mm3();
  f.length = f.volume / (std::numbers::pi / 4.0 * f.diameter * f.diameter);
  return f;
}

}  // namespace kerf

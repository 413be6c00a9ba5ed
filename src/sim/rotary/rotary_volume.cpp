// The volume that the mesh of a rotary workpiece should have, computed from its rays.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/mesh/column_faces.h"

#include "kerf/sim/rotary.h"

namespace kerf {

VolumeRange mesh_volume(const RotaryWorkpiece& work) {
  using meshing::Runs, meshing::unshared;
  const double turn = 2.0 * std::numbers::pi / work.around, radius = 0.5 * work.bar.diameter;
  const auto sector = [turn](float low, float high) {
    return 0.5 * turn * (static_cast<double>(high) * high - static_cast<double>(low) * low);
  };
  const auto ray = [&work](int i, int j) -> Runs {
    return work.rays[static_cast<std::size_t>(j) * static_cast<std::size_t>(work.along) +
                     static_cast<std::size_t>(i)];
  };
  meshing::Faces faces;
  for (int j = 0; j < work.around; ++j) {
    for (int i = 0; i < work.along; ++i) {
      const Runs runs = ray(i, j);
      for (const Interval& run : runs) {
        faces.volume += work.dx * sector(run.low, run.high);
        faces.ends += work.dx * turn * (static_cast<double>(run.low) + static_cast<double>(run.high));
      }
      if (i + 1 < work.along) faces.sides += unshared(runs, ray(i + 1, j), sector);
      faces.sides += work.dx * unshared(runs, ray(i, (j + 1) % work.around), meshing::height);
    }
  }
  const double farthest = std::max({std::abs(work.bar.x_low), std::abs(work.bar.x_high),
                                    std::abs(work.bar.axis_y) + radius, std::abs(work.bar.axis_z) + radius});
  // Between two rays the surface is flat: a chord instead of an arc.
  const double sagitta = radius * turn * turn / 4.0;
  return meshing::volume_range(faces, std::max(work.dx, radius * turn),
                               sagitta + meshing::rounding(farthest));
}

}  // namespace kerf

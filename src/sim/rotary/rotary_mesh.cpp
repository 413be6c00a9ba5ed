// The surface of a rotary workpiece: the rays are unrolled into columns, these are meshed, and the mesh is
// rolled up.
#include <cmath>
#include <numbers>
#include <utility>

#include "kerf/rotary.h"

namespace kerf {
namespace {

/// The rays as columns whose heights are distances from the axis. Every run end gets a unique number as its
/// step, so that no level faces are merged, which would be flat after rolling up; `steps` has the step of
/// each number.
ColumnGrid unroll(const RotaryWorkpiece& work, std::vector<std::uint32_t>& steps) {
  ColumnGrid grid;
  grid.pitch = 1.0;
  grid.nx = work.along;
  grid.ny = work.around;
  const double radius = 0.5 * work.bar.diameter;
  grid.bounds.add(Point3{0, 0, 0});
  grid.bounds.add(
      Point3{static_cast<double>(work.along), static_cast<double>(work.around), radius / work.dx});
  const auto height = [&work](float r) { return static_cast<float>(static_cast<double>(r) / work.dx); };
  for (const std::vector<Interval>& ray : work.rays) {
    grid.first.push_back(static_cast<std::uint32_t>(grid.intervals.size()));
    for (const Interval& run : ray) {
      const auto number = static_cast<std::uint32_t>(steps.size());
      steps.push_back(run.low_step);
      steps.push_back(run.high_step);
      grid.intervals.push_back({height(run.low), height(run.high), number, number + 1});
    }
  }
  grid.first.push_back(static_cast<std::uint32_t>(grid.intervals.size()));
  return grid;
}

}  // namespace

Mesh extract_mesh(const RotaryWorkpiece& work, Progress* progress) {
  std::vector<std::uint32_t> steps;
  Mesh mesh = extract_mesh(unroll(work, steps), progress);
  for (std::size_t v = 0; v + 2 < mesh.positions.size(); v += 3) {
    float* const p = mesh.positions.data() + v;
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(p[1]) / work.around;
    const double r = static_cast<double>(p[2]) * work.dx;
    p[0] = static_cast<float>(work.bar.x_low + static_cast<double>(p[0]) * work.dx);
    p[1] = static_cast<float>(work.bar.axis_y - r * std::sin(angle));
    p[2] = static_cast<float>(work.bar.axis_z + r * std::cos(angle));
  }
  // (along, around, outwards) is a left-handed frame, so triangles are inverted.
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3)
    std::swap(mesh.triangles[t + 1], mesh.triangles[t + 2]);
  for (std::uint32_t& step : mesh.step)
    if (step < steps.size()) step = steps[step];
  return mesh;
}

}  // namespace kerf

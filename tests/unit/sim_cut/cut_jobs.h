// Cuts the toolpaths of path/jobs.h.
#pragma once

#include <random>

#include "../path/jobs.h"

#include "kerf/simulate.h"

namespace kerf::test {

inline ToolTable square_and_keyhole() {
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 12, 0}})));
  tools.set(2, make_drawn(2, profile({{0, 0, 0}, {4, 0, 0}, {4, 2.5, 0}, {2, 2.5, 0}, {2, 9, 0}})));
  tools.set(3, make_drawn(3, profile({{0, 0, kQuarter}, {2, 2, 0}, {2, 12, 0}})));
  return tools;
}

/// Moves of all kinds with three tools all over a block of 50 x 40 x 10 whose top is Z0.
inline Toolpath random_job(unsigned seed, int moves) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() % 100000) / 1e5;
  };
  Path path;
  Point3 at{0, 0, 5};
  path.tool(1).rapid(at);
  for (int k = 0; k < moves; ++k) {
    if (k % 40 == 0) path.tool(1 + (k / 40) % 3);
    const Point3 to{between(-3, 53), between(-3, 43), between(-9, 1)};
    if (k % 7 == 3) {
      path.arc({.to = {to.x, to.y, at.z},
                .centre = {0.5 * (at.x + to.x), 0.5 * (at.y + to.y)},
                .turn = k % 2 == 0 ? Turn::cw : Turn::ccw,
                .feed = mm_per_min(100)});
      at = {to.x, to.y, at.z};
      continue;
    }
    if (k % 11 == 5) {
      path.rapid(to);
    } else {
      path.cut(to);
    }
    at = to;
  }
  return path.path();
}

inline std::optional<Simulation> run(const Toolpath& path, const ToolTable& tools, const Stock& stock,
                                     double pitch, Diagnostics& diagnostics, unsigned threads = 1) {
  SimulationOptions options;
  options.resolution = mm(pitch);
  options.threads = threads;
  return simulate(path, tools, stock, options, diagnostics);
}

}  // namespace kerf::test

// Speed of the simulator: synthetic jobs, motions per second, and times of other programs for the same jobs.
//
// peak_MB is the memory that a job needs in addition to its toolpath. The other programs were measured on the
// same kind of machine (two cores) with the same jobs; counters show their processor time for the whole job,
// s, at the resolution in their name.
#include <algorithm>
#include <benchmark/benchmark.h>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "memory.h"

#include "kerf/sim/exact_mesh.h"
#include "kerf/sim/live.h"
#include "kerf/sim/simulate.h"

namespace kerf {
namespace {

constexpr double kQuarter = 0.41421356237309503;  // bulge of a quarter circle

Stock block() {
  Stock stock;
  stock.block.add(Point3{0, 0, -8.35});
  stock.block.add(Point3{220, 150, 0});
  return stock;
}

ToolTable table() {
  const auto tool = [](int number, std::vector<Knot> knots, double radius, double flute) {
    Tool t;
    t.number = number;
    t.silhouette.cutting.knots = std::move(knots);
    t.silhouette.shank.knots = {{radius, flute, 0}, {radius, flute + 25, 0}};
    return t;
  };
  ToolTable tools;
  tools.set(1, tool(1, {{0, 0, kQuarter}, {1.5875, 1.5875, 0}, {1.5875, 12.7, 0}}, 1.5875, 12.7));
  tools.set(2, tool(2, {{0, 0, 0}, {4.7625, 0, 0}, {4.7625, 3.175, 0}, {3.175, 3.175, 0}, {3.175, 9.5, 0}},
                    3.175, 9.5));
  tools.set(3, tool(3, {{0, 0, 0}, {3.175, 0, 0}, {3.175, 19, 0}}, 3.175, 19));
  return tools;
}

/// A toolpath with a tool and the spindle on.
struct Job {
  explicit Job(int tool) : here(path.origins().add(CallLocation{.file = "", .line = 0, .call = "bench"})) {
    path.add(step::ToolChange{tool}, here);
    path.add(step::Spindle{rpm(16000), SpindleTurn::cw}, here);
    path.add(step::Rapid{{0, 0, 5}}, here);
  }
  void cut(Point3 to) { path.add(step::Cut{to, mm_per_min(1000)}, here); }
  void rapid(Point3 to) { path.add(step::Rapid{to}, here); }
  Toolpath path;
  OriginId here;
};

/// Rows of a ball over a wavy surface between 0.3 and 6 mm deep.
Toolpath relief(int rows, int segments) {
  Job job(1);
  for (int r = 0; r < rows; ++r) {
    const double y = 150.0 * (r + 0.5) / rows;
    for (int s = 0; s <= segments; ++s) {
      const double x = 220.0 * (r % 2 == 0 ? s : segments - s) / segments;
      const double z = -3.15 + 1.4 * std::sin(0.11 * x + 0.3) * std::cos(0.09 * y) +
                       0.9 * std::sin(0.31 * x + 0.17 * y) + 0.55 * std::sin(0.53 * y - 0.23 * x);
      job.cut({x, y, z});
    }
  }
  return std::move(job.path);
}

/// A keyhole bit along 12 wavy slots, 6 mm deep.
Toolpath keyhole_slots(int moves) {
  Job job(2);
  const int each = moves / 12;
  for (int slot = 0; slot < 12; ++slot) {
    const double y = 12.5 * slot + 6;
    job.rapid({-10, y, 5});
    for (int s = 0; s <= each; ++s) {
      const double x = -10 + 240.0 * s / each;
      job.cut({x, y + 2 * std::sin(0.2 * x), -6});
    }
    job.cut({240, y, -6});
    job.rapid({240, y, 5});
  }
  return std::move(job.path);
}

Toolpath random_moves(int moves) {
  Job job(1);
  std::mt19937 random(7);
  const auto fraction = [&] { return static_cast<double>(random() % 1000000) * 1e-6; };
  Point3 at{110, 75, 0};
  for (int k = 0; k < moves; ++k) {
    at = {std::clamp(at.x + 20 * fraction() - 10, 0.0, 220.0),
          std::clamp(at.y + 20 * fraction() - 10, 0.0, 150.0), -6 * fraction()};
    job.cut(at);
  }
  return std::move(job.path);
}

Toolpath roughing() {
  Job job(3);
  for (int level = 1; level <= 4; ++level) {
    for (int row = 0; row <= 59; ++row) {
      const double y = 150.0 * row / 59, left = -5, right = 225;
      job.cut({row % 2 == 0 ? left : right, y, -1.5 * level});
      job.cut({row % 2 == 0 ? right : left, y, -1.5 * level});
    }
  }
  return std::move(job.path);
}

void run(benchmark::State& state, const Toolpath& path) {
  const ToolTable tools = table();
  SimulationOptions options;
  options.resolution = mm(1e-3 * static_cast<double>(state.range(0)));
  options.threads = static_cast<unsigned>(state.range(1));
  double removed = 0.0;
  const PeakMemory memory;
  for (auto _ : state) {
    Diagnostics diagnostics;
    const auto result = simulate({borrowed(path), tools, block(), options}, diagnostics);
    if (!result) return state.SkipWithError("not simulated");
    removed = result->removed.mm3();
  }
  state.counters["moves/s"] =
      benchmark::Counter(static_cast<double>(path.size() * state.iterations()), benchmark::Counter::kIsRate);
  state.counters["removed_mm3"] = removed;
  state.counters["peak_MB"] = memory.mb();
}

void Relief1M(benchmark::State& state) {
  static const Toolpath path = relief(1000, 1000);
  run(state, path);
  state.counters["CAMotics_1mm_cpu_s"] = 52.1;
  state.counters["CAMotics_0.5mm_cpu_s"] = 147.9;
  state.counters["prototype_0.1mm_s"] = 0.22;
  state.counters["prototype_0.05mm_s"] = 0.56;
}
void Relief10k(benchmark::State& state) {
  static const Toolpath path = relief(100, 100);
  run(state, path);
  state.counters["Manifold_s"] = 50.6;
  state.counters["prototype_0.1mm_s"] = 0.017;
}
void Keyhole100k(benchmark::State& state) {
  static const Toolpath path = keyhole_slots(100000);
  run(state, path);
  state.counters["prototype_0.1mm_s"] = 0.165;
  state.counters["prototype_0.05mm_s"] = 0.36;
}
void Random100k(benchmark::State& state) {
  static const Toolpath path = random_moves(100000);
  run(state, path);
}
void Roughing(benchmark::State& state) {
  static const Toolpath path = roughing();
  run(state, path);
}

/// A job cut before its mesh is made, merged within a tolerance, all steps of one colour.
struct CutJob {
  CutJob(const benchmark::State& state, Toolpath job, Length tolerance) : path(std::move(job)) {
    SimulationOptions options;
    options.resolution = mm(1e-3 * static_cast<double>(state.range(0)));
    result = simulate({borrowed(path), table(), block(), options}, diagnostics);
    if (result) columns.emplace(result->workpiece);
    one_group.assign(path.size(), 0);
    merged = {.tolerance = tolerance, .step_groups = one_group};
  }
  CutJob(const CutJob&) = delete;

  Toolpath path;
  Diagnostics diagnostics;
  std::optional<Simulation> result;
  std::optional<MeshColumns> columns;
  std::vector<std::uint8_t> one_group;
  MeshOptions merged;
};

/// The closed mesh of the relief, merged within 5 microns.
void ReliefMesh(benchmark::State& state) {
  const CutJob job(state, relief(1000, 1000), mm(0.005));
  if (!job.result) return state.SkipWithError("not simulated");
  std::size_t triangles = 0;
  const PeakMemory memory;
  for (auto _ : state) triangles = extract_mesh(MeshColumns(job.result->workpiece), job.merged).step.size();
  state.counters["triangles"] = static_cast<double>(triangles);
  state.counters["peak_MB"] = memory.mb();
  state.counters["prototype_top_only_s"] = 0.1;
}

/// Verification of that mesh, as before every export.
void ReliefMeshVerified(benchmark::State& state) {
  CutJob job(state, relief(1000, 1000), mm(0.005));
  if (!job.result) return state.SkipWithError("not simulated");
  const Mesh mesh = extract_mesh(*job.columns, job.merged);
  for (auto _ : state)
    if (!verify_mesh(mesh, mesh_volume(*job.columns, job.merged), job.diagnostics))
      return state.SkipWithError("the mesh is not valid");
  state.counters["triangles"] = static_cast<double>(mesh.step.size());
}

/// An exact mesh within 2 microns of the sweeps: extraction and fitting.
void exact_mesh(benchmark::State& state, Toolpath path) {
  const CutJob job(state, std::move(path), mm(0.002));
  if (!job.result) return state.SkipWithError("not simulated");
  std::size_t triangles = 0;
  for (auto _ : state) {
    Mesh mesh = extract_mesh(*job.columns, job.merged);
    make_mesh_exact(mesh, *job.result);
    triangles = mesh.step.size();
  }
  state.counters["triangles"] = static_cast<double>(triangles);
}
void ReliefExactMesh(benchmark::State& state) { exact_mesh(state, relief(1000, 1000)); }
void KeyholeExactMesh(benchmark::State& state) { exact_mesh(state, keyhole_slots(100000)); }

/// The million motions with one of them lowered, after the original was cut.
void LiveEdit(benchmark::State& state) {
  LiveOptions options;
  options.simulation.resolution = mm(1e-3 * static_cast<double>(state.range(0)));
  LiveSimulation live(table(), block(), options);
  const Toolpath path = relief(1000, 1000);
  Diagnostics diagnostics;
  if (!live.update(path, diagnostics)) return state.SkipWithError("not simulated");
  double depth = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    Toolpath edited = path;
    Point3 lower = path[path.size() / 2].to();
    lower.z -= depth += 0.001;
    edited.set_end(path.size() / 2, lower);
    state.ResumeTiming();
    if (!live.update(std::move(edited), diagnostics)) return state.SkipWithError("not simulated");
  }
}
/// The workpiece at an instant of the million motions, a different one each time.
void LiveInstant(benchmark::State& state) {
  LiveOptions options;
  options.simulation.resolution = mm(1e-3 * static_cast<double>(state.range(0)));
  LiveSimulation live(table(), block(), options);
  Diagnostics diagnostics;
  if (!live.update(relief(1000, 1000), diagnostics)) return state.SkipWithError("not simulated");
  const std::size_t steps = live.path().size();
  std::size_t at = 0;
  for (auto _ : state) {
    at = (at + steps / 7 * 3 + 1) % steps;
    benchmark::DoNotOptimize(live.at(at));
  }
}

// Resolution in microns, threads.
BENCHMARK(Relief1M)
    ->Args({100, 1})
    ->Args({100, 2})
    ->Args({50, 2})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Relief10k)->Args({100, 2})->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(Keyhole100k)
    ->Args({100, 2})
    ->Args({50, 2})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Random100k)->Args({100, 2})->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(Roughing)->Args({100, 2})->Args({50, 2})->MeasureProcessCPUTime()->UseRealTime()->Unit(
    benchmark::kMillisecond);
BENCHMARK(ReliefExactMesh)
    ->Args({100})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(KeyholeExactMesh)
    ->Args({100})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(ReliefMesh)->Args({100})->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(ReliefMeshVerified)
    ->Args({100})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

BENCHMARK(LiveEdit)->Args({100})->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(LiveInstant)->Args({100})->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kerf

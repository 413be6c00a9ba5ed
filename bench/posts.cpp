// Writing a million steps as G-code, straight cuts and arcs, and checking the output.
#include <benchmark/benchmark.h>
#include <cmath>
#include <cstdint>

#include "kerf/program/post.h"

namespace {

using namespace kerf;

Toolpath relief(std::int64_t steps) {
  Toolpath path;
  for (std::int64_t i = 0; i < steps; ++i) {
    const double x = 0.137 * static_cast<double>(i % 1000), y = 0.1 * static_cast<double>(i / 1000);
    path.add(step::Cut{{x, y, std::sin(0.05 * x) * std::cos(0.07 * y)}, mm_per_min(1500)}, OriginId::none);
  }
  return path;
}

Toolpath rings(std::int64_t steps) {
  Toolpath path;
  for (std::int64_t i = 0; i < steps; ++i) {
    const double x = static_cast<double>(i + 1);
    const Turn turn = i % 2 == 0 ? Turn::cw : Turn::ccw;
    path.add(step::Arc{.to = {1e-3 * x, 0, 0},
                       .centre = {1e-3 * x - 0.5e-3, 1.0},
                       .turn = turn,
                       .feed = mm_per_min(900)},
             OriginId::none);
  }
  return path;
}

Toolpath beads(std::int64_t steps) {
  Toolpath path;
  for (std::int64_t i = 0; i < steps; ++i) {
    const double x = 0.137 * static_cast<double>(i % 1000), y = 0.45 * static_cast<double>(i / 1000 % 200);
    const double z = 0.2 * static_cast<double>(1 + i / 200'000);
    path.add(step::Extrude{{x, y, z}, mm3(0.0113), mm(0.45), mm(0.2), mm_per_min(3000), BeadKind::infill},
             OriginId::none);
  }
  return path;
}

void write(benchmark::State& state, const Toolpath& path, const char* name = "grbl") {
  for (auto _ : state) {
    Diagnostics diagnostics;
    benchmark::DoNotOptimize(post(path, *find_post(name), {}, diagnostics).size());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(path.size()));
}

void write_cuts(benchmark::State& state) { write(state, relief(state.range(0))); }
BENCHMARK(write_cuts)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void write_arcs(benchmark::State& state) { write(state, rings(state.range(0))); }
BENCHMARK(write_arcs)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void write_beads(benchmark::State& state, const char* name) { write(state, beads(state.range(0)), name); }
BENCHMARK_CAPTURE(write_beads, marlin, "marlin")->Arg(1'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_beads, klipper, "klipper")->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void lint(benchmark::State& state) {
  Diagnostics diagnostics;
  const auto files = post(relief(state.range(0)), *find_post("grbl"), {}, diagnostics);
  for (auto _ : state)
    benchmark::DoNotOptimize(lint_gcode(files[0].text, *find_post("grbl"), "", diagnostics));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(lint)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace

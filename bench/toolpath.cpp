// The toolpath in memory: making a million steps with their origins, and iterating over them.
#include "kerf/path/toolpath.h"

#include <benchmark/benchmark.h>
#include <cstdint>

namespace {

using namespace kerf;

Toolpath relief(std::int64_t steps) {
  Toolpath path;
  const std::uint32_t file = path.origins().file("relief.nc");
  for (std::int64_t i = 0; i < steps; ++i) {
    const double x = 0.1 * static_cast<double>(i % 1000);
    const double y = 0.1 * static_cast<double>(i / 1000);
    const OriginId line = path.origins().text(file, static_cast<std::uint32_t>(i + 1), 0);
    path.add(step::Cut{{x, y, -1.0}, mm_per_min(1500)}, line);
  }
  return path;
}

void make_steps(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(relief(state.range(0)).size());
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(make_steps)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void walk_steps(benchmark::State& state) {
  const Toolpath path = relief(state.range(0));
  for (auto _ : state) {
    double length_mm = 0.0;
    for_each_motion(path,
                    [&](const Step& s, const MotionContext& at) { length_mm += distance(at.from, s.to()); });
    benchmark::DoNotOptimize(length_mm);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(walk_steps)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace

// Simulating a print: a square of infill in layers, each perpendicular to the one below.
#include "kerf/sim/print.h"

#include <benchmark/benchmark.h>

#include "path/bead.h"

namespace kerf {
namespace {

constexpr double kWidth = 0.45, kHeight = 0.2;  // mm, of a bead
constexpr int kRows = 40;                       // beads per layer

/// Rows of full infill in a square, with a short bead at each turn.
Toolpath infill(std::int64_t beads) {
  Toolpath path;
  const OriginId here = path.origins().add(CallLocation{.file = "", .line = 0, .call = "bench"});
  const double side = kRows * kWidth;
  const auto position = [&](int layer, int row, bool far) {
    const double across = (row + 0.5) * kWidth, along = far == (row % 2 == 0) ? side : 0.0;
    const double z = (layer + 1) * kHeight;
    return layer % 2 == 0 ? Point3{along, across, z} : Point3{across, along, z};
  };
  Point3 at;
  const auto lay = [&](Point3 to) {
    path.add(step::Extrude{to, bead_volume(mm(distance(at, to)), mm(kWidth), mm(kHeight)), mm(kWidth),
                           mm(kHeight), mm_per_min(3000)},
             here);
    at = to;
  };
  for (std::int64_t laid = 0, layer = 0; laid < beads; ++layer) {
    at = position(static_cast<int>(layer), 0, false);
    path.add(step::Rapid{at}, here);
    for (int row = 0; row < kRows && laid < beads; ++row, laid += 2) {
      if (row > 0) lay(position(static_cast<int>(layer), row, false));
      lay(position(static_cast<int>(layer), row, true));
    }
  }
  return path;
}

/// Beads, resolution in microns, threads.
void print_infill(benchmark::State& state) {
  const Toolpath path = infill(state.range(0));
  PrintOptions options;
  options.resolution = mm(1e-3 * static_cast<double>(state.range(1)));
  options.threads = static_cast<unsigned>(state.range(2));
  std::size_t beads = 0;
  double laid = 0.0;
  for (auto _ : state) {
    Diagnostics diagnostics;
    const auto print = simulate_print(path, options, diagnostics);
    if (!print) return state.SkipWithError("not printed");
    beads = print->beads;
    laid = print->total.laid.mm3();
  }
  state.counters["beads/s"] = benchmark::Counter(
      static_cast<double>(beads) * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["beads"] = static_cast<double>(beads);
  state.counters["laid_mm3"] = laid;
}
BENCHMARK(print_infill)
    ->Args({100'000, 90, 2})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kerf

// The 2D kernel on a gear of 200 teeth: 15 rings of 0.8 mm outwards and inwards, each from the original, and
// chained ring on ring. The counters hold what other kernels needed on a gear of this size (1,200 arcs and
// lines, or their chords) elsewhere: an arc kernel 176 ms from the original and 9.3 ms chained, Clipper2 495
// ms, GEOS 703 ms, Boost.Geometry 422 ms, Clipper 673 ms and 27 s chained.
#include "kerf/region.h"

#include <benchmark/benchmark.h>
#include <cmath>
#include <numbers>

namespace {

using namespace kerf;

constexpr int kRings = 15;
constexpr double kStep = 0.8;  // mm

Point2 polar(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

/// A gear of six arcs a tooth: fillet, flank, top, flank, fillet, root. Module 1.
Outline gear(int teeth) {
  const double r = 0.5 * teeth, root = r - 1.25, top = r + 1.0, pitch = 2.0 * std::numbers::pi / teeth;
  Outline outline;
  outline.start = polar(root, 0.0);
  for (int i = 0; i < teeth; ++i) {
    const auto arc = [&](double via_radius, double via, double to_radius, double to) {
      outline.segments.push_back(
          {polar(to_radius, (i + to) * pitch), polar(via_radius, (i + via) * pitch), {}});
    };
    arc(root + 0.08, 0.045, root + 0.3, 0.06);
    arc(r - 0.1, 0.09, top, 0.18);
    arc(top, 0.30, top, 0.42);
    arc(r - 0.1, 0.51, root + 0.3, 0.54);
    arc(root + 0.08, 0.555, root, 0.60);
    arc(root, 0.80, root, 1.0);
  }
  outline.segments.back().to = outline.start;
  return outline;
}

void from_original(benchmark::State& state, double sign) {
  Diagnostics diagnostics;
  const auto region = make_region({gear(200)}, FillRule::nonzero, {}, diagnostics);
  std::size_t segments = 0;
  for (auto _ : state) {
    segments = 0;
    for (int i = 1; i <= kRings; ++i) {
      const auto ring = offset(*region, mm(sign * kStep * i), {}, diagnostics);
      if (!ring) return state.SkipWithError("no ring");
      for (const Outline& loop : ring->region.loops) segments += loop.segments.size();
    }
  }
  state.counters["segments"] = static_cast<double>(segments);
  state.counters["arc_kernel_ms"] = 176.0;
  state.counters["Clipper2_ms"] = 495.0;
  state.counters["GEOS_ms"] = 703.0;
}
BENCHMARK_CAPTURE(from_original, outwards, 1.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(from_original, inwards, -1.0)->Unit(benchmark::kMillisecond);

void ring_on_ring(benchmark::State& state, double sign) {
  Diagnostics diagnostics;
  const auto region = make_region({gear(200)}, FillRule::nonzero, {}, diagnostics);
  for (auto _ : state) {
    Region ring = *region;
    for (int i = 1; i <= kRings; ++i) ring = offset(ring, mm(sign * kStep), {}, diagnostics)->region;
    benchmark::DoNotOptimize(ring);
  }
  state.counters["arc_kernel_ms"] = 9.3;
  state.counters["Clipper_ms"] = 27000.0;
}
BENCHMARK_CAPTURE(ring_on_ring, outwards, 1.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ring_on_ring, inwards, -1.0)->Unit(benchmark::kMillisecond);

}  // namespace

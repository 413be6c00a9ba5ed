// The 2D kernel on a gear of 200 teeth: 15 rings of 0.8 mm outwards and inwards, each from the original, and
// chained ring on ring. The counters hold what other kernels needed on a gear of this size (1,200 arcs and
// lines, or their chords) elsewhere: an arc kernel 176 ms from the original and 9.3 ms chained, Clipper2 495
// ms, GEOS 703 ms, Boost.Geometry 422 ms, Clipper 673 ms and 27 s chained. Then growth, from 100 to 100,000
// pieces: squares and overlapping circles united, a ring of noise offset by many times the length of its
// sides, and the union of two polygons that cross a few times.
#include <benchmark/benchmark.h>
#include <cmath>
#include <numbers>
#include <random>

#include "kerf/geom/offset.h"

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
      outline.segments.push_back({polar(to_radius, (i + to) * pitch), polar(via_radius, (i + via) * pitch)});
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

// ------------------------------------------------------------------------------------------------- growth

void united(benchmark::State& state, const std::vector<Outline>& outlines) {
  Diagnostics diagnostics;
  std::size_t loops = 0;
  for (auto _ : state) {
    const auto region = make_region(outlines, FillRule::nonzero, {}, diagnostics);
    if (!region) return state.SkipWithError("no region");
    loops = region->loops.size();
  }
  state.counters["loops"] = static_cast<double>(loops);
}

Outline square(Point2 at, double side) {
  Outline made{at, {}};
  for (const Point2 step : {Point2{side, 0.0}, Point2{side, side}, Point2{0.0, side}, Point2{0.0, 0.0}})
    made.segments.push_back({at + step, {}});
  return made;
}

/// In rows and columns, each with the inside of its own.
void separate_squares(benchmark::State& state) {
  std::vector<Outline> outlines;
  const auto across = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(state.range(0)))));
  for (int i = 0; i < state.range(0); ++i)
    outlines.push_back(square({1.5 * (i % across), 1.5 * (i / across)}, 1.0));
  united(state, outlines);
}
BENCHMARK(separate_squares)->RangeMultiplier(10)->Range(100, 100'000)->Unit(benchmark::kMillisecond);

/// Each circle overlaps some three others.
void overlapping_circles(benchmark::State& state) {
  std::vector<Outline> outlines;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> position(0.0, std::sqrt(static_cast<double>(state.range(0))));
  for (int i = 0; i < state.range(0); ++i) {
    const double x = position(random), y = position(random);
    outlines.push_back(as_outline({{x, y}, mm(0.5)}));
  }
  united(state, outlines);
}
BENCHMARK(overlapping_circles)->RangeMultiplier(10)->Range(100, 100'000)->Unit(benchmark::kMillisecond);

Outline ring(std::int64_t corners, double radius, double noise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> off(-noise, noise);
  Outline made;
  for (std::int64_t i = 0; i <= corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
    const Point2 at = i == corners ? made.start : polar(radius + off(random), angle);
    if (i == 0)
      made.start = at;
    else
      made.segments.push_back({at, {}});
  }
  return made;
}

/// A ring of 100 mm diameter, 1 mm of noise, offset by 2 mm: a side of the last one is 0.003 mm wide.
void noisy_ring(benchmark::State& state, double by) {
  Diagnostics diagnostics;
  const auto region = make_region({ring(state.range(0), 50.0, 0.5, 1)}, FillRule::nonzero, {}, diagnostics);
  std::size_t segments = 0;
  for (auto _ : state) {
    const auto made = offset(*region, mm(by), {}, diagnostics);
    if (!made) return state.SkipWithError("no offset");
    segments = 0;
    for (const Outline& loop : made->region.loops) segments += loop.segments.size();
  }
  state.counters["segments"] = static_cast<double>(segments);
}
BENCHMARK_CAPTURE(noisy_ring, outwards, 2.0)
    ->RangeMultiplier(10)
    ->Range(100, 100'000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(noisy_ring, inwards, -2.0)
    ->RangeMultiplier(10)
    ->Range(100, 100'000)
    ->Unit(benchmark::kMillisecond);

/// Two smooth polygons beside each other.
void few_crossings(benchmark::State& state) {
  Diagnostics diagnostics;
  Outline other = placed(ring(state.range(0), 50.0, 0.0, 2), {{30.0, 10.0}, {1.0, 1.0}});
  const Region first{{ring(state.range(0), 50.0, 0.0, 1)}}, second{{other}};
  for (auto _ : state) {
    const auto made = combine(first, second, Boolean::unite, {}, diagnostics);
    if (!made) return state.SkipWithError("no union");
    benchmark::DoNotOptimize(made);
  }
}
BENCHMARK(few_crossings)->RangeMultiplier(10)->Range(100, 100'000)->Unit(benchmark::kMillisecond);

}  // namespace

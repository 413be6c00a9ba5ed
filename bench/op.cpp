// Operations: a pocket of a region with 1,000 arcs and 15 rings (the target is 0.15 s), its growth from 10
// to 100,000 arcs with as many rings, a contour with tabs, the order of 500 contours, and a raster of meshes
// of up to a million triangles at 0.2 mm (the target is 1 s).
#include <benchmark/benchmark.h>
#include <cmath>
#include <numbers>

#include "kerf/op/mill.h"
#include "kerf/op/rework.h"
#include "kerf/op/surface.h"

namespace {

using namespace kerf;

constexpr double kRadius = 60.0;    // mm, of the region
constexpr double kDiameter = 10.0;  // mm, of the tool: 15 rings at a stepover of 0.4

Point2 polar(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

/// A circle of arcs that bulge in and out by turns.
Region wavy(int arcs) {
  Outline outline{polar(kRadius, 0.0), {}};
  for (int i = 1; i <= arcs; ++i) {
    const double step = 2.0 * std::numbers::pi / arcs;
    // The sagitta is a twentieth of the chord, and half of it that of the circle.
    const double bulge = (i % 2 == 0 ? 1.0 : -1.0) * 0.05 * kRadius * step;
    outline.segments.push_back({polar(kRadius, i * step), polar(kRadius + bulge, (i - 0.5) * step)});
  }
  outline.segments.back().to = outline.start;
  Diagnostics diagnostics;
  return *make_region({outline}, FillRule::nonzero, {}, diagnostics);
}

Tool mill(double diameter) {
  Diagnostics diagnostics;
  return *make_tool(1, shape::Square{mm(diameter), mm(30)}, {}, {}, diagnostics);
}

CutOptions cut() {
  CutOptions options;
  options.depth = mm(1), options.feed = mm_per_min(900);
  return options;
}

void pocket_of_arcs(benchmark::State& state) {
  const Region region = wavy(static_cast<int>(state.range(0)));
  const Tool tool = mill(kDiameter);
  std::size_t steps = 0;
  for (auto _ : state) {
    Diagnostics diagnostics;
    const auto made = pocket(region, tool, {.cut = cut(), .stepover = 0.4}, diagnostics);
    if (!made) return state.SkipWithError("no pocket");
    steps = made->path.size();
  }
  state.counters["steps"] = static_cast<double>(steps);
  state.counters["target_ms"] = 150.0;
}
BENCHMARK(pocket_of_arcs)->RangeMultiplier(10)->Range(10, 100'000)->Unit(benchmark::kMillisecond);

void contour_with_tabs(benchmark::State& state) {
  const Region region = wavy(1000);
  const Tool tool = mill(3.0);
  ContourOptions options{.cut = cut()};
  options.tabs.height = mm(0.5);
  for (auto _ : state) {
    Diagnostics diagnostics;
    if (!contour(region, tool, options, diagnostics)) return state.SkipWithError("no contour");
  }
}
BENCHMARK(contour_with_tabs)->Unit(benchmark::kMillisecond);

void order_of_contours(benchmark::State& state) {
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  const Tool tool = mill(2.0);
  for (int i = 0; i < 500; ++i) {
    const int k = (i * 211) % 500;
    Diagnostics diagnostics;
    const Circle circle{{12.0 * (k % 25), 12.0 * (k / 25)}, mm(4)};
    append(path, contour_on({as_outline(circle)}, tool, cut(), diagnostics)->path);
  }
  double before = 0.0, after = 0.0;
  for (auto _ : state) {
    const Ordered made = order_cuts(path, {{1, mm(2)}});
    before = made.rapid_before, after = made.rapid_after;
  }
  state.counters["rapid_mm_before"] = before;
  state.counters["rapid_mm_after"] = after;
}
BENCHMARK(order_of_contours)->Unit(benchmark::kMillisecond);

/// Hills of three sizes on 100 x 100 mm, of n x n squares.
SurfaceMesh hills(std::uint32_t n) {
  SurfaceMesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) {
      const double x = 100.0 * i / n, y = 100.0 * j / n;
      mesh.points.push_back({x, y,
                             5.0 * std::sin(0.13 * x) * std::cos(0.1 * y) +
                                 1.2 * std::sin(0.9 * x + 0.7 * y) +
                                 0.3 * std::sin(3.1 * x) * std::sin(2.7 * y) - 8.0});
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + n + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

void raster_of_hills(benchmark::State& state) {
  const SurfaceMesh mesh = hills(static_cast<std::uint32_t>(state.range(0)));
  Diagnostics diagnostics;
  const Tool tool = *make_tool(1, shape::Ball{mm(6), mm(20)}, {}, {}, diagnostics);
  const Region area =
      *make_region({{{0, 0}, {{{100, 0}, {}}, {{100, 100}, {}}, {{0, 100}, {}}, {{0, 0}, {}}}}},
                   FillRule::nonzero, {}, diagnostics);
  std::size_t steps = 0;
  for (auto _ : state) {
    const auto made =
        raster(mesh, area, tool, {.cut = {.feed = mm_per_min(900)}, .line_distance = mm(0.2)}, diagnostics);
    if (!made) return state.SkipWithError("no raster");
    steps = made->path.size();
  }
  state.counters["steps"] = static_cast<double>(steps);
  state.counters["target_ms"] = 1000.0;
}
BENCHMARK(raster_of_hills)->Arg(71)->Arg(224)->Arg(707)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

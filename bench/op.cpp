// Operations: a pocket of a region with 1,000 arcs and 15 rings (the target is 0.15 s), its growth from 100
// to 10,000 arcs with as many rings, a contour with tabs, and the order of 500 contours.
#include <benchmark/benchmark.h>
#include <cmath>
#include <numbers>

#include "kerf/op/contour.h"
#include "kerf/op/order.h"
#include "kerf/op/pocket.h"

namespace {

using namespace kerf;

constexpr double kRadius = 60.0;    // mm, of the region
constexpr double kDiameter = 10.0;  // mm, of the tool: 15 rings at a stepover of 0.4

Point2 polar(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

/// A circle of arcs that bulge in and out by turns.
Region wavy(int arcs) {
  Outline outline{polar(kRadius, 0.0), {}, {}};
  for (int i = 1; i <= arcs; ++i) {
    const double step = 2.0 * std::numbers::pi / arcs;
    // The sagitta is a twentieth of the chord, and half of it that of the circle.
    const double bulge = (i % 2 == 0 ? 1.0 : -1.0) * 0.05 * kRadius * step;
    outline.segments.push_back({polar(kRadius, i * step), polar(kRadius + bulge, (i - 0.5) * step), {}});
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
BENCHMARK(pocket_of_arcs)->Arg(100)->Arg(1000)->Arg(10'000)->Unit(benchmark::kMillisecond);

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

}  // namespace

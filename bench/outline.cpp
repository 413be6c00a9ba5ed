// Corners and curves: ten thousand of each kind through the C++ interface. bench/outline_lists.py measures
// the Python lists.
#include "kerf/geom/outline.h"

#include <benchmark/benchmark.h>
#include <cmath>
#include <numbers>

namespace {

using namespace kerf;

constexpr int kCorners = 10000;

enum class Kind { line_line, line_arc, arc_arc };

/// A saw with teeth 20 wide: every corner has a request, with all kinds of neighbours.
Outline saw(Kind kind) {
  Outline outline;
  for (int i = 1; i <= kCorners + 1; ++i) {
    const Point2 from = outline.point(outline.segments.size());
    Segment segment{{20.0 * i, i % 2 == 0 ? 0.0 : 15.0}};
    if (kind == Kind::arc_arc || (kind == Kind::line_arc && i % 2 == 0)) {
      const Point2 half = 0.5 * (segment.to - from);
      segment.via = from + half + Point2{-0.2 * half.y, 0.2 * half.x};
    }
    outline.segments.push_back(segment);
  }
  return outline;
}

/// Time of the original for the same work, ms; 0: not measured.
void cut(benchmark::State& state, Kind kind, double request, double original) {
  const Outline outline = saw(kind);
  CornerRequests corners(kCorners + 1, mm(request));
  corners.front() = Length();
  for (auto _ : state) {
    Diagnostics diagnostics;
    auto made = cut_corners(outline, corners, {}, diagnostics);
    if (!made || diagnostics.warnings() > 0) state.SkipWithError("not every corner was cut");
    benchmark::DoNotOptimize(made);
  }
  state.SetItemsProcessed(state.iterations() * kCorners);
  if (original > 0.0) state.counters["Cnc25D_ms"] = original;
}
BENCHMARK_CAPTURE(cut, line_line_unchanged, Kind::line_line, 0.0, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cut, line_line_smooth, Kind::line_line, 2.0, 28.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cut, line_line_enlarge, Kind::line_line, -2.0, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cut, line_arc_smooth, Kind::line_arc, 2.0, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cut, line_arc_enlarge, Kind::line_arc, -2.0, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cut, arc_arc_smooth, Kind::arc_arc, 2.0, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cut, arc_arc_enlarge, Kind::arc_arc, -2.0, 362.0)->Unit(benchmark::kMicrosecond);

/// A spiral, sampled with its tangents.
Curve spiral() {
  Curve curve;
  for (int i = 0; i <= kCorners; ++i) {
    const double t = 0.05 * i, r = 50.0 + t;
    curve.push_back({{r * std::cos(t), r * std::sin(t)}, radians(t + std::atan2(r, 1.0))});
  }
  return curve;
}

void smooth_c_curve(benchmark::State& state) {
  const Curve curve = spiral();
  for (auto _ : state) {
    Diagnostics diagnostics;
    auto made = smooth_curve(curve, {}, diagnostics);
    if (!made || diagnostics.warnings() > 0) state.SkipWithError("not every piece became arcs");
    benchmark::DoNotOptimize(made);
  }
  state.SetItemsProcessed(state.iterations() * kCorners);
  state.counters["Cnc25D_ms"] = 73.0;
}
BENCHMARK(smooth_c_curve)->Unit(benchmark::kMicrosecond);

void smooth_b_curve(benchmark::State& state) {
  std::vector<Point2> points;
  for (const CurvePoint& p : spiral()) points.push_back(p.at);
  for (auto _ : state) {
    Diagnostics diagnostics;
    const auto curve = guess_headings(points, {}, diagnostics);
    auto made = smooth_curve(*curve, {}, diagnostics);
    benchmark::DoNotOptimize(made);
  }
  state.SetItemsProcessed(state.iterations() * kCorners);
}
BENCHMARK(smooth_b_curve)->Unit(benchmark::kMicrosecond);

}  // namespace

// Any bytes as a file of measured heights, as a map that a toolpath follows, and as a program with formulas.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <variant>
#include <vector>

#include "back/pathdxf/adjust_z.h"

#include "kerf/base/limits.h"
#include "kerf/formats/measured.h"
#include "kerf/op/level.h"

namespace {

using namespace kerf;

void expect(bool holds) {
  if (!holds) std::abort();
}

Toolpath sample_path() {
  Toolpath path;
  const OriginId origin = path.origins().add(CallLocation{"", 0, "sample"});
  path.add(step::Rapid{{0, 0, 5}}, origin);
  path.add(step::Cut{{0, 0, -1}, mm_per_min(100)}, origin);
  path.add(step::Cut{{20, 7, -1}, mm_per_min(100)}, origin);
  step::Arc arc;
  arc.to = {20, 7, -2};
  arc.centre = {15, 7};
  arc.feed = mm_per_min(100);
  path.add(arc, origin);
  path.add(step::Rapid{{0, 0, 5}}, origin);
  return path;
}

void follow(const MeasuredFile& measured) {
  std::vector<Point3> points;
  for (const MeasuredHeight& h : measured.heights)
    if (h.at && h.height && points.size() < 300) points.push_back({(*h.at)[0], (*h.at)[1], *h.height});
  Diagnostics diagnostics;
  const auto map = HeightMap::make(points, {}, diagnostics);
  expect(map.has_value() != diagnostics.has_errors());
  if (!map) return;
  static const Toolpath path = sample_path();
  LevelReport report;
  LevelOptions options;
  options.max_steps = 1000;
  if (measured.heights.size() % 2 == 1) options.keep_above = 2.0;
  const auto out = level(path, *map, options, report, diagnostics);
  expect(out.has_value() != diagnostics.has_errors());
  for (std::size_t i = 0; out && i < out->size(); ++i) {
    const Point3 to = (*out)[i].to();
    expect(finite(to) && to.z >= -2.0 - options.max_correction.mm() - 1.0 &&
           to.z <= 5.0 + 2.0 * limits::kMaxCoordinate);
  }
}

/// Numbers are finite, lines are those of the text, and a text is read or refused.
void check_heights(const MeasuredFile& measured, std::string_view text, const Diagnostics& diagnostics) {
  const auto lines = 1 + static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  for (const MeasuredHeight& h : measured.heights) {
    expect(h.line <= lines && (!h.height || std::isfinite(*h.height)));
    expect(!h.at || (std::isfinite((*h.at)[0]) && std::isfinite((*h.at)[1])));
  }
  for (const Diagnostic& d : diagnostics.list())
    if (const auto* where = std::get_if<TextLocation>(&d.where)) expect(where->line <= lines);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  Diagnostics diagnostics;
  MeasuredOptions reading;
  reading.max_heights = 10'000;
  if (size % 2 == 0) reading.work_offset = {1.0, 2.0, 3.0};
  if (size % 3 == 0) reading.area = {0.0, 0.0, 60.0, 40.0};
  const MeasuredFile measured =
      read_measured(text, size % 5 == 0 ? "map.probe" : "map", reading, diagnostics);
  check_heights(measured, text, diagnostics);
  if (!diagnostics.has_errors()) follow(measured);
  const std::vector<HeightTarget> targets{{51, {0.0, 0.0}, 2.0}, {52, {10.0, 0.0}, std::nullopt}};
  heights_of(measured, targets, mm(0.5), mm(1), Language::english, diagnostics);
  const auto positions = probed_positions(text);
  expect(positions.size() <= size);
  Diagnostics problems;
  const auto program = adjust_z(text, "a_Clean.gcode", expected_heights(text), Language::german, problems);
  expect(program.has_value() != problems.has_errors());
  return 0;
}

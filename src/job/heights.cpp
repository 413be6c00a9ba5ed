// Measured heights: files to corrections of programs; programs that measure.
#include "job/heights.h"

#include <cmath>
#include <fmt/format.h>

#include "base/codes/pathdxf.h"
#include "base/number.h"

#include "kerf/base/files.h"

namespace kerf {
namespace {

constexpr Length kSamePosition = mm(0.2);  // of a measured position and the probe's
constexpr double kOutside = 0.5;           // mm, beyond a map's area, that is reported

std::optional<MeasuredFile> read(const std::string& name, const MeasuredOptions& options,
                                 Diagnostics& diagnostics) {
  const std::size_t errors = diagnostics.errors();
  const auto file = InputFile::open(name, diagnostics);
  if (!file) return std::nullopt;
  MeasuredFile measured = read_measured(file->bytes(), name, options, diagnostics);
  if (measured.heights.empty() && diagnostics.errors() == errors)
    diagnostics.error(codes::heights_missing, TextLocation{name, 0, 0}, "the file has no measured height");
  return diagnostics.errors() == errors ? std::optional(std::move(measured)) : std::nullopt;
}

}  // namespace

bool apply_measured(Program& program, const MeasuredSettings& settings, Diagnostics& diagnostics) {
  if (program.probes.empty()) {
    diagnostics.warning(codes::heights_unmatched, TextLocation{program.source, 0, 0},
                        "no height of the program depends on measured values; --measured has no effect");
    return true;
  }
  const auto measured = read(settings.file, settings.reading, diagnostics);
  if (!measured) return false;
  const std::size_t errors = diagnostics.errors();
  const auto values = heights_of(*measured, program.probes, kSamePosition, settings.max_correction,
                                 settings.reading.language, diagnostics);
  if (diagnostics.errors() != errors) return false;
  auto path = apply_heights(program.path, values, diagnostics);
  if (path) program.path = std::move(*path);
  return path.has_value();
}

std::optional<LevelReport> level_program(Program& program, const std::string& file,
                                         const MeasuredOptions& reading, const LevelOptions& options,
                                         Diagnostics& diagnostics, Progress* progress) {
  const auto measured = read(file, reading, diagnostics);
  if (!measured) return std::nullopt;
  const TextLocation where{file, 0, 0};
  std::vector<Point3> points;
  for (const MeasuredHeight& h : measured->heights) {
    if (!h.height || !h.at || (h.variable && !h.expected)) {
      diagnostics.warning(codes::heights_missing, TextLocation{file, static_cast<std::uint32_t>(h.line), 0},
                          "a point without height or position is left out");
      continue;
    }
    points.push_back({(*h.at)[0], (*h.at)[1], *h.height - (h.variable ? *h.expected : 0.0)});
  }
  const auto map = HeightMap::make(std::move(points), where, diagnostics);
  if (!map) return std::nullopt;
  LevelReport report;
  auto path = level(program.path, *map, options, report, diagnostics, progress);
  if (!path) return std::nullopt;
  program.path = std::move(*path);
  if (report.outside > kOutside)
    diagnostics
        .warning(codes::level_outside, where,
                 fmt::format("cuts reach {} mm beyond the measured area; the heights of its boundary are "
                             "used there",
                             number_text(report.outside, 1)))
        .hint = "measure the whole area of the cuts, see kerf level --over";
  return report;
}

Toolpath probing_program(const ProbingGrid& grid) {
  constexpr unsigned kX = 1, kY = 2, kAll = 7;
  const auto at = [](double low, double high, int k, int count) {
    return count < 2 ? low : low + (high - low) * k / (count - 1);
  };
  Toolpath path;
  const OriginId origin = path.origins().add(CallLocation{"", 0, "probing_program"});
  const double clear = grid.clearance.mm();
  path.set_unknown_axes(path.add(step::Rapid{{0.0, 0.0, clear}}, origin), kX | kY);
  for (int row = 0; row < grid.rows; ++row)
    for (int k = 0; k < grid.columns; ++k) {
      const int column = row % 2 == 0 ? k : grid.columns - 1 - k;
      const Point2 p{at(grid.area.low.x, grid.area.high.x, column, grid.columns),
                     at(grid.area.low.y, grid.area.high.y, row, grid.rows)};
      path.add(step::Rapid{{p.x, p.y, clear}}, origin);
      const std::size_t i =
          path.add(step::Probe{{p.x, p.y, -grid.depth.mm()}, grid.feed, ProbeKind::contact_or_error}, origin);
      path.set_unknown_axes(i, kAll & 4u);
      path.add(step::Rapid{{p.x, p.y, clear}}, origin);
    }
  path.add(step::End{true}, origin);
  return path;
}

}  // namespace kerf

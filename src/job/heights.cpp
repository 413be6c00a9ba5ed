// Measured heights: files to corrections of programs.
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

std::optional<MeasuredSurface> read_surface(const std::string& file, const SurfaceReading& how,
                                            Diagnostics& diagnostics) {
  auto measured = read(file, how.reading, diagnostics);
  if (!measured) return std::nullopt;
  std::vector<Point3> points;
  std::vector<std::size_t> lines;
  for (const MeasuredHeight& h : measured->heights) {
    if (!h.height || !h.at || (h.variable && !h.expected)) {
      diagnostics.warning(codes::heights_missing, TextLocation{file, static_cast<std::uint32_t>(h.line), 0},
                          "a point without height or position is left out");
      continue;
    }
    points.push_back({(*h.at)[0], (*h.at)[1], *h.height - (h.variable ? *h.expected : 0.0)});
    lines.push_back(h.line);
  }
  auto map = HeightMap::make(points, TextLocation{file, 0, 0}, diagnostics);
  if (!map) return std::nullopt;
  if (how.zero != MapZero::as_measured) {
    double zero = how.zero == MapZero::point ? map->at(how.zero_at) : 0.0;
    if (how.zero == MapZero::mean)
      for (const Point3& p : points) zero += p.z / static_cast<double>(points.size());
    for (Point3& p : points) p.z -= zero;
    map = HeightMap::make(points, TextLocation{file, 0, 0}, diagnostics);
  }
  std::vector<std::size_t> outliers = outliers_of(points);
  for (const std::size_t i : outliers)
    diagnostics
        .warning(
            codes::level_outlier, TextLocation{file, static_cast<std::uint32_t>(lines[i]), 0},
            fmt::format("the height {} at {}, {} differs from those around it", fixed_text(points[i].z, 3),
                        fixed_text(points[i].x, 3), fixed_text(points[i].y, 3)))
        .hint = "measure this point again, or remove it";
  return MeasuredSurface{std::move(*measured), std::move(points), std::move(*map), std::move(outliers)};
}

std::optional<LevelReport> level_program(Program& program, const std::string& file,
                                         const SurfaceReading& reading, const LevelOptions& options,
                                         Diagnostics& diagnostics, Progress* progress) {
  const auto surface = read_surface(file, reading, diagnostics);
  if (!surface) return std::nullopt;
  LevelReport report;
  auto path = level(program.path, surface->map, options, report, diagnostics, progress);
  if (!path) return std::nullopt;
  program.path = std::move(*path);
  if (report.outside > kOutside)
    diagnostics
        .warning(codes::level_outside, TextLocation{file, 0, 0},
                 fmt::format("cuts reach {} mm beyond the measured area; the heights of its boundary are "
                             "used there",
                             number_text(report.outside, 1)))
        .hint = "measure the whole area of the cuts, see kerf level --over";
  return report;
}

}  // namespace kerf

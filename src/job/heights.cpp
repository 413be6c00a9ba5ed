// Measured heights: files to corrections of programs.
#include "job/heights.h"

#include <cmath>
#include <fmt/format.h>

#include "back/pathdxf/adjust_z.h"
#include "base/codes/pathdxf.h"
#include "base/number.h"
#include "job/path_programs.h"

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

/// Replaces the positions of a list of probes, which are those of the drawing, by those of the work: the
/// program that measures them is written with the list, in the same order.
bool move_to_work(MeasuredFile& list, Diagnostics& diagnostics) {
  using namespace path_endings;
  constexpr std::string_view kList = kProbeList;
  const bool is_named_so = std::string_view(list.file).ends_with(kList);
  const std::string name =
      list.file.substr(0, list.file.size() - (is_named_so ? kList.size() : 0)) + kProbing;
  const auto fail = [&](const std::string& message) {
    diagnostics.error(codes::level_map, TextLocation{list.file, 0, 0}, message).hint =
        fmt::format("keep NAME{} and NAME{} of one run of kerf pathdxf in one folder", kProbeList, kProbing);
    return false;
  };
  Diagnostics ignored;
  const auto probing = is_named_so ? InputFile::open(name, ignored) : std::nullopt;
  if (!probing)
    return fail(fmt::format(
        "the list has positions of the drawing; the program that measures them (NAME{}) is not beside it",
        kProbing));
  const auto positions = probed_positions(probing->bytes());
  if (positions.size() != list.heights.size())
    return fail(
        fmt::format("the list has {} heights, {} measures {}", list.heights.size(), name, positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i) list.heights[i].at = positions[i];
  return true;
}

void warn_of_zero_outside(const HeightMap& map, Point2 at, const std::string& file,
                          Diagnostics& diagnostics) {
  constexpr double kRounding = 0.01;  // mm
  const double distance = map.distance_outside(at);
  if (distance <= kRounding) return;
  diagnostics
      .warning(
          codes::level_outside, TextLocation{file, 0, 0},
          fmt::format("--map-zero {},{} is {} mm outside of the measured area; the height of its boundary "
                      "is taken as 0",
                      number_text(at.x, 3), number_text(at.y, 3), fixed_text(distance, 2)))
      .hint = "specify a position that was measured";
}

/// False, with an error, where a list of probes would correct a program that measured values correct already;
/// a warning with other maps.
bool check_corrected(const Program& program, const MeasuredSurface& surface, const std::string& file,
                     Diagnostics& diagnostics) {
  if (!is_corrected(program.path)) return true;
  const TextLocation where{file, 0, 0};
  if (surface.file.format == HeightsFormat::probe_list) {
    diagnostics
        .error(
            codes::level_twice, where,
            "the heights of the program are corrected by measured values; levelled by a list of probes, they "
            "would be corrected twice")
        .hint = "leave out --level, or level the program without --measured";
    return false;
  }
  diagnostics
      .warning(
          codes::level_twice, where,
          "the heights of the program are corrected by measured values; what the map has of them is added "
          "again")
      .hint = "use a map of what is left above the corrected heights, or leave out --level";
  return true;
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
  const std::size_t errors = diagnostics.errors();
  auto measured = read(file, how.reading, diagnostics);
  if (!measured) return std::nullopt;
  if (measured->format == HeightsFormat::probe_list && !move_to_work(*measured, diagnostics))
    return std::nullopt;
  std::vector<Point3> points;
  std::vector<std::size_t> lines;
  for (const MeasuredHeight& h : measured->heights) {
    const TextLocation where{file, static_cast<std::uint32_t>(h.line), 0};
    if (h.variable && !(h.height && h.expected && h.at)) {
      diagnostics
          .error(codes::heights_format, where,
                 h.height ? fmt::format("#{} has no expected height /T=", *h.variable)
                          : fmt::format("#{} has no measured height", *h.variable))
          .hint = "enter the measured height after the equals sign";
      continue;
    }
    if (!h.height || !h.at) {
      diagnostics.warning(codes::heights_missing, where, "a point without height or position is left out");
      continue;
    }
    points.push_back({(*h.at)[0], (*h.at)[1], *h.height - (h.variable ? *h.expected : 0.0)});
    lines.push_back(h.line);
  }
  if (diagnostics.errors() != errors) return std::nullopt;
  auto map = HeightMap::make(points, TextLocation{file, 0, 0}, diagnostics);
  if (!map) return std::nullopt;
  if (how.zero != MapZero::as_measured) {
    double zero = how.zero == MapZero::point ? map->at(how.zero_at) : 0.0;
    if (how.zero == MapZero::point) warn_of_zero_outside(*map, how.zero_at, file, diagnostics);
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
  if (!surface || !check_corrected(program, *surface, file, diagnostics)) return std::nullopt;
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

// Outlines as lines and arcs at Z0; a mesh as a stock of which nothing is removed.
#include "app/shown/viewable.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/codes/pathdxf.h"
#include "base/ending.h"

#include "kerf/formats/mesh_files.h"
#include "kerf/job/cut_program.h"

namespace kerf::app::view {
namespace {

constexpr std::string_view kOutlines = "outlines", kMesh = "mesh";

Point3 at_zero(Point2 p) { return {p.x, p.y, 0.0}; }

void add_outline(const Outline& outline, OriginId where, Toolpath& path) {
  path.add(step::Rapid{at_zero(outline.start)}, where);
  for (std::size_t i = 0; i < outline.segments.size(); ++i) {
    const Segment& segment = outline.segments[i];
    const auto arc = arc_circle(outline.point(i), segment);
    if (arc) {
      path.add(step::Arc{at_zero(segment.to), arc->centre, Plane::xy, arc->turn, 0, Feed{}}, where);
    } else {
      path.add(step::Cut{at_zero(segment.to), Feed{}}, where);
    }
  }
}

Program drawing_of(const std::vector<ArtShape>& shapes, const std::string& file) {
  Program program;
  const OriginId where = program.path.origins().text(program.path.origins().file(file), 0, 0);
  for (const ArtShape& shape : shapes) {
    if (!shape.name.empty()) program.path.add(step::Note{shape.name}, where);
    if (shape.outline) {
      add_outline(*shape.outline, where, program.path);
    } else if (shape.circle) {
      add_outline(as_outline(*shape.circle), where, program.path);
    }
  }
  return program;
}

/// Whether a name is that of a path ("8001.1P", "8001_1P"): four digits, a number and a letter.
bool is_path_layer(std::string_view name) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  constexpr std::size_t kDigits = 4;
  if (name.size() < kDigits + 3 || !std::all_of(name.begin(), name.begin() + kDigits, is_digit)) return false;
  return (name[kDigits] == '.' || name[kDigits] == '_') && is_digit(name[kDigits + 1]);
}

std::optional<Job> outlines_of(const std::string& file, std::optional<Length> unit, Diagnostics& diagnostics,
                               Progress* progress) {
  Job job;
  ArtOptions options;
  options.unit = unit;
  job.program = drawing_of(load_art(file, options, diagnostics, progress), file);
  if (diagnostics.has_errors()) return std::nullopt;
  return job;
}

/// What all files without a program have in common.
Job named(Job job, const std::string& file, std::string_view front_end) {
  job.program.source = file;
  job.program.front_end = front_end;
  job.program.files = {file};
  job.report = report_on(job.program.path, {});
  return job;
}

}  // namespace

std::optional<Job> load_plain_dxf(const std::string& file, std::optional<Length> unit,
                                  Diagnostics& diagnostics, Progress* progress) {
  const auto is_of_layers = [](const Diagnostic& d) { return d.code == codes::pathdxf_layer; };
  const auto& all = diagnostics.list();
  if (ending_of(file) != ".dxf" || std::none_of(all.begin(), all.end(), is_of_layers)) return std::nullopt;
  Diagnostics of_outlines;
  ArtOptions options;
  options.unit = unit;
  const std::vector<ArtShape> shapes = load_art(file, options, of_outlines, progress);
  const auto is_of_path = [](const ArtShape& shape) { return is_path_layer(shape.layer); };
  if (std::any_of(shapes.begin(), shapes.end(), is_of_path)) return std::nullopt;
  diagnostics = std::move(of_outlines);
  if (diagnostics.has_errors()) return std::nullopt;
  Job job;
  job.program = drawing_of(shapes, file);
  return named(std::move(job), file, kOutlines);
}

std::optional<Job> load_drawing_or_mesh(const std::string& file, std::optional<Length> unit,
                                        Diagnostics& diagnostics, Progress* progress) {
  const std::string ending = ending_of(file);
  const bool is_mesh = mesh_format_of(file).has_value();
  if (!is_mesh && ending != ".json" && ending != ".svg") return std::nullopt;
  if (!is_mesh) {
    auto job = outlines_of(file, unit, diagnostics, progress);
    return job ? std::optional(named(std::move(*job), file, kOutlines)) : std::nullopt;
  }
  Job job;
  job.stock = load_stock(file, diagnostics, progress);
  if (!job.stock || diagnostics.has_errors()) return std::nullopt;
  job.stock_source = StockSource::file;
  return named(std::move(job), file, kMesh);
}

bool is_program(const Job& job) {
  return job.program.front_end != kOutlines && job.program.front_end != kMesh;
}

}  // namespace kerf::app::view

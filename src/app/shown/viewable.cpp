// Outlines as lines and arcs at Z0; a mesh as a stock of which nothing is removed.
#include "app/shown/viewable.h"

#include <array>
#include <string_view>

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

}  // namespace

std::optional<Job> load_drawing_or_mesh(const std::string& file, Diagnostics& diagnostics) {
  const std::string ending = ending_of(file);
  const bool is_mesh = mesh_format_of(file).has_value();
  if (!is_mesh && ending != ".json" && ending != ".svg") return std::nullopt;
  Job job;
  if (is_mesh) {
    job.stock = load_stock(file, diagnostics);
    if (!job.stock) return std::nullopt;
    job.stock_source = StockSource::file;
  } else {
    const std::vector<ArtShape> shapes = load_art(file, std::nullopt, diagnostics);
    job.program = drawing_of(shapes, file);
  }
  if (diagnostics.has_errors()) return std::nullopt;
  job.program.source = file;
  job.program.front_end = is_mesh ? kMesh : kOutlines;
  job.program.files = {file};
  job.report = report_on(job.program.path, {});
  return job;
}

bool is_program(const Job& job) {
  return job.program.front_end != kOutlines && job.program.front_end != kMesh;
}

}  // namespace kerf::app::view

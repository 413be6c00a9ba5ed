// Raster passes over meshes, and paths projected onto them.
#include "kerf/op/surface.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/pace.h"
#include "base/parallel.h"
#include "op/base/cutter.h"
#include "op/base/hatch.h"
#include "op/base/trails.h"
#include "op/mesh/surface_job.h"
#include "op/mesh/surface_rest.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace op_detail {
namespace {

constexpr double kMaxSamples = 1e9;    // of a raster
constexpr double kSameZ = 1e-9;        // mm
constexpr double kMaxLink = 2.5;       // of the distance of lines: a longer way to the next line is a rapid
constexpr double kLinkOutside = 0.05;  // of that distance: how far a link may leave the area
constexpr double kMinLineDistance = 1e-3;  // mm
constexpr double kMinTolerance = 1e-4;     // mm

bool fail_mesh(const CutOptions& cut, const std::string& message, Diagnostics& diagnostics) {
  return fail(cut, codes::op_option, message, diagnostics);
}

bool valid_mesh(const SurfaceMesh& mesh, const CutOptions& cut, Diagnostics& diagnostics) {
  if (mesh.triangles.empty()) return fail(cut, codes::op_empty, "the mesh has no triangles", diagnostics);
  for (const Point3& p : mesh.points)
    if (!in_range(p.xy()) || !(std::abs(p.z) <= limits::kMaxCoordinate))
      return fail_mesh(cut, fmt::format("the mesh has a point beyond {:g} mm", limits::kMaxCoordinate),
                       diagnostics);
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (v >= mesh.points.size())
        return fail_mesh(cut, "the mesh has a triangle without a point", diagnostics);
  return true;
}

bool valid_options(const MeshCutOptions& options, Diagnostics& diagnostics) {
  const double line = options.line_distance.mm(), tolerance = options.tolerance.mm();
  bool good = true;
  if (!(line == 0.0 || (line >= kMinLineDistance && line <= limits::kMaxToolSize)))
    good = fail(options.cut, codes::op_option,
                fmt::format("line distance is {:g}; it must be at least {:g} mm", line, kMinLineDistance),
                diagnostics);
  if (!(tolerance >= kMinTolerance && tolerance <= 1.0))
    good = fail(options.cut, codes::op_option,
                fmt::format("tolerance is {:g}; it must be from {:g} to 1 mm", tolerance, kMinTolerance),
                diagnostics);
  return good;
}

}  // namespace

SurfaceJob::SurfaceJob(const SurfaceMesh& mesh, const SurfaceTool& tool, const MeshCutOptions& options,
                       double lowest)
    : cut(options.cut),
      floor(lowest),
      cutter(mesh, grown(tool, options.cut.allowance.mm()), options.threads, options.cut.progress),
      follower(cutter, lowest - options.cut.allowance.mm(), options.tolerance.mm()) {}

std::vector<Point3> SurfaceJob::follow(Point2 from, Point2 to) const {
  std::vector<Point3> path = follower.follow(from, to);
  for (Point3& p : path) p.z += cut.allowance.mm();
  return path;
}

std::optional<SurfaceJob> surface_job(const SurfaceMesh& mesh, const Tool& tool, const MeshCutOptions& given,
                                      SurfaceFloor kind, Diagnostics& diagnostics) {
  MeshCutOptions options = given;
  CutOptions& cut = options.cut;
  if (!valid_mesh(mesh, cut, diagnostics)) return std::nullopt;
  const Box3 box = bounds(mesh);
  double floor = cut.top - cut.depth.mm();
  if (kind == SurfaceFloor::limited) {
    if (box.high.z > cut.top + kSameZ) {
      fail_mesh(cut,
                fmt::format("the mesh reaches Z{:g}, above the surface of the material at Z{:g}", box.high.z,
                            cut.top),
                diagnostics);
      return std::nullopt;
    }
    if (cut.depth == Length{}) floor = box.low.z, cut.depth = mm(std::max(cut.top - floor, kMinTolerance));
  }
  const bool good = valid(cut, tool, diagnostics);
  if (!valid_options(options, diagnostics) || !good) return std::nullopt;
  const auto surface = surface_tool(tool);
  if (!surface) {
    fail(cut, codes::op_option,
         fmt::format("tool {}, {}, cannot follow a surface: its end is not flat, round or a cone",
                     tool.number, name_of(tool.shape)),
         diagnostics);
    return std::nullopt;
  }
  if (kind == SurfaceFloor::none) {
    floor = box.low.z - surface->height(surface->radius) - 1.0;
    if (cut.retract_plane < box.high.z + cut.clearance.mm()) {
      fail_mesh(
          cut,
          fmt::format("the mesh reaches Z{:g}, less than the clearance below the retract plane at Z{:g}",
                      box.high.z, cut.retract_plane),
          diagnostics);
      return std::nullopt;
    }
  }
  return std::optional<SurfaceJob>(std::in_place, mesh, *surface, options, floor);
}

bool for_each_line(const MeshCutOptions& options, std::string_view phase, std::size_t count,
                   const std::function<void(std::size_t, const LineStop&)>& make) {
  Progress* const progress = options.cut.progress;
  if (progress != nullptr) progress->phase(phase);
  const LineStop stop(progress);
  std::atomic<std::size_t> done{0};
  const auto work = [&](std::size_t i) {
    if (stop()) return;
    make(i, stop);
    ++done;
  };
  const auto is_enough = [&] {
    report(progress, static_cast<double>(done) / static_cast<double>(count));
    return stop();
  };
  parallel_for(thread_count(options.threads), count, work, is_enough);
  return !stop();
}

}  // namespace op_detail

namespace {

using namespace op_detail;
using Path = std::vector<Point3>;

/// A line of a raster and the way to the next one, if that leads along the surface.
struct RasterLine {
  Point2 from, to;
  bool linked = false;
  Path path, link;
};

std::vector<RasterLine> raster_lines(const Region& area, const MeshCutOptions& options, double distance) {
  std::vector<HatchLine> rows = hatch(area, options.angle, mm(distance), options.cut.max_steps);
  std::vector<RasterLine> lines;
  for (std::size_t i = 0; i < rows.size();) {
    std::size_t end = i;
    while (end < rows.size() && rows[end].row == rows[i].row) ++end;
    for (std::size_t k = i; k < end; ++k) {
      // Rows in alternating directions.
      const bool back = rows[i].row % 2 == 1;
      const HatchLine& line = rows[back ? end - 1 - (k - i) : k];
      lines.push_back({back ? line.to : line.from, back ? line.from : line.to, false, {}, {}});
    }
    i = end;
  }
  const RegionSearch search(area);
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    const Point2 a = lines[i].to, b = lines[i + 1].from;
    if (kerf::distance(a, b) > kMaxLink * distance) continue;
    lines[i].linked = true;
    for (const double t : {0.25, 0.5, 0.75})
      if (const auto room = search.clearance(a + t * (b - a)); !room || room->mm() < -kLinkOutside * distance)
        lines[i].linked = false;
  }
  return lines;
}

/// The paths without interruption, by lines and links.
std::vector<Path> joined(std::vector<RasterLine> lines) {
  std::vector<Path> paths;
  bool starts = true;
  for (RasterLine& line : lines) {
    if (starts) paths.emplace_back();
    Path& path = paths.back();
    for (const Path* part : {&line.path, &line.link})
      for (const Point3& p : *part)
        if (path.empty() || path.back() != p) path.push_back(p);
    starts = !line.linked;
    line = {};
  }
  return paths;
}

/// The parts of paths that cut what the earlier tool has left; all where there is none. Nothing, with errors,
/// where there are none.
std::optional<std::vector<Path>> rest_of(std::vector<Path> paths, const SurfaceMesh& mesh,
                                         const SurfaceJob& job, const Tool& tool, const Region& area,
                                         const MeshCutOptions& options, Diagnostics& diagnostics) {
  if (!options.earlier) return paths;
  const auto rest = SurfaceRest::make(mesh, job, tool, area, options, diagnostics);
  if (!rest) return std::nullopt;
  std::vector<Path> parts;
  Pace pace(options.cut.progress, "rest of the earlier tool", 1);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (pace.stops(i, paths.size())) return std::nullopt;
    for (Path& part : rest->parts(paths[i])) parts.push_back(std::move(part));
  }
  if (parts.empty()) return rest->nothing(options, tool, diagnostics), std::nullopt;
  return parts;
}

/// All paths, in passes: those after the first only where the mesh is deeper.
void cut_paths(Cutter& cutter, const std::vector<Path>& paths, const CutOptions& cut) {
  double lowest = cut.top, before = INFINITY;
  for (const Path& path : paths)
    for (const Point3& p : path) lowest = std::min(lowest, p.z);
  const std::vector<double> levels = pass_levels(cut.top, cut.depth, cut.stepdown);
  for (const double level : levels) {
    for (const Path& path : paths)
      for (const Path& run : runs_below(with_crossings(path, {level, before}), before)) {
        if (cutter.full()) return;
        cut_points(cutter, run, level, std::min(before, cut.top), cut);
      }
    if (level <= lowest) return;
    before = level;
  }
}

}  // namespace

Box3 bounds(const SurfaceMesh& mesh) {
  Box3 box;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (v < mesh.points.size()) box.add(mesh.points[v]);
  return box;
}

std::optional<Operation> raster(const SurfaceMesh& mesh, const Region& area, const Tool& tool,
                                const MeshCutOptions& options, Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  if (options.line_distance == Length{} && !valid_stepover(options.stepover, cut, diagnostics))
    return std::nullopt;
  const auto job = surface_job(mesh, tool, options, SurfaceFloor::limited, diagnostics);
  if (!job || stop_requested(cut.progress)) return std::nullopt;
  if (area.empty()) {
    fail(cut, codes::op_empty, "the area of the raster is empty", diagnostics);
    return std::nullopt;
  }
  const double given = options.line_distance.mm();
  const double distance = given > 0.0 ? given : options.stepover * tool.diameter.mm();
  if (kerf::area(area) / distance > kMaxSamples * options.tolerance.mm()) {
    fail(cut, codes::op_limit, "the lines of the raster are too long in all", diagnostics);
    return std::nullopt;
  }
  std::vector<RasterLine> lines = raster_lines(area, options, distance);
  const bool all = for_each_line(options, "raster", lines.size(), [&](std::size_t i, const LineStop&) {
    lines[i].path = job->follow(lines[i].from, lines[i].to);
    if (lines[i].linked) lines[i].link = job->follow(lines[i].to, lines[i + 1].from);
  });
  if (!all) return std::nullopt;
  const auto paths = rest_of(joined(std::move(lines)), mesh, *job, tool, area, options, diagnostics);
  if (!paths) return std::nullopt;
  Cutter cutter(job->cut, tool, Walls(Walls::Kind::unknown));
  cut_paths(cutter, *paths, job->cut);
  return finished(cutter, job->cut, diagnostics);
}

std::optional<Operation> project(const SurfaceMesh& mesh, const std::vector<Outline>& outlines,
                                 const Tool& tool, const MeshCutOptions& options, Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  if (outlines.empty()) {
    fail(cut, codes::op_empty, "no outline is given", diagnostics);
    return std::nullopt;
  }
  const auto job = surface_job(mesh, tool, options, SurfaceFloor::none, diagnostics);
  if (!job || stop_requested(cut.progress)) return std::nullopt;
  std::vector<Path> paths(outlines.size());
  const bool all =
      for_each_line(options, "projecting", outlines.size(), [&](std::size_t i, const LineStop& stop) {
        const std::vector<Point2> points = flattened(outlines[i], options.tolerance);
        for (std::size_t k = 1; k < points.size() && !stop(); ++k)
          for (const Point3& p : job->follow(points[k - 1], points[k]))
            if (paths[i].empty() || paths[i].back() != p) paths[i].push_back(p);
      });
  if (!all) return std::nullopt;
  for (const Path& path : paths)
    for (const Point3& p : path)
      if (p.z <= job->floor + cut.allowance.mm() + kSameZ) {
        fail_mesh(cut, fmt::format("the path leaves the mesh at X{:.4g} Y{:.4g}", p.x, p.y), diagnostics);
        return std::nullopt;
      }
  Cutter cutter(job->cut, tool, Walls(Walls::Kind::unknown));
  for (Path& path : paths) {
    double before = 0.0;
    for (const double level : pass_levels(0.0, cut.depth, cut.stepdown)) {
      if (cutter.full()) break;
      Path lower = path;
      for (Point3& p : lower) p.z += level;
      if (!lower.empty()) cut_points(cutter, lower, -INFINITY, path.front().z + before, job->cut);
      before = level;
      if (path.front() != path.back()) std::reverse(path.begin(), path.end());
    }
  }
  return finished(cutter, job->cut, diagnostics);
}

}  // namespace kerf

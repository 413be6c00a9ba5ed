// What is left on a mesh: the lower envelope of the earlier tool at all its positions.
#include "op/mesh/surface_rest.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "base/codes/op.h"
#include "op/base/cutter.h"

#include "kerf/base/limits.h"

namespace kerf::op_detail {
namespace {

constexpr double kMaxNodes = 4e6;       // of the grid; 16 MB
constexpr double kMaxAcross = 40.0;     // nodes along the radius of the earlier tool
constexpr double kPerThickness = 1.5;   // nodes along the thickness that is not cut: a position of the axis
                                        // beside a wall is less than that away from a node
constexpr double kSpacing = 1.0;        // of the pitch, between points of a path that are examined
constexpr double kMinThickness = 0.01;  // mm

}  // namespace

SurfaceRest::Disc SurfaceRest::disc_of(const SurfaceTool& tool, double pitch) {
  Disc disc;
  const int reach = static_cast<int>(tool.radius / pitch);
  for (int dy = -reach; dy <= reach; ++dy) {
    const double wide = std::sqrt(std::max(0.0, tool.radius * tool.radius - pitch * pitch * dy * dy));
    Disc::Row row{dy, static_cast<int>(wide / pitch), {}};
    for (int dx = 0; dx <= row.half; ++dx)
      row.heights.push_back(tool.height(std::min(pitch * std::hypot(dx, dy), tool.radius)));
    disc.rows.push_back(std::move(row));
  }
  return disc;
}

void SurfaceRest::choose_grid(const Box2& axes, double thickness, double radius) {
  const Box2 box = axes.grown(tool_.radius);
  const double wide = box.high.x - box.low.x, high = box.high.y - box.low.y;
  pitch_ = std::max({thickness / kPerThickness, radius / kMaxAcross, std::sqrt(wide * high / kMaxNodes),
                     std::max(wide, high) / kMaxNodes});
  thickness_ = kPerThickness * pitch_;
  low_ = box.low;
  nx_ = static_cast<int>(std::ceil(wide / pitch_)) + 1;
  ny_ = static_cast<int>(std::ceil(high / pitch_)) + 1;
}

/// The earlier tool, thicker by what is not cut, at all nodes that its tips have a height for.
void SurfaceRest::remove(std::size_t row, const std::vector<double>& tips, const Disc& disc) {
  const int j = static_cast<int>(row);
  for (const Disc::Row& part : disc.rows) {
    if (j + part.dy < 0 || j + part.dy >= ny_) continue;
    const double* const line = &tips[index(0, j + part.dy)];
    float* const left = &left_[index(0, j)];
    for (int dx = -part.half; dx <= part.half; ++dx) {
      const double lift = part.heights[static_cast<std::size_t>(std::abs(dx))] - thickness_;
      const int first = std::max(0, -dx), last = std::min(nx_, nx_ - dx);
      for (int i = first; i < last; ++i) left[i] = std::min(left[i], static_cast<float>(line[i + dx] + lift));
    }
  }
}

bool SurfaceRest::cover(const SurfaceMesh& mesh, const SurfaceJob& job, const Region& area,
                        const SurfaceTool& earlier, const MeshCutOptions& options) {
  const DropCutter cutter(mesh, earlier, options.threads, options.cut.progress);
  if (stop_requested(options.cut.progress)) return false;
  std::vector<double> tips(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_),
                           std::numeric_limits<double>::infinity());
  left_.assign(tips.size(), static_cast<float>(top_));
  const RegionSearch search(area);
  const auto drop = [&](std::size_t row, const LineStop&) {
    for (int i = 0; i < nx_; ++i) {
      const Point2 p = at(i, static_cast<int>(row));
      if (!area.empty()) {
        const auto room = search.clearance(p);
        if (!room || room->mm() < -pitch_) continue;
      }
      tips[index(i, static_cast<int>(row))] = cutter.at(p, job.floor);
    }
  };
  if (!for_each_line(options, "heights of the earlier tool", static_cast<std::size_t>(ny_), drop))
    return false;
  const Disc disc = disc_of(grown(earlier, thickness_), pitch_);
  return for_each_line(options, "rest of the earlier tool", static_cast<std::size_t>(ny_),
                       [&](std::size_t row, const LineStop&) { remove(row, tips, disc); });
}

std::optional<SurfaceRest> SurfaceRest::make(const SurfaceMesh& mesh, const SurfaceJob& job, const Tool& tool,
                                             const Region& area, const MeshCutOptions& options,
                                             Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  const auto earlier = surface_tool(*options.earlier), own = surface_tool(tool);
  const double thickness = options.rest_thickness.mm();
  if (!earlier) {
    fail(cut, codes::op_option,
         fmt::format("earlier tool {}, {}, cannot follow a surface: its end is not flat, round or a cone",
                     options.earlier->number, name_of(options.earlier->shape)),
         diagnostics);
    return std::nullopt;
  }
  if (!(thickness >= kMinThickness && thickness <= limits::kMaxToolSize)) {
    fail(cut, codes::op_option,
         fmt::format("rest thickness is {:g}; it must be at least {:g} mm", thickness, kMinThickness),
         diagnostics);
    return std::nullopt;
  }
  if (!own) return std::nullopt;  // an error of the job
  SurfaceRest made(*own, job.cut.top);
  const Box3 box = bounds(mesh);
  const Box2 axes = area.empty() ? Box2{box.low.xy(), box.high.xy()}.grown(earlier->radius) : bounds(area);
  made.choose_grid(axes, thickness, earlier->radius);
  if (!made.cover(mesh, job, area, *earlier, options)) return std::nullopt;
  return made;
}

void SurfaceRest::nothing(const MeshCutOptions& options, const Tool& tool, Diagnostics& diagnostics) {
  fail(options.cut, codes::op_empty,
       fmt::format("tool {} leaves nothing thicker than {:g} mm that tool {} reaches",
                   options.earlier->number, options.rest_thickness.mm(), tool.number),
       diagnostics);
}

/// Whether the tool touches what is left above its position.
bool SurfaceRest::cuts(Point3 tip) const {
  const Point2 from = tip.xy() - low_;
  const double reach = tool_.radius;
  const auto index_of = [&](double v, int count) {
    return static_cast<int>(std::clamp(std::ceil(v / pitch_), 0.0, static_cast<double>(count)));
  };
  const int j0 = index_of(from.y - reach, ny_), j1 = index_of(from.y + reach, ny_);
  for (int j = j0; j < j1; ++j) {
    const double dy = pitch_ * j - from.y, wide = std::sqrt(std::max(0.0, reach * reach - dy * dy));
    const int i0 = index_of(from.x - wide, nx_), i1 = index_of(from.x + wide, nx_);
    for (int i = i0; i < i1; ++i) {
      const double up = static_cast<double>(left_[index(i, j)]) - tip.z;
      if (up <= 0.0) continue;
      const double dx = pitch_ * i - from.x;
      if (up > tool_.height(std::min(std::sqrt(dx * dx + dy * dy), reach))) return true;
    }
  }
  return false;
}

std::vector<std::vector<Point3>> SurfaceRest::parts(const std::vector<Point3>& path) const {
  struct Station {
    Point3 at;
    double s = 0.0;       // mm along the path
    bool corner = false;  // a point of the path
  };
  std::vector<Station> stations;
  std::vector<double> cutting;  // where it cuts
  double s = 0.0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const Point3 from = k == 0 ? path[0] : path[k - 1];
    const double whole = distance(from, path[k]);
    const double count = std::max(1.0, std::ceil(whole / (kSpacing * pitch_)));
    for (double n = k == 0 ? count : 1.0; n <= count; n += 1.0) {
      const Point3 p = n == count ? path[k] : from + (n / count) * (path[k] - from);
      stations.push_back({p, s + whole * (n / count), n == count});
      if (cuts(p)) cutting.push_back(stations.back().s);
    }
    s += whole;
  }
  std::vector<std::vector<Point3>> made;
  std::size_t first = 0;  // of `cutting`, that is not more than a radius behind
  bool inside = false;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const Station& station = stations[k];
    while (first < cutting.size() && cutting[first] < station.s - tool_.radius) ++first;
    const bool near = first < cutting.size() && cutting[first] <= station.s + tool_.radius;
    if (near && !inside) made.emplace_back();
    if (!near && inside && !stations[k - 1].corner) made.back().push_back(stations[k - 1].at);
    if (near && (!inside || station.corner)) made.back().push_back(station.at);
    inside = near;
  }
  if (inside && !stations.back().corner) made.back().push_back(stations.back().at);
  std::erase_if(made, [](const std::vector<Point3>& part) { return part.size() < 2; });
  return made;
}

}  // namespace kerf::op_detail

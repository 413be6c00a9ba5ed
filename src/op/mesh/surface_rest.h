// What an earlier tool has left on a mesh, as heights on a grid, and the parts of a path that cut it.
#pragma once

#include <optional>
#include <vector>

#include "op/mesh/surface_job.h"

namespace kerf::op_detail {

class SurfaceRest {
 public:
  /// After the tool `options.earlier` was at all positions of its axis in `area` (empty: around the whole
  /// mesh), down to the floor of `job`. Nothing, with errors, if it cannot follow a surface; nothing if
  /// stopped.
  static std::optional<SurfaceRest> make(const SurfaceMesh& mesh, const SurfaceJob& job, const Tool& tool,
                                         const Region& area, const MeshCutOptions& options,
                                         Diagnostics& diagnostics);

  /// The parts of a path of the tip of `tool` on which it cuts something, a radius longer at both
  /// ends.
  std::vector<std::vector<Point3>> parts(const std::vector<Point3>& path) const;

  /// Reports that there are no such parts.
  static void nothing(const MeshCutOptions& options, const Tool& tool, Diagnostics& diagnostics);

 private:
  SurfaceRest(const SurfaceTool& tool, double top) : tool_(tool), top_(top) {}
  /// Positions of the grid within a distance of one, and the height of a tool there.
  struct Disc {
    struct Row {
      int dy = 0, half = 0;         // rows of 2 * half + 1 positions
      std::vector<double> heights;  // from the centre outwards
    };
    std::vector<Row> rows;
  };
  static Disc disc_of(const SurfaceTool& tool, double pitch);
  void choose_grid(const Box2& axes, double thickness, double radius);
  bool cover(const SurfaceMesh& mesh, const SurfaceJob& job, const Region& area, const SurfaceTool& earlier,
             const MeshCutOptions& options);
  void remove(std::size_t row, const std::vector<double>& tips, const Disc& disc);
  bool cuts(Point3 tip) const;
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(i);
  }
  Point2 at(int i, int j) const { return {low_.x + pitch_ * i, low_.y + pitch_ * j}; }

  SurfaceTool tool_;
  double top_;  // Z of the material
  Point2 low_;
  double pitch_ = 1.0;
  double thickness_ = 0.0;  // mm
  int nx_ = 0, ny_ = 0;
  std::vector<float> left_;  // Z of the material on the grid
};

}  // namespace kerf::op_detail

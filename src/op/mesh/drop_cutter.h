// Heights at which a tool that comes down on a mesh touches it. Exact for facets, edges and vertices.
//
// Each part of the mesh is known by the positions of the axis at which the tool may touch it (mesh_parts.h).
// These regions are sorted into square cells, large ones into larger cells, each with an upper bound of the
// tool's height there. What touches at a position is one of the few parts in the cells around it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "op/mesh/mesh_parts.h"

namespace kerf::op_detail {

class DropCutter {
 public:
  /// `mesh` must be valid.
  /// Of a stopped run it has no heights.
  DropCutter(const SurfaceMesh& mesh, const SurfaceTool& tool, unsigned threads,
             Progress* progress = nullptr);

  /// Z of the tip with the axis at `p`, at least `floor`.
  double at(Point2 p, double floor) const;
  const SurfaceTool& tool() const { return tool_; }

 private:
  /// Cells of one size.
  struct Level {
    double size = 1.0;  // mm
    int nx = 0, ny = 0;
    std::size_t start = 0;  // of its cells in `first_`
    bool is_used = false;

    Box2 box(Point2 low, int i, int j) const {
      const Point2 corner = low + Point2{size * i, size * j};
      return {corner, corner + Point2{size, size}};
    }
  };
  /// A part in a cell. The two upper bits of `part` are its kind.
  struct Entry {
    float bound = 0.0F;  // no tip with the axis in the cell is higher on it
    std::uint32_t part = 0;
  };
  struct Found {
    std::uint32_t cell = 0;
    Entry entry;
  };
  /// What one thread has found.
  struct Batch {
    std::vector<Found> found;
    std::vector<std::array<std::uint32_t, 2>> edges;
  };
  /// The region of positions: that of the points of a part, less the offset of the contact.
  struct Region {
    std::array<Point3, 3> points;
    int count = 0;
    Box2 offset;
    Box2 box;  // around it
  };
  struct Columns {
    int first = 0, last = 0;
  };

  void choose_levels();
  Region region_of(const MeshPart& part) const;
  std::size_t level_of(const Region& region) const;
  Columns columns_in_row(const Region& region, const Level& level, int row) const;
  double bound(const MeshPart& part, const Region& region, const Box2& cell) const;
  void add(const MeshPart& part, std::uint32_t number, Batch& batch) const;
  void sort(std::vector<Batch>& batches, unsigned threads);
  double touch(std::uint32_t part, Point2 p, double best) const;
  double touch_facet(std::uint32_t triangle, Point2 p, double best) const;

  SurfaceTool tool_;
  MeshParts parts_;
  double slack_ = 0.0;
  std::size_t max_cells_ = 0;  // of a region
  Box2 box_;                   // of the positions
  std::vector<Level> levels_;
  std::vector<std::uint32_t> first_;  // of the entries of each cell
  std::vector<Entry> entries_;        // the highest bound of a cell first
  std::vector<std::array<std::uint32_t, 2>> edges_;
};

}  // namespace kerf::op_detail

// Heights at which a tool that comes down on a mesh touches it. Exact for facets, edges and vertices.
//
// The triangles are sorted into square cells. Each cell has an upper bound of the tool's height over all that
// it contains; only triangles of cells that may be higher than what is found already are examined.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "op/surface_tool.h"

#include "kerf/op/surface.h"

namespace kerf::op_detail {

class DropCutter {
 public:
  /// Memory of the queries of one thread: triangles that were examined, and the one of the last contact.
  struct Scratch {
    std::vector<std::uint32_t> examined;
    std::uint32_t query = 0, last = 0;
  };

  /// `mesh` must outlive this, and be valid (see check_mesh_of_operation).
  DropCutter(const SurfaceMesh& mesh, const SurfaceTool& tool, unsigned threads);

  /// Z of the tip with the axis at `p`, at least `floor`.
  double at(Point2 p, double floor, Scratch& scratch) const;
  const SurfaceTool& tool() const { return tool_; }

 private:
  /// A square of the grid: a plane that nothing in it is above, as the height of a tool that touches it.
  struct Cell {
    double height = 0.0;  // of the tool's tip with its axis at the centre of the cell
    double rise_x = 0.0, rise_y = 0.0;
    double shift_x = 0.0, shift_y = 0.0;  // from the axis to the contact with the plane, less the flat end
  };
  struct Triangle;

  void choose_grid();
  void sort_triangles();
  void bound_cells(unsigned threads);
  void bound_cell(std::size_t cell);
  double fallen(double height, double away) const;
  double bound(const Cell& cell, double x, double y) const;
  double touch(std::uint32_t triangle, Point2 p, double best) const;
  Box2 cell_box(std::size_t cell) const;
  template <class Visit>
  void visit_cells(std::uint32_t triangle, const Visit& visit) const;

  const SurfaceMesh& mesh_;
  SurfaceTool tool_;
  double parabola_ = 0.0;  // of the circle of the profile; 0: none
  Box2 box_;
  double size_ = 1.0;  // mm, of a cell
  int nx_ = 0, ny_ = 0, blocks_x_ = 0, blocks_y_ = 0;
  std::vector<std::uint32_t> first_;    // of the entries of each cell
  std::vector<std::uint32_t> entries_;  // triangles
  std::vector<float> highest_, block_highest_;
  std::vector<Cell> cells_;
};

}  // namespace kerf::op_detail

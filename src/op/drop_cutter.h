// Heights at which a tool that comes down on a mesh touches it. Exact for facets, edges and vertices.
//
// The triangles are sorted into square cells, and those into a tree of squares of twice the size each. Each
// square has an upper bound of the tool's height over all that it contains; only triangles of squares that
// may be higher than what is found already are examined.
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
  /// A square of the tree: a plane that nothing in it is above, as the height of a tool that touches it.
  struct Square {
    double height = 0.0;  // of the tool's tip with its axis at the centre of the square
    double rise_x = 0.0, rise_y = 0.0;
    double shift_x = 0.0, shift_y = 0.0;  // from the axis to the contact with the plane, less the flat end
    double plane = 0.0;                   // Z of the plane at the centre
    double highest = 0.0;                 // Z; -infinity where there is nothing
  };
  /// Squares of one size. Four that make one of the next level follow each other.
  struct Level {
    double size = 1.0;      // mm
    int nx = 0, ny = 0;     // even
    std::size_t start = 0;  // of its squares in `squares_`

    std::size_t index(int i, int j) const {
      const auto quad = static_cast<std::size_t>(j / 2) * static_cast<std::size_t>(nx / 2);
      return start + 4 * (quad + static_cast<std::size_t>(i / 2)) +
             static_cast<std::size_t>(2 * (j % 2) + i % 2);
    }
    Point2 corner(int i, int j) const { return {size * i, size * j}; }
  };
  /// A triangle as a plane with the tool on it.
  struct Facet {
    double lift = 0.0;  // mm, of the tip above the plane at the axis; infinite: vertical or degenerate
    double rise_x = 0.0, rise_y = 0.0;
    double contact_x = 0.0, contact_y = 0.0;  // from the axis to the contact with the plane
  };
  class Search;

  void plane_facets(unsigned threads);
  bool is_low(const Facet& facet, double above, const std::array<Point3, 3>& corners) const;
  void choose_grid();
  void choose_levels(double size, int nx, int ny);
  void sort_triangles();
  void bound_squares(unsigned threads);
  void bound_cell(int i, int j);
  void bound_square(std::size_t level, int i, int j);
  void set_plane(Square& square, Point2 rise, double plane) const;
  double fallen(double height, double away) const;
  double bound(const Square& square, double x, double y, double size) const;
  double touch(std::uint32_t triangle, Point2 p, double best) const;
  Box2 cell_box(int i, int j) const;
  template <class Visit>
  void visit_cells(std::uint32_t triangle, const Visit& visit) const;

  const SurfaceMesh& mesh_;
  SurfaceTool tool_;
  double parabola_ = 0.0;  // of the circle of the profile; 0: none
  Box2 box_;
  std::vector<Facet> facets_;  // of the triangles
  std::vector<Level> levels_;  // the cells first
  std::vector<Square> squares_;
  std::vector<std::uint32_t> first_;    // of the entries of each cell
  std::vector<std::uint32_t> entries_;  // triangles
};

}  // namespace kerf::op_detail

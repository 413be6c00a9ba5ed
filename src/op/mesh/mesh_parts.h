// The facets, edges and vertices of a mesh that a tool from above may touch, and where: a part is touched
// only where the surface of the tool can be tangent to it without cutting its neighbours.
//
// At a contact the tool's slopes along X and Y are those of a plane that no neighbour is above. On a facet
// they are the facet's; on an edge they are between those of the facets at both sides, so that there are none
// in a valley; at a vertex they are those of all planes through it that none of its edges is above. The
// slopes give the offset from the axis to the contact.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/pace.h"
#include "op/mesh/surface_tool.h"

#include "kerf/op/surface.h"

namespace kerf::op_detail {

struct MeshPart {
  enum class Kind : std::uint8_t { facet, edge, vertex };
  Kind kind = Kind::facet;
  std::uint32_t a = 0, b = 0;  ///< a facet's triangle; the points of an edge; the point
  Box2 offset;                 ///< of the contact from the axis
};

/// A triangle as a plane with the tool on it.
struct Facet {
  Point2 at;                          // the first point of the triangle
  double height = 0.0;                // of the tip with the axis there
  double rise_x = 0.0, rise_y = 0.0;  // slopes
  Point2 contact;                     // from the axis to the contact
  bool is_steep = false;              // vertical or degenerate: no plane; what it has is touched at its sides
};

class MeshParts {
 public:
  /// Incomplete if stopped.
  MeshParts(const SurfaceMesh& mesh, const SurfaceTool& tool, unsigned threads, Progress* progress = nullptr);

  /// The points of the mesh, each once.
  const std::vector<Point3>& points() const { return points_; }
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }
  const std::vector<Facet>& facets() const { return facets_; }
  /// Appends the vertex, if it can be touched, and its edges to points of larger numbers.
  void parts_at(std::uint32_t point, std::vector<MeshPart>& parts) const;

 private:
  /// A side of a triangle at a point: the other end, and the triangle.
  struct Spoke {
    std::uint32_t to = 0, triangle = 0;
    bool operator<(const Spoke& other) const { return to < other.to; }
  };
  void weld(const SurfaceMesh& mesh, Pace& pace);
  void plane_facets(unsigned threads);
  void sort_triangles();
  void add_vertex(std::uint32_t point, const std::vector<Spoke>& spokes, std::vector<MeshPart>& parts) const;
  void add_edge(std::uint32_t from, const Spoke* first, const Spoke* last,
                std::vector<MeshPart>& parts) const;
  bool has_one_plane(const std::vector<Spoke>& spokes) const;

  SurfaceTool tool_;
  double thinnest_ = 0.0;  // mm, altitude of a triangle seen from above; a thinner one has no plane
  std::vector<Point3> points_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Facet> facets_;
  std::vector<std::uint32_t> first_, around_;  // triangles at each point
};

/// How much larger regions of contact are for rounding, mm.
double contact_slack(const SurfaceTool& tool);

}  // namespace kerf::op_detail

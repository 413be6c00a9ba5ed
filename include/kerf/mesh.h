// The surface of columns as a closed mesh, and whether such a mesh is valid.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/mesh_check.h"
#include "kerf/progress.h"
#include "kerf/units.h"
#include "kerf/workpiece.h"

namespace kerf {

/// A closed triangle mesh, with the step that made each triangle.
struct Mesh {
  std::vector<float> positions;          // x y z, mm, work coordinates
  std::vector<std::uint32_t> triangles;  // three indices each, counter-clockwise from outside
  std::vector<std::uint32_t> step;       // one per triangle; kStockSurface where none
};

struct MeshOptions {
  /// Maximum distance in height of the upper and the lower surface from where they are without merging. 0:
  /// only level triangles of one step are merged.
  Length tolerance;
  /// One per step of the toolpath: surfaces of steps of one group may become one triangle, which then has the
  /// step of one of them. Steps beyond its end, and with a tolerance all steps where it is empty, are groups
  /// of their own.
  std::span<const std::uint8_t> step_groups = {};
  unsigned threads = 0;  // 0: as many as the machine has. The mesh is the same for any number.
};

/// A copy of the columns from which meshes are made. Uncut tiles take no memory, so that it is made faster
/// than a ColumnGrid. It does not change with the workpiece.
class MeshColumns {
 public:
  /// threads 0: as many as the machine has.
  explicit MeshColumns(const Workpiece& workpiece, unsigned threads = 0);
  explicit MeshColumns(const ColumnGrid& grid, unsigned threads = 0);
  MeshColumns(MeshColumns&&) noexcept;
  MeshColumns& operator=(MeshColumns&&) noexcept;
  ~MeshColumns();

  struct Body;
  const Body& body() const { return *body_; }

 private:
  std::unique_ptr<Body> body_;
};

/// The surface of the columns: closed, oriented, every edge shared by exactly two triangles. Surfaces run
/// through the columns' heights, walls separate columns whose surfaces do not continue each other, the
/// block's own sides and bottom are exact. See docs/decisions/0006-mesh.md. A stopped run returns an empty
/// mesh.
Mesh extract_mesh(const MeshColumns& columns, const MeshOptions& options, Progress* progress = nullptr);
Mesh extract_mesh(const ColumnGrid& columns, Progress* progress = nullptr);
Mesh extract_mesh(const ColumnGrid& columns, const MeshOptions& options, Progress* progress = nullptr);

MeshCheck check_mesh(const Mesh& mesh);

/// The volume that the mesh of columns should enclose: theirs, within a tolerance that follows from the
/// walls' area, the pitch and the merging (docs/decisions/0006-mesh.md).
VolumeRange mesh_volume(const MeshColumns& columns, const MeshOptions& options = {});
VolumeRange mesh_volume(const ColumnGrid& columns, const MeshOptions& options = {});
/// Whether a mesh may be written, see mesh_check.h.
bool verify_mesh(const Mesh& mesh, const VolumeRange& volume, Diagnostics& diagnostics);

/// A mesh with the volume that it should enclose.
struct CheckedMesh {
  Mesh mesh;
  VolumeRange volume;
  bool is_verified = false;  // verify_mesh has accepted it; else it is still to be asked
};
/// Whether the mesh may be written.
inline bool verify_mesh(const CheckedMesh& mesh, Diagnostics& diagnostics) {
  return mesh.is_verified || verify_mesh(mesh.mesh, mesh.volume, diagnostics);
}

}  // namespace kerf

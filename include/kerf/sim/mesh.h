// Closed meshes of the surface of columns, and their verification.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/units.h"
#include "kerf/geom/mesh_check.h"
#include "kerf/sim/workpiece.h"

namespace kerf {

/// A closed triangle mesh with the step that made each triangle.
struct Mesh {
  std::vector<float> positions;          // x y z, mm, work coordinates
  std::vector<std::uint32_t> triangles;  // three indices each, counter-clockwise from outside
  std::vector<std::uint32_t> step;       // one per triangle; kStockSurface where none
};

struct MeshOptions {
  /// Maximum deviation in height of the upper and the lower surface from the unmerged ones. 0: only level
  /// triangles of one step are merged.
  Length tolerance;
  /// The group of each step of the toolpath. Surfaces of one group may be merged into one triangle, which
  /// then has the step of one of them. Each step beyond the end of the list is a group of its own.
  std::span<const std::uint8_t> step_groups = {};
  unsigned threads = 0;  // 0: all of the machine's. The mesh does not depend on it.
};

/// A copy of the columns for meshing, independent of later changes of the workpiece. Uncut tiles take no
/// memory, so it is faster to make than a ColumnGrid.
class MeshColumns {
 public:
  /// threads 0: all of the machine's.
  explicit MeshColumns(const Workpiece& workpiece, unsigned threads = 0);
  explicit MeshColumns(const ColumnGrid& grid, unsigned threads = 0);
  MeshColumns(MeshColumns&&) noexcept;
  MeshColumns& operator=(MeshColumns&&) noexcept;
  ~MeshColumns();

  struct Body;
  explicit MeshColumns(std::unique_ptr<Body> body);
  const Body& body() const { return *body_; }

 private:
  std::unique_ptr<Body> body_;
};

/// The surface of the columns: closed, oriented, each edge with exactly two triangles. Surfaces interpolate
/// the columns' heights, walls separate columns whose heights are not continuous, the sides and the bottom of
/// the block are exact. See docs/decisions/0006-mesh.md. A stopped run returns an empty mesh.
Mesh extract_mesh(const MeshColumns& columns, const MeshOptions& options, Progress* progress = nullptr);
Mesh extract_mesh(const ColumnGrid& columns, Progress* progress = nullptr);
Mesh extract_mesh(const ColumnGrid& columns, const MeshOptions& options, Progress* progress = nullptr);

/// A division of the mesh of a workpiece into the parts over squares of columns, numbered row by row from the
/// low corner: after a change only some of them have to be made again.
struct MeshTiling {
  int columns = 0;     // along a tile's side
  int nx = 0, ny = 0;  // numbers of tiles
  std::size_t size() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny); }
  bool operator==(const MeshTiling&) const = default;
};
/// Tiles of at least 64 columns, about `max_tiles` at most.
MeshTiling mesh_tiling(const Workpiece& workpiece, std::size_t max_tiles);

/// A part of a mesh: open at its sides, where the neighbouring tiles have the same vertices.
struct MeshTile {
  std::uint32_t number = 0;
  Mesh mesh;
};
/// The triangles of extract_mesh() over some tiles, `numbers` in ascending order. A wall between two tiles
/// belongs to the one with the higher number. Takes the time of the tiles and of 64 columns around them. A
/// tile depends on columns up to 64 outside of it. A stopped run returns nothing.
std::vector<MeshTile> extract_mesh_tiles(const Workpiece& workpiece, const MeshTiling& tiling,
                                         std::span<const std::uint32_t> numbers, const MeshOptions& options,
                                         Progress* progress = nullptr);

MeshCheck check_mesh(const Mesh& mesh);

/// The volume that the mesh of columns should enclose: that of the columns, within a tolerance that follows
/// from the area of the walls, the pitch and the merging (docs/decisions/0023-mesh-verification.md).
VolumeRange mesh_volume(const MeshColumns& columns, const MeshOptions& options = {});
VolumeRange mesh_volume(const ColumnGrid& columns, const MeshOptions& options = {});
/// Whether a mesh is valid and may be written, see mesh_check.h.
bool verify_mesh(const Mesh& mesh, const VolumeRange& volume, Diagnostics& diagnostics);

/// A mesh with the volume that it should enclose.
struct CheckedMesh {
  Mesh mesh;
  VolumeRange volume;
  bool is_verified = false;  // verify_mesh has already accepted it
};
/// Whether the mesh is valid and may be written.
inline bool verify_mesh(const CheckedMesh& mesh, Diagnostics& diagnostics) {
  return mesh.is_verified || verify_mesh(mesh.mesh, mesh.volume, diagnostics);
}

}  // namespace kerf

// The simulator: what a toolpath leaves of the stock, what it touches that it should not, and which step made
// what.
//
// The workpiece is a grid of vertical material columns, each a few intervals [low, high] in z, so that
// undercutting tools are exact. Every interval end remembers the step that made it. See docs/decisions and
// design/simulation.md.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/geometry.h"
#include "kerf/mesh_check.h"
#include "kerf/progress.h"
#include "kerf/stock.h"
#include "kerf/stock_body.h"
#include "kerf/tool.h"
#include "kerf/toolpath.h"

namespace kerf {

/// The step id of a surface that no step made: the stock's own faces.
inline constexpr std::uint32_t kStockSurface = 0xffffffffu;

/// What the solid is for: to be cut, or (fixtures.h) not to be touched at all. A no-go solid stays whole,
/// whatever goes through it, and tells every cut into it as HazardKind::spindle_off, as if the spindle stood.
enum class SolidRole : std::uint8_t { stock, no_go };

struct SimulationOptions {
  Length resolution;     // column pitch; 0 chooses one: of left-over stock its own, else about 2.5
                         // million columns, from 0.02 to 1 mm; for a huge stock more
  unsigned threads = 0;  // 0: as many as the machine has. The result is the same for any number.
  std::size_t max_columns = 400'000'000;  // more is an error that says which resolution would do
  Length hazard_depth = mm(0.001);        // contacts shallower than this are no hazard
  SolidRole role = SolidRole::stock;
};

enum class HazardKind : std::uint8_t {
  rapid_in_stock,
  neck_contact,
  shank_contact,
  holder_contact,
  over_flute,
  below_floor,
  spindle_off,
};
std::string_view to_string(HazardKind kind);

/// A step that would break a tool or a part. One entry a step and kind.
struct Hazard {
  HazardKind kind{};
  std::uint32_t step = 0;  // index in the toolpath
  Point3 at;               // mm, the first column met along the move, at the depth of the contact there
  Length depth;            // largest depth of the contact below the material's surface
  Volume removed;          // material met
};

/// One vertical run of material in a column; ids are indices of the steps that made its ends, or
/// kStockSurface.
struct Interval {
  float low = 0.0f;   // mm above the workpiece's floor
  float high = 0.0f;  // mm above the workpiece's floor
  std::uint32_t low_step = kStockSurface;
  std::uint32_t high_step = kStockSurface;
};

/// A copy of the columns as plain arrays: column (i, j) is number j * nx + i and owns the intervals
/// first[number] to first[number + 1] - 1, lowest first. It stands at bounds.low.x + column_x(i), y likewise;
/// heights count from bounds.low.z. Where the pitch does not divide the block, the last column of a row is
/// narrower and stands in the middle of what is left, so that no column stands outside the block.
struct ColumnGrid {
  Box3 bounds;         // mm, the stock's block
  double pitch = 0.0;  // mm
  int nx = 0, ny = 0;
  std::vector<std::uint32_t> first;
  std::vector<Interval> intervals;
  /// Empty, or one a column: for a column without material the step that took the last of it (so that the
  /// walls around a through cut know who made them), else anything.
  std::vector<std::uint32_t> cut_through = {};

  /// Place of column i or j, mm from the block's low side.
  double column_x(int i) const;
  double column_y(int j) const;
};

/// The material left, as columns.
class Workpiece {
 public:
  Workpiece(const Stock& stock, Length pitch);
  Workpiece(Workpiece&&) noexcept;
  Workpiece& operator=(Workpiece&&) noexcept;
  ~Workpiece();

  const Box3& bounds() const;  // mm, the stock's block
  Length pitch() const;
  int columns_x() const;
  int columns_y() const;
  /// The material of a column, lowest first; empty where all is cut away.
  std::vector<Interval> column(int i, int j) const;
  ColumnGrid grid() const;
  Volume volume() const;

  struct Body;
  Body& body() { return *body_; }
  const Body& body() const { return *body_; }

 private:
  std::unique_ptr<Body> body_;
};

/// The material left as the stock of a following job (make_columns_body); which steps made it is forgotten.
LeftColumns left_columns(const Workpiece& workpiece);

struct Simulation {
  Workpiece workpiece;
  Volume stock, removed;
  std::vector<Hazard> hazards;         // in order of steps
  std::vector<float> removed_by_step;  // mm3, one a step of the toolpath
  double seconds = 0.0;                // of the simulation alone
  bool stopped = false;                // interrupted: what is here is the state at that moment
};

/// Cuts the toolpath out of the stock. Appends errors (unknown tool, too many columns) and returns nothing
/// where it cannot run. Steps without material effect (dwell, notes) are passed over.
std::optional<Simulation> simulate(const Toolpath& path, const ToolTable& tools, const Stock& stock,
                                   const SimulationOptions& options, Diagnostics& diagnostics,
                                   Progress* progress = nullptr);

/// A closed triangle mesh, with the step that made each triangle.
struct Mesh {
  std::vector<float> positions;          // x y z, mm, work coordinates
  std::vector<std::uint32_t> triangles;  // three indices each, counter-clockwise from outside
  std::vector<std::uint32_t> step;       // one a triangle; kStockSurface where none
};

struct MeshOptions {
  /// How far, in height, the upper and the lower surface may lie from where they run without merging. 0: only
  /// what is level and of one step is merged.
  Length tolerance;
  /// One a step of the toolpath: what steps of one group have made may become one triangle, which then has
  /// the step of one of them. Steps that it does not reach, and with a tolerance all steps where it is empty,
  /// are groups of their own.
  std::span<const std::uint8_t> step_groups = {};
  unsigned threads = 0;  // 0: as many as the machine has. The mesh is the same for any number.
};

/// The columns as meshes are made of them: what nothing has cut takes no memory, so that they are made faster
/// than a ColumnGrid. They stay what they are when the workpiece changes.
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
/// through the columns' heights, walls stand between columns whose surfaces do not continue each other, the
/// block's own sides and bottom are exact. See docs/decisions/0006-mesh.md. A stopped run returns an empty
/// mesh.
Mesh extract_mesh(const MeshColumns& columns, const MeshOptions& options, Progress* progress = nullptr);
Mesh extract_mesh(const ColumnGrid& columns, Progress* progress = nullptr);
Mesh extract_mesh(const ColumnGrid& columns, const MeshOptions& options, Progress* progress = nullptr);

MeshCheck check_mesh(const Mesh& mesh);

/// What the mesh of columns should hold: their volume, within a tolerance that the walls' area, the pitch and
/// the merging tell (docs/decisions/0006-mesh.md).
VolumeRange mesh_volume(const MeshColumns& columns, const MeshOptions& options = {});
VolumeRange mesh_volume(const ColumnGrid& columns, const MeshOptions& options = {});
/// To be asked before a mesh is written, see mesh_check.h.
bool verify_mesh(const Mesh& mesh, const VolumeRange& volume, Diagnostics& diagnostics);

/// Where a picture cuts the part open: the side of a plane that is nearer to the viewer is left out, and
/// where the plane goes through material its face is drawn in kSectionColour, without light and shade.
struct Section {
  Plane plane = Plane::yz;  // it is parallel to
  double at = 0.0;          // mm along the third axis, work coordinates
};
inline constexpr std::array<std::uint8_t, 3> kSectionColour{247, 226, 92};  // sRGB

/// From where a picture is taken, and where it cuts the part open.
struct View {
  Angle azimuth = degrees(-35);     // about Z; 0 looks along +Y from the front
  Angle elevation = degrees(50);    // above the horizon; 90 looks straight down
  int width = 1600, height = 1000;  // pixels
  std::optional<Section> section = {};
};
/// Whether the face of a section can be seen from there; a view along the plane sees no more than its edge.
bool faces(const View& view, const Section& section);
/// "top", "bottom", "front", "back", "left", "right", "iso", or nothing.
std::optional<View> named_view(std::string_view name);

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // rows from the top
};
/// Draws a mesh with light and shade, fitted to the picture; `colours` holds one sRGB colour a triangle
/// (missing ones are drawn grey). Sizes are kept within 1 to 8192 pixels a side.
Image render(const Mesh& mesh, std::span<const std::array<std::uint8_t, 3>> colours, const View& view);

}  // namespace kerf

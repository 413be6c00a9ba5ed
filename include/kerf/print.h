// The added bead: what a printing program builds, road by road, and what comes out wrong.
//
// A *road* is a straight extruding move. Its cross-section is what slicers reckon with (the Slic3r manual,
// "Flow math"; PrusaSlicer, SuperSlicer and OrcaSlicer share it): a rectangle with half circles at its sides,
//
//   area = (width - height) * height + pi * (height / 2)^2,   area = volume / length in the plan,
//
// so that of volume, width and height two tell the third. The nozzle's Z is the road's top. Its height is,
// first found: the step's own (step::Extrude, where the program's comments tell it);
// PrintOptions::layer_height; what the step's width and volume leave; the step in Z from the layer below,
// which is the last one printed lower than this (the bed for the first). A chain of roads without another
// motion in between keeps its height; where it climbs by a whole height (a vase) a new layer begins. A road
// with less material than a round string of that height is a string of its own diameter, at the nozzle.
// Roads end square, so that each holds its own volume; where a road goes on at an angle, the wedge outside
// the corner is round, as a nozzle is; free ends get half a turn of the cross-section, told apart (`ends`).
//
// Filament that is pushed while the nozzle stands first makes good what was drawn back; more of it is a
// *blob*, which is told and not laid, since nothing tells its shape. So is a "road" wider than
// limits::kMaxBeadWidth.
//
// Material is columns of intervals, as in workpiece.h; they stand on the bed and grow by union. Each interval
// end has the step that made it, the earlier one where two made it. Lengths in mm, work coordinates.
//
//   extruded = laid - ends + overlap + blobs
//
// Volumes are counted in columns; in each layer the columns' share is scaled to what E says was extruded, so
// that the figures do not depend on how a road lies in the grid. `threads` changes nothing in any result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/limits.h"
#include "kerf/mesh.h"
#include "kerf/progress.h"
#include "kerf/tolerance.h"
#include "kerf/toolpath.h"
#include "kerf/units.h"
#include "kerf/workpiece.h"

namespace kerf {

struct PrintOptions {
  Length resolution = mm(0);  // column pitch; 0 chooses one: a fifth of the usual road's width or, for a
                              // large print, what keeps to some millions of columns and intervals
  unsigned threads = 0;       // 0: as many as the machine has
  std::optional<Length> layer_height = {};  // of roads whose step tells none; nothing: told as said above
  Length bed = mm(0);                       // Z of the bed's face
  Length contact_depth =
      default_tolerance::kNozzleDepth;  // the nozzle in material by less than this is no hazard
  Volume least_blob = mm3(0.01);        // less is no blob
  std::size_t max_columns = limits::kMaxColumns;
  std::size_t max_intervals = limits::kMaxPrintIntervals;
};

enum class PrintHazardKind : std::uint8_t {
  nozzle_contact,  // a move, extruding or not, whose nozzle goes through material or the bed
  in_air,       // roads that nothing holds: neither material below nor any beside, nor a road they go on from
  unsupported,  // a stretch of road longer than wide whose middle line has nothing below it
  blob,         // filament pushed on the spot, more than was drawn back
};
std::string_view to_string(PrintHazardKind kind);

/// One entry a move for nozzle_contact and blob; a stretch of roads that go on from each other is one entry.
struct PrintHazard {
  PrintHazardKind kind{};
  std::uint32_t step = 0;  // index in the toolpath, of a stretch's first road
  std::size_t steps = 1;   // roads of the stretch
  Point3 at;               // mm, the nozzle where it begins
  Length depth;            // nozzle_contact: the largest, under the nozzle's axis
  Length length;           // unsupported, in_air: of the stretch
  Volume volume;           // blob
};

struct PrintVolumes {
  Volume extruded;     // as E says; of roads and blobs
  Volume laid;         // what the material holds
  Volume overlap;      // extruded where there is material already (or the bed). Of two roads that meet at a
                       // corner only what does not fit into the wedge outside the corner
  Volume ends;         // the round free ends, which reach beyond the roads' lengths
  Volume blobs;        // extruded on the spot
  Volume hollow;       // empty height under material: in each column, between the bed and the highest
                       // material. Infill's cells, the room below bridges, the lenses between round sides
  Volume enclosed;     // the part of `hollow` from which no way leads out, from column to column
  Length road_length;  // in the plan
  Length unsupported;  // of it, with nothing below the middle line: bridges, and overhangs by more than half
                       // a width. "Below" ends half the road's height below it
};

/// All roads of one nozzle height; sloping ones belong to the layer that they begin in. `hollow` and
/// `enclosed` are those between the layer below and this one.
struct PrintLayer {
  Length z;       // the nozzle's
  Length height;  // of its thickest road
  std::size_t roads = 0;
  PrintVolumes volumes;  // but for blobs, which belong to no layer
};

struct PrintSimulation {
  ColumnGrid columns;              // what extract_mesh takes; bounds.low.z is the bed
  std::vector<PrintLayer> layers;  // lowest first
  PrintVolumes total;
  std::size_t roads = 0;
  std::vector<PrintHazard> hazards;  // in order of steps
  double seconds = 0.0;              // of the simulation alone
  bool stopped = false;              // interrupted: what is here is not complete
};

/// What a road holds that is so long in the plan, wide and high; it is no higher than wide.
Volume road_volume(Length length, Length width, Length height);

/// Whether a program prints and does nothing else: it extrudes while it moves and turns no spindle.
bool is_print(const Toolpath& path);

/// Lays the roads of a program. Appends errors (no road, too many columns) and returns nothing where it
/// cannot run; warns where nothing tells a height, where the comments' widths contradict E (is the filament's
/// diameter right?), where the place is not known, and where columns are too coarse for roads.
std::optional<PrintSimulation> simulate_print(const Toolpath& path, const PrintOptions& options,
                                              Diagnostics& diagnostics, Progress* progress = nullptr);

/// The columns with every gap no higher than `height` filled, but those above the bed. The grooves and lenses
/// between round-sided roads make most of a print's exact surface; closed by a layer's height, the mesh is
/// smaller by far and shows the same part.
ColumnGrid without_grooves(const ColumnGrid& columns, Length height);

/// The surface of a print's columns: extract_mesh, with a road's step on the walls beside nothing too.
Mesh extract_print_mesh(const ColumnGrid& columns, const MeshOptions& options, Progress* progress = nullptr);

}  // namespace kerf

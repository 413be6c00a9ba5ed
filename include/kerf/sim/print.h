// The print simulator: the beads that an extruding program lays, and its hazards.
//
// A *bead* (*road* in the FDM literature) is the material of one straight extruding motion. Its cross-section
// is that of the slicers (the Slic3r manual, "Flow math"; PrusaSlicer, SuperSlicer and OrcaSlicer use the
// same): a rectangle with half circles at its sides,
//
//   area = (width - height) * height + pi * (height / 2)^2,   area = volume / length in plan,
//
// so two of volume, width and height determine the third. The Z of the nozzle is the top of the bead. Its
// height is the first of: that of the step (step::Extrude, from comments of the program);
// PrintOptions::layer_height; the height that follows from width and volume of the step; the difference in Z
// from the layer below, which is the last one printed lower than this (the bed for the first). A chain of
// beads without another motion in between keeps its height; where it climbs by a whole height (a vase) a new
// layer starts. A bead with less material than a round one of that height is a cylinder of its own diameter
// below the nozzle. Beads have square ends, so that each has exactly its own volume; where a bead continues
// at an angle, the wedge outside the corner is rounded; free ends are rounded too, and their volume is
// reported as `ends`.
//
// Filament extruded without motion first compensates for retraction; the rest is a *blob*. It is reported,
// but not laid, as its shape is unknown. A bead wider than limits::kMaxBeadWidth is also a blob.
//
// The material is columns of intervals, as in workpiece.h; they start at the bed and grow by union. Each
// interval end has the step that made it, the earlier one if two made it. Lengths in mm, work coordinates.
//
//   extruded = laid - ends + overlap + blobs
//
// Volumes are measured at points spread evenly over the beads; in each layer they are scaled to the extruded
// volume given by E. They do not depend on the position of a bead in the grid. The results do not depend on
// `threads`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/limits.h"
#include "kerf/base/progress.h"
#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/path/toolpath.h"
#include "kerf/sim/mesh.h"
#include "kerf/sim/workpiece.h"

namespace kerf {

struct PrintOptions {
  Length resolution = mm(0);  // column pitch; 0 chooses one: a fifth of the usual bead width or, for a large
                              // print, one that needs some millions of columns and intervals
  unsigned threads = 0;       // 0: as many as the machine has
  std::optional<Length> layer_height = {};                 // of beads whose step has none; nothing: see above
  Length bed = mm(0);                                      // Z of the top of the bed
  Length contact_depth = default_tolerance::kNozzleDepth;  // shallower contacts of the nozzle are ignored
  Volume min_blob = mm3(0.01);                             // smaller ones are ignored
  std::size_t max_columns = limits::kMaxColumns;
  std::size_t max_intervals = limits::kMaxPrintIntervals;
};

enum class PrintHazardKind : std::uint8_t {
  nozzle_contact,  // a motion, extruding or not, whose nozzle passes through material or the bed
  in_air,          // beads without support: no material beside or up to their height below them, and not a
                   // continuation of a supported bead
  unsupported,     // consecutive beads, longer than wide in all, with nothing below their centre line
  wide_bead,       // a bead much wider than the usual one of the print
  blob,            // filament extruded without motion, more than was retracted
};
std::string_view to_string(PrintHazardKind kind);

/// One entry per motion for nozzle_contact, wide_bead and blob; consecutive unsupported beads are one entry.
struct PrintHazard {
  PrintHazardKind kind{};
  std::uint32_t step = 0;  // index in the toolpath, of the first bead
  std::size_t steps = 1;   // beads of the entry
  Point3 at;               // mm, the nozzle at the start
  Length depth;            // nozzle_contact: maximum, on the axis of the nozzle
  Length length;           // unsupported, in_air: length without support; wide_bead: of the bead
  Volume volume;           // blob; wide_bead: more than a bead of the usual width has
  Length width;            // unsupported, in_air, wide_bead: of the bead
};

struct PrintVolumes {
  Volume extruded;  // as given by E, of beads and blobs
  Volume laid;      // volume of the material
  Volume overlap;   // extruded into existing material (or the bed). Of two beads that meet at a corner only
                    // what does not fit into the wedge outside the corner
  Volume ends;      // the rounded free ends, beyond the lengths of the beads
  Volume blobs;     // extruded without motion
  Volume hollow;  // space below material: in each column, between the bed and the highest material. Cells of
                  // infill, the space below bridges, the gaps between rounded sides
  Volume enclosed;     // the part of `hollow` that is not connected, from column to column, with the outside
  Length bead_length;  // in plan
  Length unsupported;  // of it, with nothing below the centre line: bridges, and overhangs by more than half
                       // a width. Material at most half the height of the bead below it counts
};

/// All beads with one nozzle height; sloping ones belong to the layer they start in. `hollow` and `enclosed`
/// are those between the layer below and this one.
struct PrintLayer {
  Length z;       // of the nozzle
  Length height;  // of its highest bead
  std::size_t beads = 0;
  PrintVolumes volumes;  // without blobs, which belong to no layer
};

/// What a program prints, without simulating the material.
struct PrintFigures {
  struct Layer {
    Length z;       // of the nozzle
    Length height;  // of its highest bead
  };
  Volume extruded;  // as given by E: in beads and blobs, and where the position is unknown
  Volume blobs;     // of this, extruded without motion
  Length bead_length;
  std::size_t beads = 0;
  std::optional<std::uint32_t> first_bead;  // its step
  std::vector<Layer> layers;                // lowest first
  Box3 box;                                 // mm, of the beads
};

struct PrintSimulation {
  ColumnGrid columns;              // input of extract_mesh; bounds.low.z is the bed
  std::vector<PrintLayer> layers;  // lowest first
  PrintVolumes total;
  std::size_t beads = 0;
  std::vector<PrintHazard> hazards;  // sorted by step
  double seconds = 0.0;              // of the simulation alone
  bool stopped = false;              // interrupted: the result is incomplete
};

/// Whether a program only prints: it extrudes while moving and starts no spindle.
bool is_print(const Toolpath& path);

/// The figures of a print; no beads if the program does not print.
PrintFigures figures_of_print(const Toolpath& path, const PrintOptions& options);

/// Lays the beads of a program. Appends errors (no beads, too many columns) and returns nothing if it cannot
/// run. Warns if a height is unknown, if widths in comments contradict E (wrong filament diameter?), if a
/// position is unknown, and if the columns are too coarse for the beads.
std::optional<PrintSimulation> simulate_print(const Toolpath& path, const PrintOptions& options,
                                              Diagnostics& diagnostics, Progress* progress = nullptr);

/// The columns with all gaps up to `height` filled, except those above the bed. Most of the exact surface of
/// a print is grooves and gaps between beads with rounded sides; closed by the height of a layer, the mesh is
/// much smaller and shows the same part.
ColumnGrid without_grooves(const ColumnGrid& columns, Length height);

/// The surface of the columns of a print: extract_mesh, but walls beside empty columns have the step of a
/// bead too.
Mesh extract_print_mesh(const ColumnGrid& columns, const MeshOptions& options, Progress* progress = nullptr);

}  // namespace kerf

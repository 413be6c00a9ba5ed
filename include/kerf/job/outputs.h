// The results of a job as bytes in memory and as files: meshes and pictures coloured by tool, and left-over
// stock.
//
//   std::optional<PartSurface> surface = make_surface(job, *run, {}, diagnostics);
//   std::optional<std::string> stl = mesh_file(*surface, MeshFormat::stl, "part", diagnostics);
//   std::optional<std::string> png = picture_file(*surface, *named_view("iso"), diagnostics);
//
// A surface is made and coloured once, however many files are written from it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/files.h"
#include "kerf/base/progress.h"
#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/formats/mesh_files.h"
#include "kerf/job/job.h"
#include "kerf/sim/burn.h"
#include "kerf/sim/compare.h"
#include "kerf/sim/mesh.h"
#include "kerf/sim/render.h"
#include "kerf/sim/simulate.h"

namespace kerf {

/// `exact`: the surfaces of the tools, to a few microns. `columns`: interpolated between columns, which is
/// faster and suffices for pictures with pixels larger than the columns.
enum class SurfaceDetail : std::uint8_t { exact, columns };
/// Whether the surface of a print has the grooves between beads, which require many more triangles.
enum class Grooves : std::uint8_t { closed, kept };

/// What colours the beads of a print: nothing (`tool`, one colour), or the bead's kind, layer (its Z), speed,
/// flow, or the nozzle's temperature.
enum class BeadColours : std::uint8_t { tool, kind, layer, speed, flow, temperature };
/// By its name, "kind"; nothing for others.
std::optional<BeadColours> bead_colours_named(std::string_view name);

/// The colours of a part from a step on: where it is cut, by a rapid, by what is above the flute.
struct MotionColours {
  std::size_t first_step = 0;
  std::array<std::uint8_t, 3> cut{}, rapid{}, shaft{};
};

struct SurfaceOptions {
  SurfaceDetail detail = SurfaceDetail::exact;
  Grooves grooves = Grooves::closed;
  /// Distance from the surfaces; edges between cuts that lie closer than columns may be farther off. Nothing:
  /// default_tolerance::kExactMesh, more where a coarse resolution was asked for
  /// (docs/decisions/0019-exact-meshes.md).
  std::optional<Length> tolerance = {};
  BeadColours beads = BeadColours::tool;    // of a print
  std::vector<MotionColours> motions = {};  // by steps; steps before the first have that of their tool
  bool cut_finer = true;  // cut again for an exact surface if the columns are so coarse that it would be slow
};

/// A surface with the colour of each triangle: stock, hazard, or tool.
struct PartSurface : CheckedMesh {
  std::vector<std::uint8_t> colours;                 // one per triangle: an index into `palette`
  std::vector<std::string> colour_names;             // of the palette, as far as it is used
  std::vector<std::array<std::uint8_t, 3>> palette;  // part_palette(), or the colours of beads
};
/// Index 0: the surface of the stock; 1: surfaces cut by a hazard; from 2: of tools, see tool_colours().
std::span<const std::array<std::uint8_t, 3>> part_palette();
/// The tools in order of first use, and the index of each one's colour in the palette.
std::vector<std::pair<int, std::uint8_t>> tool_colours(const Toolpath& path);

/// Tolerance of merged triangles, about the deviation of the columns from the cut itself.
inline constexpr Length kMeshTolerance = mm(0.002);

/// Tolerance of exact surfaces in GLB files that are written without another mesh or picture: a tenth of a
/// pixel, about, of a part of 200 mm across a screen.
inline constexpr Length kViewedMeshTolerance = mm(0.02);

/// SurfaceOptions::tolerance for a mesh within `asked`: the rest is for edges between surfaces, which are as
/// exact as the columns.
constexpr Length fitted_tolerance(Length asked) { return 0.5 * asked; }

/// The surface of a run. Nothing if stopped.
std::optional<PartSurface> make_surface(const Job& job, const JobRun& run, const SurfaceOptions& options,
                                        Diagnostics& diagnostics, Progress* progress = nullptr);
/// The bytes of a mesh file, with a name for formats that store one. Nothing, with an error, if the mesh is
/// invalid.
std::optional<std::string> mesh_file(const PartSurface& surface, MeshFormat format, std::string_view name,
                                     Diagnostics& diagnostics);
/// The bytes of a PNG. Nothing, with an error, if the section plane of the view does not intersect the part.
std::optional<std::string> picture_file(const PartSurface& surface, const View& view,
                                        Diagnostics& diagnostics);

/// The toolpath of a job as the bytes of a PNG, over its stock as it was before the first cut: cuts in the
/// colours of the tools, rapids as thin lines, a laser's cuts by their power. Motions at unknown positions
/// are omitted.
std::string path_picture(const Job& job, const View& view);

/// The map of a laser's burn as the bytes of a PNG, from above; see draw_burn().
std::string burn_picture(const BurnMap& map, double black, int width, int height);

/// The comparison of a part with its target as the bytes of a PNG: its map from above, or, with a view, the
/// part in the colours of the map. `full` is the difference with the saturated colour. Nothing if stopped,
/// or, with an error, if the section plane of the view does not intersect the part.
std::optional<std::string> comparison_picture(const Simulation& simulation, const Comparison& comparison,
                                              Length full, const std::optional<View>& view,
                                              Diagnostics& diagnostics, Progress* progress = nullptr);

/// A plane across an axis: "x=25", "y=-3.5", "z=0.25in". Nothing for any other text.
std::optional<Section> parse_section(std::string_view text);
/// "x=25"
std::string to_string(const Section& section);

/// An output file; its ending determines the format.
struct PartFile {
  std::string path;
  std::optional<MeshFormat> mesh;
  bool is_left = false;     // left-over stock
  bool is_program = false;  // the job's program: kerf/job/program_file.h
  bool is_sheet = false;    // a setup sheet, .html or .svg
  bool is_picture() const { return !mesh && !is_left && !is_program && !is_sheet; }
};
/// Nothing for an ending of no supported format.
std::optional<PartFile> part_file(const std::string& path);

/// False, with an error for each, if a job of this kind cannot be written to one of the files.
bool can_write(const std::vector<PartFile>& files, JobKind kind, Diagnostics& diagnostics);

/// What a picture shows. `automatic`: the part, or the toolpath if no material is removed.
enum class PictureContent : std::uint8_t { automatic, part, path };

struct PartFileOptions {
  View view = {};  // of pictures
  PictureContent content = PictureContent::automatic;
  Grooves grooves = Grooves::closed;
  /// Nothing: exact for meshes, within kViewedMeshTolerance if all files are GLB; for pictures of columns
  /// smaller than the pixels, to which the job is cut again if necessary.
  std::optional<SurfaceDetail> detail = {};
  std::optional<Length> tolerance = {};   // of meshes; nothing: as in SurfaceOptions
  BeadColours beads = BeadColours::tool;  // of a print
  std::vector<MotionColours> motions = {};
  const Machine* machine = nullptr;  // of setup sheets, for their times
};
/// The colours of the beads of a print with their meanings, red of hazards first.
std::vector<std::pair<std::string, std::array<std::uint8_t, 3>>> bead_legend(const Toolpath& path,
                                                                             BeadColours by);
/// Distance of the triangles of the meshes among the files from the surfaces of a part that is cut, as it was
/// asked for or by default. Nothing without a mesh, and for bars and prints, whose meshes are those of the
/// columns.
std::optional<Length> mesh_tolerance(const std::vector<PartFile>& files, const JobRun& run,
                                     const PartFileOptions& options);
/// Writes pictures of the toolpath; all files must be pictures. False, with an error, if one fails.
bool write_path(const std::vector<PartFile>& files, const Job& job, const View& view, OutputSet& set,
                Diagnostics& diagnostics);
/// Writes the files into `set`, which is not committed. Meshes are verified before. False, with an error, if
/// one fails, or if stopped.
bool write_part(const std::vector<PartFile>& files, const Job& job, const JobRun& run,
                const PartFileOptions& options, OutputSet& set, Diagnostics& diagnostics,
                Progress* progress = nullptr);

}  // namespace kerf

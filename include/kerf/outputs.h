// What a job leaves or builds, as bytes in memory and as files: meshes and pictures coloured by tool, and the
// stock of a following job.
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
#include <vector>

#include "kerf/compare.h"
#include "kerf/diagnostics.h"
#include "kerf/files.h"
#include "kerf/job.h"
#include "kerf/mesh.h"
#include "kerf/mesh_files.h"
#include "kerf/progress.h"
#include "kerf/render.h"
#include "kerf/simulate.h"

namespace kerf {

/// `exact`: surfaces and edges where the tools ended, to a few microns. `columns`: as the columns have them,
/// which is faster and suffices for pictures whose pixels are larger.
enum class SurfaceDetail : std::uint8_t { exact, columns };
/// Whether a print's surface keeps the grooves between beads, which make many more triangles.
enum class Grooves : std::uint8_t { closed, kept };

struct SurfaceOptions {
  SurfaceDetail detail = SurfaceDetail::exact;
  Grooves grooves = Grooves::closed;
};

/// A surface with the colour of each triangle: the stock's own, that of a hazard, or that of a tool.
struct PartSurface : CheckedMesh {
  std::vector<std::uint8_t> colours;      // one per triangle: an index into part_palette()
  std::vector<std::string> colour_names;  // of the palette, as far as it is used
};
std::span<const std::array<std::uint8_t, 3>> part_palette();

/// How far a surface may lie from that of all columns; no more than that one lies from the cut itself.
inline constexpr Length kMeshTolerance = mm(0.002);

/// The surface of a run. Nothing if stopped.
std::optional<PartSurface> make_surface(const Job& job, const JobRun& run, const SurfaceOptions& options,
                                        Diagnostics& diagnostics, Progress* progress = nullptr);
/// The bytes of a mesh file, with a name for formats that hold one. Nothing, with an error, where the mesh is
/// unsound.
std::optional<std::string> mesh_file(const PartSurface& surface, MeshFormat format, std::string_view name,
                                     Diagnostics& diagnostics);
/// The bytes of a PNG. Nothing, with an error, where the view's section misses the part.
std::optional<std::string> picture_file(const PartSurface& surface, const View& view,
                                        Diagnostics& diagnostics);

/// The comparison of a part with its target as the bytes of a PNG: its map from above, or, with a view, the
/// part in the colours of the map. `full` is the difference that gets the full colour. Nothing if stopped,
/// or, with an error, where the view's section misses the part.
std::optional<std::string> comparison_picture(const Simulation& simulation, const Comparison& comparison,
                                              Length full, const std::optional<View>& view,
                                              Diagnostics& diagnostics, Progress* progress = nullptr);

/// A plane across an axis: "x=25", "y=-3.5", "z=0.25in". Nothing for any other text.
std::optional<Section> parse_section(std::string_view text);
/// "x=25"
std::string to_string(const Section& section);

/// A file that a part is written to, by its ending.
struct PartFile {
  std::string path;
  std::optional<MeshFormat> mesh;
  bool is_left = false;  // the stock of a following job
  bool is_picture() const { return !mesh && !is_left; }
};
/// Nothing for an ending that stands for no format.
std::optional<PartFile> part_file(const std::string& path);

/// False, with an error for each, where there are files that a job of this kind cannot be written to.
bool can_write(const std::vector<PartFile>& files, JobKind kind, Diagnostics& diagnostics);

struct PartFileOptions {
  View view = {};  // of pictures
  Grooves grooves = Grooves::closed;
};
/// Writes the files into `set`, which is not committed. Meshes are verified before. False, with an error,
/// where one fails, or if stopped.
bool write_part(const std::vector<PartFile>& files, const Job& job, const JobRun& run,
                const PartFileOptions& options, OutputSet& set, Diagnostics& diagnostics,
                Progress* progress = nullptr);

}  // namespace kerf

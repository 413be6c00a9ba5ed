// The files that a simulation is written to: meshes and pictures, chosen by their ending, coloured by tool.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/job.h"
#include "app/report/terminal_progress.h"

#include "kerf/files.h"
#include "kerf/mesh_files.h"
#include "kerf/progress.h"
#include "kerf/render.h"
#include "kerf/simulate.h"

namespace kerf::app {

/// One file asked for with -o.
struct OutputFile {
  std::string path;
  std::optional<MeshFormat> mesh;
  bool is_left = false;  // the left-over stock, for the next job
  bool is_picture() const { return !mesh && !is_left; }
};
/// Understands the names of -o. Errors (an unknown ending, a name twice, the name of an input) go to `usage`;
/// a folder that is missing or cannot be written to goes to `diagnostics`, before any work is done.
std::vector<OutputFile> read_outputs(const std::vector<std::string>& names,
                                     const std::vector<std::string>& inputs, Diagnostics& usage,
                                     Diagnostics& diagnostics);

/// An error for each file that is to hold what is left for a next job, which `what` ("a print") cannot be
/// yet.
void refuse_left(const std::vector<OutputFile>& files, std::string_view what, Diagnostics& diagnostics);
/// Puts the files into place once all are written. Nothing where that is done; else the command's end, told.
std::optional<Status> finish_outputs(Console& console, TerminalProgress& progress, bool written,
                                     OutputSet& set, Diagnostics& diagnostics);
/// The files' paths, for --json and for the summary.
Json json_of(const std::vector<OutputFile>& files);
void show_written(Console& console, const std::vector<OutputFile>& files);

/// How a picture is to be taken, as told.
struct PictureOptions {
  std::string view = "-35,50";     // "top", "iso" ... or "AZIMUTH,ELEVATION" in degrees
  std::string size = "1600x1000";  // pixels
  std::string section = "";        // "x=25"; empty: the part is not cut open
};
Option add_section(CommandParser& parser, PictureOptions& options);
/// Reads them. The text of what is wrong is put in `problem`.
std::optional<View> read_view(const PictureOptions& options, std::string& problem);
/// False, with an error, where the section of a picture does not go through what is drawn.
bool section_meets(const Mesh& mesh, const View& view, Diagnostics& diagnostics);

/// Writes a surface into `set`, as meshes, which are verified before, and pictures; what the steps of hazards
/// have made is red.
bool write_surface(const std::vector<OutputFile>& files, const LoadedProgram& program, const Mesh& mesh,
                   const VolumeRange& volume, const std::vector<std::uint32_t>& hazard_steps,
                   const View& view, OutputSet& set, Diagnostics& diagnostics, Progress& progress);
/// The steps of hazards of any kind.
template <class Hazards>
std::vector<std::uint32_t> steps_of(const Hazards& hazards) {
  std::vector<std::uint32_t> steps;
  for (const auto& hazard : hazards) steps.push_back(hazard.step);
  return steps;
}
/// How far a written surface may lie from the one of all columns; no more than that one lies from the cut
/// itself.
inline constexpr Length kMeshTolerance = mm(0.002);
/// One a step: which of them make surfaces of one colour (MeshOptions::step_groups).
std::vector<std::uint8_t> colour_groups(const Toolpath& path, const std::vector<std::uint32_t>& hazard_steps);
/// Writes all files into `set` (not committed). False where one fails or the user stops it.
bool write_outputs(const std::vector<OutputFile>& files, const Job& job, const Simulation& simulation,
                   const View& view, OutputSet& set, Diagnostics& diagnostics, Progress& progress);

}  // namespace kerf::app

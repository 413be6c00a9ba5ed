// What can be viewed besides programs: outlines as lines in the plane, and meshes as they are.
#pragma once

#include <optional>
#include <string>

#include "kerf/job/job.h"

namespace kerf::app::view {

/// Outlines (.json, .svg) or a mesh (.stl, .obj, .3mf, .glb) as a job; nothing without an error if the file
/// is neither by its ending. `unit`: of a drawing that specifies none.
std::optional<Job> load_drawing_or_mesh(const std::string& file, std::optional<Length> unit,
                                        Diagnostics& diagnostics, Progress* progress = nullptr);
/// The outlines of a DXF drawing that has no path layer, as its diagnostics say; nothing for other files and
/// errors. What they say of path layers is then replaced.
std::optional<Job> load_plain_dxf(const std::string& file, std::optional<Length> unit,
                                  Diagnostics& diagnostics, Progress* progress = nullptr);
/// Whether a job was made of a program. Nothing else is checked: it has no tools, feeds and spindle.
bool is_program(const Job& job);

}  // namespace kerf::app::view

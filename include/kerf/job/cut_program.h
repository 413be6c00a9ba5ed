// The program of a cutting job (cut_job.h) with its art, tools and stock.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/units.h"
#include "kerf/job/program.h"
#include "kerf/program/cut_job.h"

namespace kerf {

/// The shapes in a DXF drawing or an outline file; empty with an error. `unit`: of a drawing that specifies
/// none; `texts`: DrawingOutlineOptions::texts.
std::vector<ArtShape> load_art(const std::string& file, std::optional<Length> unit, Diagnostics& diagnostics,
                               StrokeShapes strokes = StrokeShapes::lines, const std::string& texts = "drawn",
                               const std::vector<std::string>& stroke_layers = {});

/// The program of a job on its shapes and those of the file `art`, if that is not empty. `where` is the file
/// of the job, for messages. Nothing, with errors, if something is missing or does not fit.
std::optional<Program> load_cut_job(const CutJob& job, const std::string& art, const std::string& where,
                                    Diagnostics& diagnostics, Progress* progress = nullptr);

}  // namespace kerf

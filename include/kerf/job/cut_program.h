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

struct ArtOptions {
  std::optional<Length> unit;  ///< of a drawing that specifies none
  StrokeShapes strokes = StrokeShapes::lines;
  std::string texts = "drawn";             ///< DrawingOutlineOptions::texts
  std::vector<std::string> stroke_layers;  ///< DrawingOutlineOptions::stroke_layers
};
/// The shapes in a drawing or an outline file; empty with an error, also of a stopped run.
std::vector<ArtShape> load_art(const std::string& file, const ArtOptions& options, Diagnostics& diagnostics,
                               Progress* progress = nullptr);

/// The program of a job on its shapes and those of the file `art`, if that is not empty. `where` is the file
/// of the job, for messages. Nothing, with errors, if something is missing or does not fit.
std::optional<Program> load_cut_job(const CutJob& job, const std::string& art, const std::string& where,
                                    Diagnostics& diagnostics, Progress* progress = nullptr);

}  // namespace kerf

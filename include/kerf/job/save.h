// A job from a file, and its results as files: one call each, for programs that need no step between.
//
//   Diagnostics diagnostics;
//   if (const auto job = load_job("part.nc", {}, diagnostics)) {
//     save_part(*job, {"part.stl", "part.png"}, {}, diagnostics);
//     save_program(*job, "grbl", "out.nc", {}, diagnostics);
//   }
//
// Files appear whole or not at all.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/job/job.h"
#include "kerf/job/outputs.h"
#include "kerf/job/posting.h"
#include "kerf/job/program.h"

namespace kerf {

struct LoadOptions {
  ProgramOptions program = {};
  JobSettings job = {};
  UnknownTool unknown = UnknownTool::error;
};
/// Reads a program and makes its job: load_program() and make_job_or_print(). Nothing if there is an error.
std::optional<Job> load_job(const std::string& file, const LoadOptions& options, Diagnostics& diagnostics,
                            Progress* progress = nullptr);

struct SaveOptions {
  RunOptions run = {};
  PartFileOptions files = {};
};
/// Simulates a job and writes meshes, pictures and left-over stock, each in the format of its ending. False,
/// with an error, if one cannot be written, or if stopped: then there is none.
bool save_part(const Job& job, const std::vector<std::string>& files, const SaveOptions& options,
               Diagnostics& diagnostics, Progress* progress = nullptr);

/// Writes a program for a controller or as a drawing: post_program() with the target of this name. With one
/// file per tool their names are those of posted_file_names(). False, with an error, if it cannot be written.
bool save_program(const Program& program, std::string_view target, const std::string& file,
                  const PostingOptions& options, Diagnostics& diagnostics, Progress* progress = nullptr);
/// The program of a job, with the tools and the stock of the job as comments: program_of().
bool save_program(const Job& job, std::string_view target, const std::string& file,
                  const PostingOptions& options, Diagnostics& diagnostics, Progress* progress = nullptr);

}  // namespace kerf

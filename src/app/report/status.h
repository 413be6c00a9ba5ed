// How a command ends: its exit status, and what is printed with it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/report/console.h"
#include "app/report/terminal_progress.h"
#include "job/record/record.h"

#include "kerf/base/diagnostics.h"
#include "kerf/job/outputs.h"

namespace kerf::app {

/// The exit statuses of every subcommand; stable, for scripts.
enum class Status : int { done = 0, input_errors = 1, wrong_usage = 2, hazards = 3, interrupted = 130 };

/// The object of --json for one file.
void print_object(Console& console, const Record& object);
/// Ends a run without a result: prints the diagnostics as text, or with --json as an object without other
/// keys.
Status fail(Console& console, const Diagnostics& diagnostics, Status status);
/// The status of several files together: an error before a hazard, and the first interruption.
Status worse(Status a, Status b);
/// Reports that the user interrupted the run.
Status report_stopped(Console& console);
/// Renames the files to their names if all are `written`. Returns the exit status after an error, else
/// nothing.
std::optional<Status> finish_outputs(Console& console, TerminalProgress& progress, bool written,
                                     OutputSet& set, Diagnostics& diagnostics);

/// The files' paths, for --json and for the summary.
void show_written(Console& console, const std::vector<PartFile>& files);

}  // namespace kerf::app

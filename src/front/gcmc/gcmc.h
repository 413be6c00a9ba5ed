// The front end for gcmc programs: from the language of the G-Code Meta Compiler to a toolpath, or to the
// text that the real program writes.
//
//   GcmcOptions options;
//   options.file_name = "part.gcmc";
//   GcmcRun run = run_gcmc(text, options, output, diagnostics);
//
// The messages of a program (message(), warnings, errors) are passed to GcmcOutput while it runs, in order,
// and are also collected in the Diagnostics. Lengths in the text are mm, or inch with `imperial`; the
// toolpath is always in mm. Intended differences from the real program: docs/differences.md.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "front/gcmc/value/gcmc_options.h"

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/path/toolpath.h"

namespace kerf {

struct GcmcRun {
  Toolpath path;
  /// The real program's exit status: 0, 1 after errors, or what the program returned.
  int status = 0;
  std::size_t warnings = 0;  // of the language and by warning(); errors with option -W
  bool completed = false;    // ran to its end or to a return; calls of error() do not matter
  bool stopped = false;      // by Progress::stop_requested
  /// Layers in the order of their stack; empty if the program has none.
  std::vector<std::string> layers;
  /// The sources: name as in messages, and text.
  std::vector<std::pair<std::string, std::string>> sources;
};

/// Parses and runs a program. With a syntax error it does not run; after a runtime error, path and text end
/// before it. Errors and warnings are appended to `diagnostics`.
GcmcRun run_gcmc(std::string_view text, const GcmcOptions& options, GcmcOutput& output,
                 Diagnostics& diagnostics, Progress* progress = nullptr);

/// Parses only, for editors. Returns true if there is no error.
bool check_gcmc(std::string_view text, const GcmcOptions& options, GcmcOutput& output,
                Diagnostics& diagnostics);

}  // namespace kerf

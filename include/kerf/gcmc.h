// gcmc programs in: the G-Code Meta Compiler's language becomes a toolpath, or the text that the real program
// writes.
//
//   GcmcOptions options;
//   options.file_name = "part.gcmc";
//   GcmcRun run = run_gcmc(text, options, output, diagnostics);
//
// What a program says (message(), warnings, errors) goes to GcmcOutput while it runs, in the order said, and
// is collected in the Diagnostics as well. Lengths of the text are mm, or inch where `imperial` is set; the
// toolpath is mm always. Where Kerf differs from the real program on purpose: docs/differences.md.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/gcmc_options.h"
#include "kerf/progress.h"
#include "kerf/toolpath.h"

namespace kerf {

/// Names of texts that are no files: the defines, and the files of Kerf's own library ("<kerf>/NAME").
inline constexpr std::string_view kGcmcDefinesName = "<cmd-line defines>";
inline constexpr std::string_view kGcmcLibraryPrefix = "<kerf>/";

struct GcmcRun {
  Toolpath path;
  /// The real program's exit status: 0, 1 after errors, or what the program returned.
  int status = 0;
  std::size_t warnings = 0;  // of the language and by warning(); what option -W makes an error of
  bool completed = false;    // ran to its end or to a return; errors of its own may have been said
  bool stopped = false;      // by Progress::stop_requested
  /// Layers in order of their stack, where the program named any.
  std::vector<std::string> layers;
  /// The texts that took part: name as in messages, bytes. For showing lines.
  std::vector<std::pair<std::string, std::string>> sources;
};

/// Parses and runs a program. After a syntax error nothing runs; after a runtime error path and text hold
/// what was made before it. Errors and warnings are appended to `diagnostics`.
GcmcRun run_gcmc(std::string_view text, const GcmcOptions& options, GcmcOutput& output,
                 Diagnostics& diagnostics, Progress* progress = nullptr);

/// Parses only: what an editor asks. Returns true where there is no error.
bool check_gcmc(std::string_view text, const GcmcOptions& options, GcmcOutput& output,
                Diagnostics& diagnostics);

}  // namespace kerf

// Running a user's Python script with Kerf's modules on its path.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"

namespace kerf {

/// Where the script's standard output goes: to stderr if the caller prints a result of its own.
enum class ScriptOutput { to_stdout, to_stderr };

/// Bytes of the output file of a script, beyond which it is ended.
inline constexpr std::size_t kMaxScriptOutput = std::size_t{64} << 20;

struct ScriptOptions {
  std::vector<std::string> arguments = {};                            // of the script
  std::vector<std::pair<std::string, std::string>> environment = {};  // added to that of this process
  ScriptOutput output = ScriptOutput::to_stderr;
  std::string output_file = {};      // instead, if given: standard output and error; at most kMaxScriptOutput
  std::string* error_end = nullptr;  // gets the end of standard error, which is shown as well
  Progress* progress = nullptr;      // if stopped, the script and the processes that it has started are ended
};

/// The folder of Kerf's Python modules: next to the command in a build folder, or below the prefix where the
/// command is installed; empty if the interpreter has them (a wheel).
std::string python_module_folder();

/// Warns of a file in the script's folder, which comes first on the path, that `import kerf` finds instead of
/// Kerf's module.
void warn_of_hidden_module(const std::string& script, Diagnostics& diagnostics);

/// Runs `script` with $KERF_PYTHON, else the virtual environment's python, else python3, with Kerf's modules
/// on its path. Returns its exit status; -1, with an error, if it could not be started or was ended by a
/// signal, and if it was stopped.
int run_python(const std::string& script, const ScriptOptions& options, Diagnostics& diagnostics);

/// An error for a script that ended with this status: the message of its last traceback in `output`, at the
/// innermost line of the script or of a module beside it; the hint has the lines that called it.
void add_script_failure(const std::string& script, int status, const std::string& output,
                        Diagnostics& diagnostics);

}  // namespace kerf

// Python scripts: the program that a script makes with Kerf's modules.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/system.h"

#include "kerf/job/program.h"

namespace kerf::app::view {

bool is_script(const std::string& file);

/// The results of a script, in a private folder that is removed with this.
class ScriptRun {
 public:
  /// Runs the script. The program is what it has simulated, written or ended last; its files are the script
  /// and those of its lines that are the origins of steps. `used` are the script and the modules of its
  /// folder that it imports. Nothing, with the last error of the script at its line, if it fails; nothing
  /// without an error if it is stopped.
  std::optional<Program> load(const std::string& script, const ProgramOptions& options,
                              std::vector<std::string>& used, Diagnostics& diagnostics, Progress* progress);

  /// The end of what the last run has printed, up to 64 kB.
  std::string output() const;

 private:
  TemporaryFolder folder_;
};

}  // namespace kerf::app::view

// Programs that Kerf starts: a user's script with its output and its end, a browser.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "kerf/base/progress.h"

namespace kerf {

struct ProcessOptions {
  std::vector<std::pair<std::string, std::string>> environment = {};  // added to that of this process
  bool output_to_error = false;      // standard output goes to standard error
  std::string* error_end = nullptr;  // of a process without progress: gets the end of what goes there
  std::string output_file = {};      // instead, if given: standard output and error
  std::size_t output_limit = 0;      // bytes of the output file, beyond which the program is ended; 0: none
  Progress* progress = nullptr;      // if given, the processes that the program has started end with it; if
                                     // stopped, all of them are ended
};

/// Bytes of `error_end`.
inline constexpr std::size_t kErrorEnd = 16'384;

struct ProcessEnd {
  enum class Kind {
    exited,
    ended_by_signal,
    not_found,
    not_started,
    stopped,
    output_limit
  } kind = Kind::not_started;
  int number = 0;  // the exit status, or the signal
};

/// Runs the program `words[0]`, which is searched for in PATH, and waits for its end.
ProcessEnd run_process(const std::vector<std::string>& words, const ProcessOptions& options);

/// Starts a program that outlives this one and need not be waited for. False if that fails.
bool start_detached(const std::vector<std::string>& words);

}  // namespace kerf

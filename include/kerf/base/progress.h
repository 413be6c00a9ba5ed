// Progress and cancellation of long work: the one interface that callers of the library implement.
#pragma once

#include <string_view>

namespace kerf {

/// Passed (may be null) to every function that can take noticeable time. Calls come from one
/// thread at a time. The command draws a bar from it, the Python module checks for Ctrl-C in it.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A new phase starts; `what` is a phrase such as "cutting". report() then gets its fraction, 0 to 1.
  virtual void phase(std::string_view what) = 0;
  virtual void report(double fraction) = 0;
  /// True: stop as soon as possible, write nothing, and return the result of a stopped run as documented by
  /// the function.
  virtual bool stop_requested() = 0;
};

/// Null-safe helpers.
inline void report(Progress* progress, double fraction) {
  if (progress != nullptr) progress->report(fraction);
}
inline bool stop_requested(Progress* progress) { return progress != nullptr && progress->stop_requested(); }

}  // namespace kerf

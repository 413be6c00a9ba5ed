// Long work says how far it is and can be stopped: the one interface that callers of the library implement.
#pragma once

#include <string_view>

namespace kerf {

/// Passed (may be null) to every function whose work can take longer than a moment. Calls come from one
/// thread at a time. The command draws a bar from it, the Python module checks for Ctrl-C in it.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A new phase begins; `what` is a phrase such as "cutting", `share` of it done is reported from 0 to 1.
  virtual void phase(std::string_view what) = 0;
  virtual void report(double share) = 0;
  /// True: stop as soon as possible, write nothing, return what a stopped run returns (each function says
  /// what).
  virtual bool stop_requested() = 0;
};

/// Null-safe helpers, so that callees need no tests of their own.
inline void report(Progress* progress, double share) {
  if (progress != nullptr) progress->report(share);
}
inline bool stop_requested(Progress* progress) { return progress != nullptr && progress->stop_requested(); }

}  // namespace kerf

// The states of a program and of what a pass has made of it so far: for passes that repeat or move cuts.
#pragma once

#include <cstddef>
#include <string_view>

#include "path/state.h"

#include "kerf/base/diagnostics.h"

namespace kerf::op_detail {

class PassState {
 public:
  /// Both paths must outlive it; steps are only appended to `out`.
  PassState(const Toolpath& path, Toolpath& out, Diagnostics& diagnostics)
      : path_(path), out_(out), diagnostics_(diagnostics), source_(path) {}

  /// After all steps of the result.
  const PathState& now();
  /// Before step `i` of the source; must not go back.
  const PathState& before(std::size_t i);
  /// Appends what leads from now() to `wanted` in these parts, with the origin of step `i`. Returns the parts
  /// that cannot be restored.
  StateParts restore(const PathState& wanted, StateParts parts, std::size_t i);
  /// The same, with a warning for those parts, the first time. `what`: "the passes of this cut".
  void restore_or_warn(const PathState& wanted, StateParts parts, std::size_t i, std::string_view what);
  void warn(StateParts lost, std::size_t i, std::string_view what);

 private:
  const Toolpath& path_;
  Toolpath& out_;
  Diagnostics& diagnostics_;
  StateReader source_;
  PathState now_;
  std::size_t synced_ = 0;  // steps of the result that `now_` has passed
  bool warned_ = false;
};

}  // namespace kerf::op_detail

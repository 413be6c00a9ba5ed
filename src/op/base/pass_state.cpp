// The states of a program and of the result of a pass.
#include "op/base/pass_state.h"

#include <fmt/format.h>

#include "base/codes/op.h"

namespace kerf::op_detail {

const PathState& PassState::now() {
  for (; synced_ < out_.size(); ++synced_) now_.pass(out_, synced_);
  return now_;
}

const PathState& PassState::before(std::size_t i) {
  source_.to(i);
  return source_.state();
}

StateParts PassState::restore(const PathState& wanted, StateParts parts, std::size_t i) {
  if ((difference(now(), wanted) & parts) == 0) return 0;
  const StateParts lost = kerf::restore(now_, wanted, parts, out_.copy_origin(path_, i), out_);
  synced_ = out_.size();
  return lost;
}

void PassState::restore_or_warn(const PathState& wanted, StateParts parts, std::size_t i,
                                std::string_view what) {
  warn(restore(wanted, parts, i), i, what);
}

void PassState::warn(StateParts lost, std::size_t i, std::string_view what) {
  if (lost == 0 || warned_) return;
  warned_ = true;
  diagnostics_
      .warning(codes::pass_refused, path_.origin_of(i),
               fmt::format("{} start in another state than the program does here: it sets {} later, and what "
                           "was in force before is unknown",
                           what, to_text(lost)))
      .hint = "set it at the start of the program";
}

}  // namespace kerf::op_detail

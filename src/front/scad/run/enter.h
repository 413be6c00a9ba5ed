// A call of a function or module while it runs: its trace, the limit of recursion, its special variables.
#pragma once

#include "base/codes/scad.h"
#include "front/scad/run/interpreter.h"

namespace kerf::scad {

class Enter {
 public:
  Enter(Interpreter& run, Position at, const std::string* name)
      : run_(run), trace_{run.trace_, at, name}, mark_(run.special_mark()) {
    const char* here = static_cast<const char*>(__builtin_frame_address(0));
    const std::ptrdiff_t used = run.stack_start_ - here;
    if (static_cast<std::size_t>(used < 0 ? -used : used) > run.limits_.max_stack)
      run.fail(codes::scad_limit, at, "calls of " + *name + "() are nested too deep",
               "a function that ends with a call of itself may call itself any number of times");
    run.tick(at);
    run_.trace_ = &trace_;
  }
  ~Enter() {
    run_.trace_ = trace_.outer;
    run_.unwind(mark_);
  }
  Enter(const Enter&) = delete;
  Enter& operator=(const Enter&) = delete;

 private:
  Interpreter& run_;
  Trace trace_;
  std::size_t mark_;
};

}  // namespace kerf::scad

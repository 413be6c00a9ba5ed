// Calls of commands: their messages.
#include "front/scad/value/command.h"

namespace kerf::scad {

Call::Call(const Command& command, CommandState* state, CallSite& site, Diagnostics& diagnostics,
           std::vector<Value> arguments, const Object* object)
    : command_(command),
      state_(state),
      site_(site),
      diagnostics_(diagnostics),
      arguments_(std::move(arguments)),
      object_(object) {}

Diagnostic& Call::with_callers(Diagnostic& message) {
  for (DiagnosticNote& n : site_.callers()) message.notes.push_back(std::move(n));
  return message;
}
Diagnostic& Call::error(Code code, std::string message) {
  return with_callers(diagnostics_.error(code, where(), std::move(message)));
}
Diagnostic& Call::warning(Code code, std::string message) {
  return with_callers(diagnostics_.warning(code, where(), std::move(message)));
}

}  // namespace kerf::scad

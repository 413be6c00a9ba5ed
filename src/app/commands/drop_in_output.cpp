// Messages of the path drawing commands.
#include "app/commands/drop_in_output.h"

#include <cstdio>
#include <fmt/format.h>

#include "kerf/pathdxf.h"

namespace kerf::app {

void print_line(std::string_view text) { fmt::print(stderr, "---- {}\n", text); }

void print_messages(const Diagnostics& diagnostics, bool explain) {
  for (const Diagnostic& d : diagnostics.list()) {
    if (d.severity == Severity::note && !explain) continue;
    fmt::print(stderr, "{} {}\n", d.severity == Severity::error ? "****" : "----", pathdxf_line(d));
    if (explain && !d.hint.empty()) fmt::print(stderr, "         {}\n", d.hint);
  }
  for (const Code code : diagnostics.dropped_codes())
    fmt::print(stderr, "**** ... {} more of these: {}\n", diagnostics.dropped(code), meaning_of(code));
}

}  // namespace kerf::app

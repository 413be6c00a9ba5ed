// Messages of the path drawing commands.
#include "app/commands/drop_in_output.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>

#include "front/pathdxf/pathdxf.h"

namespace kerf::app {
namespace {

std::string_view mark(Severity severity) { return severity == Severity::error ? "****" : "----"; }

}  // namespace

void print_line(std::string_view text) { fmt::print(stderr, "---- {}\n", text); }

void print_messages(const Diagnostics& diagnostics, bool explain) {
  for (const Diagnostic& d : diagnostics.list()) {
    if (d.severity == Severity::note && !explain) continue;
    fmt::print(stderr, "{} {}\n", mark(d.severity), pathdxf_line(d));
    if (explain && !d.hint.empty()) fmt::print(stderr, "         {}\n", d.hint);
  }
  for (const Code code : diagnostics.dropped_codes()) {
    // What is not kept is of the severity of what is.
    Severity severity = Severity::note;
    for (const Diagnostic& d : diagnostics.list())
      if (d.code == code) severity = std::max(severity, d.severity);
    if (severity == Severity::note && !explain) continue;
    fmt::print(stderr, "{} ... {} more of these: {}\n", mark(severity), diagnostics.dropped(code),
               meaning_of(code));
  }
}

}  // namespace kerf::app

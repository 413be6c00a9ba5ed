// Printing: plain stdio, so that nothing is buffered twice and a failed write is seen.
#include "app/console.h"

#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <unistd.h>

namespace kerf::app {
namespace {

constexpr std::string_view kPlain = "\x1b[0m";

std::string_view colour_of(Severity severity) {
  switch (severity) {
    case Severity::error: return "\x1b[1;31m";
    case Severity::warning: return "\x1b[1;33m";
    case Severity::note: break;
  }
  return "\x1b[1;36m";
}

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

bool dumb_terminal() {
  const char* term = std::getenv("TERM");
  return term == nullptr || std::string_view(term) == "dumb";
}

/// Control bytes of a hostile file must not reach the terminal; line ends and letters of any script may.
std::string printable(std::string text) {
  for (char& c : text)
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f) c = '?';
  return text;
}

}  // namespace

bool stderr_is_terminal() { return isatty(STDERR_FILENO) != 0 && !dumb_terminal(); }

bool stderr_has_colour() { return stderr_is_terminal() && !is_set("NO_COLOR"); }

void Console::print(std::string_view text) { print_json(printable(std::string(text))); }

void Console::print_json(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stdout); }

void Console::summary(std::string_view line) {
  if (options_.quiet || options_.json) return;
  print(line);
  print("\n");
}

void Console::show(const Diagnostics& diagnostics, Channel channel) {
  if (options_.json && channel == Channel::text_or_object) return;
  std::fflush(stdout);
  for (const Diagnostic& d : diagnostics.list()) {
    if (options_.quiet && d.severity == Severity::note) continue;
    std::string text = printable(to_string(d));
    if (colour_) {
      const std::string place = to_string(d.where);
      const std::size_t at = place.empty() ? 0 : place.size() + 2;
      text.insert(at + to_string(d.severity).size(), kPlain);
      text.insert(at, colour_of(d.severity));
    }
    fmt::print(stderr, "{}\n", text);
  }
  for (const Code code : diagnostics.dropped_codes())
    fmt::print(stderr, "... and {} more of {} [{}]\n", diagnostics.dropped(code), name_of(code),
               static_cast<unsigned>(code));
}

void Console::complain(std::string_view message) {
  std::fflush(stdout);
  const std::string text = printable(std::string(message));
  if (colour_) {
    fmt::print(stderr, "kerf: {}error{}: {}\n", colour_of(Severity::error), kPlain, text);
  } else {
    fmt::print(stderr, "kerf: error: {}\n", text);
  }
}

bool Console::finish() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

}  // namespace kerf::app

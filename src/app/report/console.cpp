// Printing with stdio, so that nothing is buffered twice and failed writes are detected.
#include "app/report/console.h"

#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "base/system.h"

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

/// --color: set once, before anything is printed.
std::optional<bool>& colours_chosen() {
  static std::optional<bool> chosen;
  return chosen;
}

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

bool dumb_terminal() {
  const char* term = std::getenv("TERM");
  return term == nullptr || std::string_view(term) == "dumb";
}

/// Replaces control characters except line end and tab; bytes of UTF-8 stay.
std::string printable(std::string text) {
  for (char& c : text)
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f) c = '?';
  return text;
}

/// Diagnostics with the same code and message at different lines of a file.
struct Group {
  std::vector<const Diagnostic*> same;
  std::size_t not_kept = 0;  // counted by Diagnostics, but not kept
  std::size_t others = 0;    // with the same code and other messages, beyond kMaxTextsOfCode
};

/// The line of a location in a text; 0 for other origins.
std::uint32_t line_of(const Diagnostic& diagnostic) {
  const auto* where = std::get_if<TextLocation>(&diagnostic.where);
  return where == nullptr ? 0 : where->line;
}

std::string_view file_of(const Diagnostic& diagnostic) {
  const auto* where = std::get_if<TextLocation>(&diagnostic.where);
  return where == nullptr ? std::string_view() : std::string_view(where->file);
}

/// Maximum number of different messages of one code; invalid input gives a different one at each line.
constexpr std::size_t kMaxTextsOfCode = 10;

/// In the order of the first diagnostic of each group. One without a line, or with notes, is its own group.
std::vector<Group> groups_of(const Diagnostics& diagnostics) {
  std::vector<Group> groups;
  std::map<std::tuple<Code, std::string_view, std::string_view>, std::size_t> index;
  std::map<Code, std::size_t> last_of_code;
  std::map<Code, std::size_t> texts;
  for (const Diagnostic& d : diagnostics.list()) {
    if (texts[d.code] == kMaxTextsOfCode && line_of(d) != 0 &&
        index.count({d.code, d.message, file_of(d)}) == 0) {
      ++groups[last_of_code[d.code]].others;
      continue;
    }
    const auto [it, is_new] = index.try_emplace({d.code, d.message, file_of(d)}, groups.size());
    if (is_new || !d.notes.empty() || line_of(d) == 0) {
      last_of_code[d.code] = groups.size();
      if (line_of(d) != 0) ++texts[d.code];
      groups.push_back({{&d}});
    } else {
      groups[it->second].same.push_back(&d);
    }
  }
  for (const Code code : diagnostics.dropped_codes())
    if (const auto it = last_of_code.find(code); it != last_of_code.end())
      groups[it->second].not_kept = diagnostics.dropped(code);
  return groups;
}

/// "\n  and 48 more in line 13, 15, 17 ..." for the diagnostics of a group after the first one.
std::string more_of(const Group& group) {
  constexpr std::size_t kLinesNamed = 5;
  if (group.others > 0)
    return fmt::format("\n  and {} more [{}] (--json lists {})",
                       group.same.size() - 1 + group.others + group.not_kept,
                       static_cast<int>(group.same.front()->code), group.not_kept > 0 ? "some" : "them");
  const std::size_t more = group.same.size() - 1 + group.not_kept;
  if (more == 0) return {};
  std::string lines;
  std::size_t named = 0;
  std::uint32_t last = line_of(*group.same.front());
  for (std::size_t i = 1; i < group.same.size() && named < kLinesNamed; ++i) {
    const std::uint32_t line = line_of(*group.same[i]);
    if (line == last) continue;
    last = line;
    lines += fmt::format("{}{}", named++ == 0 ? " in line " : ", ", line);
  }
  return fmt::format("\n  and {} more{}{}", more, lines, named == kLinesNamed ? " ..." : "");
}

}  // namespace

bool stderr_is_terminal() { return is_terminal(Stream::error) && !dumb_terminal(); }

bool choose_colours(std::string_view when) {
  if (when != "auto" && when != "always" && when != "never") return false;
  colours_chosen() = when == "auto" ? std::nullopt : std::optional(when == "always");
  return true;
}

bool stderr_has_colour() { return colours_chosen().value_or(stderr_is_terminal() && !is_set("NO_COLOR")); }

void Console::print(std::string_view text) {
  const std::string shown = printable(std::string(text));
  std::fwrite(shown.data(), 1, shown.size(), sends_output() ? stderr : stdout);
}

void Console::print_output(std::string_view text) {
  if (json())
    std::fwrite(text.data(), 1, text.size(), stderr);
  else if (is_terminal(Stream::output))
    print_json(printable(std::string(text)));
  else
    print_json(text);
}

void Console::print_json(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stdout); }

void Console::summary(std::string_view line) {
  if (quiet() || json()) return;
  print(line);
  print("\n");
}

void Console::show(const Diagnostics& diagnostics, Channel channel) {
  if (json() && channel == Channel::text_or_object) return;
  std::fflush(stdout);
  for (const Group& group : groups_of(diagnostics)) {
    const Diagnostic& first = *group.same.front();
    if (options_.quiet && first.severity == Severity::note) continue;
    std::string text = printable(to_string(first) + more_of(group));
    if (colour_) {
      const std::string where = to_string(first.where);
      const std::size_t at = where.empty() ? 0 : where.size() + 2;
      text.insert(at + to_string(first.severity).size(), kPlain);
      text.insert(at, colour_of(first.severity));
    }
    fmt::print(stderr, "{}\n", text);
  }
}

void Console::error(std::string_view message) {
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

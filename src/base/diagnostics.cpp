// Diagnostics: the table of codes, collecting with a limit, and the text form.
#include "kerf/base/diagnostics.h"

#include <cassert>
#include <fmt/format.h>
#include <utility>

#include "kerf/base/limits.h"

namespace kerf {
namespace {

struct CodeEntry {
  Code code;
  std::string_view name;
  std::string_view meaning;
};

#define KERF_CODE(number, name, meaning) {Code{number}, #name, meaning},
constexpr CodeEntry kCodes[] = {
#include "base/codes/files.def"
#include "base/codes/gcmc.def"
#include "base/codes/gcode.def"
#include "base/codes/op.def"
#include "base/codes/outline.def"
#include "base/codes/path.def"
#include "base/codes/pathdxf.def"
#include "base/codes/scad.def"
#include "base/codes/sim.def"
#include "base/codes/stock.def"
#include "base/codes/tools.def"
};
#undef KERF_CODE

const CodeEntry& entry_of(Code code) {
  for (const CodeEntry& entry : kCodes)
    if (entry.code == code) return entry;
  assert(false && "a code that is in no table");
  return kCodes[0];
}

}  // namespace

std::string_view to_string(Severity severity) {
  switch (severity) {
    case Severity::note: return "note";
    case Severity::warning: return "warning";
    case Severity::error: break;
  }
  return "error";
}

Diagnostics::Diagnostics() : Diagnostics(limits::kMaxMessagesPerCode) {}

std::string_view name_of(Code code) { return entry_of(code).name; }

std::string_view meaning_of(Code code) { return entry_of(code).meaning; }

const std::vector<Code>& all_codes() {
  static const std::vector<Code> codes = [] {
    std::vector<Code> list;
    for (const CodeEntry& entry : kCodes) list.push_back(entry.code);
    return list;
  }();
  return codes;
}

std::string to_string(const Diagnostic& diagnostic) {
  const std::string where = to_string(diagnostic.where);
  std::string text =
      fmt::format("{}{}{}: {} [{}]", where, where.empty() ? "" : ": ", to_string(diagnostic.severity),
                  diagnostic.message, static_cast<unsigned>(diagnostic.code));
  for (const DiagnosticNote& note : diagnostic.notes) {
    const std::string location = to_string(note.where);
    text += fmt::format("\n  note: {}{}{}", location, location.empty() ? "" : ": ", note.text);
  }
  if (!diagnostic.hint.empty()) text += fmt::format("\n  hint: {}", diagnostic.hint);
  return text;
}

Diagnostic& Diagnostics::error(Code code, Origin where, std::string message) {
  return add({Severity::error, code, std::move(where), std::move(message), {}, {}});
}

Diagnostic& Diagnostics::warning(Code code, Origin where, std::string message) {
  return add({Severity::warning, code, std::move(where), std::move(message), {}, {}});
}

Diagnostic& Diagnostics::note(Code code, Origin where, std::string message) {
  return add({Severity::note, code, std::move(where), std::move(message), {}, {}});
}

Diagnostic& Diagnostics::add(Diagnostic diagnostic) {
  if (diagnostic.severity == Severity::error) ++errors_;
  if (diagnostic.severity == Severity::warning) ++warnings_;
  if (++seen_[static_cast<std::uint16_t>(diagnostic.code)] > limit_per_code_) {
    overflow_ = std::move(diagnostic);
    return overflow_;
  }
  return list_.emplace_back(std::move(diagnostic));
}

std::size_t Diagnostics::dropped(Code code) const {
  const auto it = seen_.find(static_cast<std::uint16_t>(code));
  return it == seen_.end() || it->second <= limit_per_code_ ? 0 : it->second - limit_per_code_;
}

std::vector<Code> Diagnostics::dropped_codes() const {
  std::vector<Code> codes;
  for (const CodeEntry& entry : kCodes)
    if (dropped(entry.code) > 0) codes.push_back(entry.code);
  return codes;
}

}  // namespace kerf

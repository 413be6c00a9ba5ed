// Diagnostics: errors, warnings and notes about the user's input, with origin, stable code and hint.
//
// A function that can fail on user input returns its value and appends to a `Diagnostics` passed in. Nothing
// in the library prints, exits or throws across a public header. All codes are in the tables of
// `src/base/codes`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "kerf/base/origin.h"

namespace kerf {

enum class Severity : std::uint8_t { note, warning, error };
std::string_view to_string(Severity severity);

/// The stable number of a diagnostic. The tables are `src/base/codes/*.def`; a header beside each has its
/// constants, `codes::no_feed` in codes/gcode.h, so that a new code compiles again only what uses that table.
enum class Code : std::uint16_t {};
/// The code's name in its table, e.g. "no_feed".
std::string_view name_of(Code code);
/// The meaning of the code, one sentence from its table.
std::string_view meaning_of(Code code);
/// Every code of all tables, for documentation and tests.
const std::vector<Code>& all_codes();

struct DiagnosticNote {
  Origin where;
  std::string text;
};

struct Diagnostic {
  Severity severity = Severity::error;
  Code code{};
  Origin where;
  std::string message;
  std::vector<DiagnosticNote> notes;
  std::string hint;
};

/// "part.nc:3:7: error: no number after X [2003]" and its notes and hint on lines of their own.
std::string to_string(const Diagnostic& diagnostic);

/// Collects the diagnostics of a run, in order. At most `limit_per_code` of one code are kept, further ones
/// are only counted: the memory for a broken file is bounded.
class Diagnostics {
 public:
  Diagnostics();  ///< with limits::kMaxMessagesPerCode
  explicit Diagnostics(std::size_t limit_per_code) : limit_per_code_(limit_per_code) {}

  /// Appends; notes and a hint can be added to the returned reference, which is valid until the next call.
  Diagnostic& error(Code code, Origin where, std::string message);
  Diagnostic& warning(Code code, Origin where, std::string message);
  Diagnostic& note(Code code, Origin where, std::string message);
  Diagnostic& add(Diagnostic diagnostic);

  /// Removes the diagnostics for which `test` is true, and the counts of dropped ones of their codes.
  template <class Test>
  void remove_if(Test test);

  bool has_errors() const { return errors_ > 0; }
  std::size_t errors() const { return errors_; }      ///< kept and counted ones
  std::size_t warnings() const { return warnings_; }  ///< kept and counted ones
  const std::vector<Diagnostic>& list() const { return list_; }
  /// Number of diagnostics of a code that were counted but not kept.
  std::size_t dropped(Code code) const;
  std::vector<Code> dropped_codes() const;

 private:
  std::size_t limit_per_code_;
  std::size_t errors_ = 0;
  std::size_t warnings_ = 0;
  std::vector<Diagnostic> list_;
  std::unordered_map<std::uint16_t, std::size_t> seen_;
  Diagnostic overflow_;  // receives the notes of diagnostics that are not kept
};

template <class Test>
void Diagnostics::remove_if(Test test) {
  std::vector<Diagnostic> rest;
  for (Diagnostic& d : list_) {
    if (!test(static_cast<const Diagnostic&>(d))) {
      rest.push_back(std::move(d));
      continue;
    }
    if (d.severity == Severity::error) --errors_;
    if (d.severity == Severity::warning) --warnings_;
    seen_[static_cast<std::uint16_t>(d.code)] = 0;
  }
  list_ = std::move(rest);
}

// Languages of messages, for commands that replace a program which has them.

enum class Language : std::uint8_t { english, german };

/// A message in both languages, in the syntax of fmt::format.
struct Bilingual {
  std::string_view english, german;
  constexpr std::string_view in(Language language) const {
    return language == Language::german ? german : english;
  }
};

}  // namespace kerf

// Messages of path drawings, in English and German, collected as diagnostics.
#pragma once

#include <fmt/format.h>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "kerf/diagnostics.h"
#include "kerf/pathdxf_options.h"

namespace kerf::pathdxf {

/// A message in both languages, in the syntax of fmt::format.
struct Bilingual {
  std::string_view english, german;
};

class Report {
 public:
  Report(const PathdxfOptions& options, Diagnostics& diagnostics)
      : options_(options), diagnostics_(diagnostics), earlier_errors_(diagnostics.errors()) {}

  template <class... Values>
  std::string text(const Bilingual& message, const Values&... values) const {
    return fmt::format(
        fmt::runtime(options_.language == PathdxfLanguage::german ? message.german : message.english),
        values...);
  }
  /// An error; one of the same text at the same origin is reported once.
  template <class... Values>
  void error(Code code, const Origin& where, const Bilingual& message, const Values&... values) {
    ++attempts_;
    add(Severity::error, code, where, text(message, values...));
  }
  template <class... Values>
  void warning(Code code, const Origin& where, const Bilingual& message, const Values&... values) {
    add(Severity::warning, code, where, text(message, values...));
  }
  template <class... Values>
  void note(Code code, const Origin& where, const Bilingual& message, const Values&... values) {
    add(Severity::note, code, where, text(message, values...));
  }
  /// Adds a hint to the latest message; none if that was reported before.
  template <class... Values>
  void hint(const Bilingual& message, const Values&... values) {
    if (latest_ != nullptr) latest_->hint = text(message, values...);
  }
  /// An information line, such as "Reading a.dxf".
  void line(std::string_view text) const {
    if (options_.report) options_.report(text);
  }
  /// Errors of this run.
  std::size_t errors() const { return diagnostics_.errors() - earlier_errors_; }
  /// Calls of error(), those included whose message was reported before.
  std::size_t attempts() const { return attempts_; }
  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  void add(Severity severity, Code code, const Origin& where, std::string message);

  const PathdxfOptions& options_;
  Diagnostics& diagnostics_;
  std::size_t earlier_errors_;
  Diagnostic* latest_ = nullptr;
  std::size_t attempts_ = 0;
  std::unordered_set<std::size_t> reported_;  // hashes of origin and text
};

}  // namespace kerf::pathdxf

// Messages of path drawings, in English and German, collected as diagnostics.
#pragma once

#include <fmt/format.h>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_set>
#include <utility>

#include "base/names.h"
#include "front/pathdxf/text/pathdxf_options.h"

#include "kerf/base/diagnostics.h"

namespace kerf::pathdxf {

/// `text` with blanks for control characters, which would break a line or change the state of a terminal.
std::string one_line(std::string text);

class Report {
 public:
  Report(const PathdxfOptions& options, Diagnostics& diagnostics)
      : options_(options), diagnostics_(diagnostics), earlier_errors_(diagnostics.errors()) {}

  /// The message with its values, on one line; long texts are clipped.
  template <class... Values>
  std::string text(const Bilingual& message, const Values&... values) const {
    return one_line(fmt::format(fmt::runtime(message.in(options_.language)), shown(values)...));
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
  template <class... Values>
  void line(const Bilingual& message, const Values&... values) const {
    if (options_.report) options_.report(fmt::format(fmt::runtime(message.in(options_.language)), values...));
  }
  /// An information line that has no words.
  void data_line(std::string_view text) const {
    if (options_.report) options_.report(text);
  }
  /// Errors of this run.
  std::size_t errors() const { return diagnostics_.errors() - earlier_errors_; }
  /// Calls of error(), those included whose message was reported before.
  std::size_t attempts() const { return attempts_; }
  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  template <class Value>
  static auto shown(const Value& value) {
    if constexpr (std::is_convertible_v<const Value&, std::string_view>)
      return clipped(value);
    else
      return value;
  }
  void add(Severity severity, Code code, const Origin& where, std::string message);

  const PathdxfOptions& options_;
  Diagnostics& diagnostics_;
  std::size_t earlier_errors_;
  Diagnostic* latest_ = nullptr;
  std::size_t attempts_ = 0;
  std::unordered_set<std::size_t> reported_;  // hashes of origin and text
};

}  // namespace kerf::pathdxf

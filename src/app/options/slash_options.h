// Command lines of the path drawing commands: "/f150", "/f 150", "-f 150", "--feed 150", "--feed=150".
#pragma once

#include <cstddef>
#include <fmt/format.h>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/options/description.h"

#include "kerf/base/diagnostics.h"

namespace kerf::app {

struct SlashOption {
  char letter;  // in lower case; '\0': none
  std::string_view name;
  bool takes_value;
  std::string_view english, german;  // empty: not listed
  bool required = false;
  bool reads = false;  // the commands that read the input as a program have it, too
};

/// The arguments one after the other. An argument that starts with a slash is a file if it exists, or if it
/// has another slash and one of the given endings.
class SlashArguments {
 public:
  SlashArguments(const std::vector<std::string>& words, std::span<const SlashOption> options, Code code,
                 std::vector<std::string_view> endings, Diagnostics& problems)
      : words_(words), options_(options), code_(code), endings_(std::move(endings)), problems_(problems) {}

  /// The language of the option "language", else the system's; of messages from then on.
  Language use_language();

  struct Argument {
    const SlashOption* option = nullptr;  // null: a file
    std::string value;
  };
  /// Invalid options are reported and skipped; nothing at the end.
  std::optional<Argument> next();
  /// A number with point or comma. Nothing for 0, and with a report for texts and numbers below 0.
  std::optional<double> positive(const std::string& value, std::string_view name);
  template <class... Values>
  void complain(const Bilingual& message, const Values&... values) {
    problems_.error(code_, {}, fmt::format(fmt::runtime(message.in(language_)), values...));
  }

 private:
  bool is_file(const std::string& word) const;
  std::optional<Argument> short_option(const std::string& word);
  std::optional<Argument> long_option(const std::string& text);
  std::optional<Argument> with_value(const SlashOption& option, const std::string& attached,
                                     const std::string& name);

  const std::vector<std::string>& words_;
  std::span<const SlashOption> options_;
  Code code_;
  std::vector<std::string_view> endings_;
  Diagnostics& problems_;
  Language language_ = Language::english;
  std::size_t at_ = 0;
};

/// A decimal number with point or comma.
std::optional<double> comma_number(std::string text);
/// German for "de...", else English.
Language language_named(std::string_view text);
/// Of the environment.
Language system_language();
/// The listed options, in English, for manual pages and completion.
std::vector<OptionDescription> option_descriptions(std::span<const SlashOption> options);
/// The listed options with their descriptions.
std::string option_table(std::span<const SlashOption> options, Language language);

}  // namespace kerf::app

// Command lines of the path drawing commands.
#include "app/options/slash_options.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>

#include "base/ending.h"
#include "base/file_names.h"
#include "base/names.h"
#include "base/number.h"

namespace kerf::app {
namespace {

/// The description of an option, and that it is required.
std::string with_need(const SlashOption& option, Language language) {
  constexpr Bilingual kRequired{"; required", "; notwendig"};
  return std::string(language == Language::german ? option.german : option.english) +
         std::string(option.required ? kRequired.in(language) : "");
}

constexpr Bilingual kNoValueAfter{"Missing value after option {}", "Nach Option {} fehlt etwas"};
constexpr Bilingual kNoValue{"Missing value for option {}", "Wert für Option {} fehlt"};
constexpr Bilingual kUnknown{"Option {} not supported", "Option {} wird nicht unterstützt"};
constexpr Bilingual kMeant{"did you mean --{}?", "Ist --{} gemeint?"};
constexpr Bilingual kNoNumber{"Option value {} for {} is not a number", "Wert {} von {} ist keine Zahl"};
constexpr Bilingual kNegative{"Option value {} for {} is not >= 0", "Wert {} von {} ist nicht >= 0"};

}  // namespace

Language SlashArguments::use_language() {
  Language language = system_language();
  Diagnostics ignored;  // reported when the arguments are read
  SlashArguments all(words_, options_, code_, endings_, ignored);
  while (const auto argument = all.next())
    if (argument->option != nullptr && argument->option->name == "language")
      language = language_named(argument->value);
  return language_ = language;
}

bool SlashArguments::is_file(const std::string& word) const {
  if (is_regular_file(word)) return true;
  const std::size_t slash = word.rfind('/');
  if (slash == 0) return false;
  return std::any_of(endings_.begin(), endings_.end(), [&](std::string_view ending) {
    return has_ending(word, ending) || is_regular_file(word + std::string(ending));
  });
}

std::optional<SlashArguments::Argument> SlashArguments::next() {
  while (at_ < words_.size()) {
    const std::string& word = words_[at_++];
    if (word.empty()) continue;
    if ((word[0] != '/' && word[0] != '-') || (word[0] == '/' && is_file(word)))
      return Argument{nullptr, word};
    if (word.size() == 1) {
      complain(kNoValueAfter, word);
      continue;
    }
    const bool is_long = word.substr(0, 2) == "--";
    if (auto option = is_long ? long_option(word.substr(2)) : short_option(word)) return option;
  }
  return std::nullopt;
}

std::optional<SlashArguments::Argument> SlashArguments::with_value(const SlashOption& option,
                                                                   const std::string& attached,
                                                                   const std::string& name) {
  if (!option.takes_value) return Argument{&option, {}};
  if (!attached.empty()) return Argument{&option, attached};
  if (at_ < words_.size()) return Argument{&option, words_[at_++]};
  complain(kNoValue, name);
  return std::nullopt;
}

std::optional<SlashArguments::Argument> SlashArguments::short_option(const std::string& word) {
  const char letter = word[1] == '?' ? 'h' : small_letter(word[1]);
  for (const SlashOption& option : options_)
    if (option.letter == letter) return with_value(option, word.substr(2), word.substr(0, 2));
  complain(kUnknown, word.substr(0, 2));
  return std::nullopt;
}

std::optional<SlashArguments::Argument> SlashArguments::long_option(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const std::string attached = equals == std::string::npos ? "" : text.substr(equals + 1);
  for (const SlashOption& option : options_)
    if (option.name == name) return with_value(option, attached, "--" + name);
  complain(kUnknown, "--" + clipped(name));
  std::vector<std::string> names;
  for (const SlashOption& option : options_) names.emplace_back(option.name);
  if (const auto close = did_you_mean(name, names)) complain(kMeant, *close);
  return std::nullopt;
}

std::optional<double> SlashArguments::positive(const std::string& value, std::string_view name) {
  const auto number = comma_number(value);
  const auto named =
      std::find_if(options_.begin(), options_.end(), [&](const SlashOption& o) { return o.name == name; });
  const bool has_letter = named != options_.end() && named->letter != '\0';
  const std::string option =
      fmt::format("--{}{}", name, has_letter ? fmt::format(" (/{})", named->letter) : "");
  if (!number) complain(kNoNumber, clipped(value), option);
  if (number && *number < 0.0) complain(kNegative, clipped(value), option);
  return number && *number > 0.0 ? number : std::nullopt;
}

std::optional<double> comma_number(std::string text) {
  std::replace(text.begin(), text.end(), ',', '.');
  return parse_number(text);
}

Language language_named(std::string_view text) {
  const bool german = text.size() >= 2 && small_letter(text[0]) == 'd' && small_letter(text[1]) == 'e';
  return german ? Language::german : Language::english;
}

Language system_language() {
  for (const char* name : {"LC_ALL", "LC_MESSAGES", "LANG"})
    if (const char* value = std::getenv(name); value != nullptr && *value != '\0')
      return language_named(value);
  return Language::english;
}

std::vector<OptionDescription> option_descriptions(std::span<const SlashOption> options) {
  std::vector<OptionDescription> out;
  for (const SlashOption& o : options) {
    if (o.english.empty()) continue;
    OptionDescription& described = out.emplace_back();
    if (o.letter != '\0') described.names.push_back(fmt::format("/{}", o.letter));
    described.names.push_back(fmt::format("--{}", o.name));
    if (o.takes_value) described.value = "VALUE";
    described.summary = with_need(o, Language::english);
  }
  return out;
}

std::string option_table(std::span<const SlashOption> options, Language language) {
  std::string text;
  for (const SlashOption& o : options) {
    if (o.english.empty()) continue;
    const std::string_view value = o.takes_value ? " ..." : "";
    const std::string letter = o.letter == '\0' ? std::string() : fmt::format("/{}{}", o.letter, value);
    text += fmt::format("    {:<7} {:<20} {}\n", letter, fmt::format("--{}{}", o.name, value),
                        with_need(o, language));
  }
  return text;
}

}  // namespace kerf::app

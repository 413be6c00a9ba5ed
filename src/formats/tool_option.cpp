// A tool from an option: a number, a name, or a shape with its dimensions.
#include <fmt/format.h>

#include "base/codes/tools.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"
#include "formats/settings.h"

#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxDigits = 9;  // of limits::kMaxToolNumber

/// Words between blanks or commas; "=" binds to both sides even with blanks around it.
std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  std::size_t at = 0;
  const auto blank = [&](std::size_t i) {
    return static_cast<unsigned char>(text[i]) <= ' ' || text[i] == ',';
  };
  const auto skip = [&] {
    while (at < text.size() && blank(at)) ++at;
  };
  for (skip(); at < text.size(); skip()) {
    const std::size_t start = at;
    while (at < text.size() && !blank(at)) {
      if (text[at++] == '=') skip();
      std::size_t ahead = at;
      while (ahead < text.size() && blank(ahead)) ++ahead;
      if (ahead < text.size() && text[ahead] == '=') at = ahead;
    }
    words.push_back(text.substr(start, at - start));
  }
  return words;
}

bool is_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

std::optional<int> whole_number(std::string_view text) {
  if (!is_digits(text) || text.size() > kMaxDigits) return std::nullopt;
  const auto value = parse_number(text);
  return value ? std::optional(static_cast<int>(*value)) : std::nullopt;
}

/// A tool of the table, or the tool described by a six-digit number.
std::optional<Tool> tool_of_number(int number, const Origin& where, Diagnostics& diagnostics) {
  if (const Tool* known = built_in_tools().find(number)) return *known;
  if (number >= 100000 && number <= 999999) {
    const auto shape = decode_tool_number(number, where, diagnostics);
    return shape ? make_tool(number, *shape, {}, where, diagnostics) : std::nullopt;
  }
  std::vector<std::string> numbers;
  for (const auto& [known, tool] : built_in_tools().tools()) numbers.push_back(std::to_string(known));
  diagnostics.error(codes::tool_unknown, where, fmt::format("unknown tool {}", number)).hint =
      guess(std::to_string(number), numbers);
  return std::nullopt;
}

/// "square d=3.175": the words before the first "=" are the shape's name.
std::optional<Tool> tool_of_words(const std::vector<std::string_view>& words, const Origin& where,
                                  Diagnostics& diagnostics) {
  std::string name;
  std::vector<detail::Setting> settings;
  std::optional<int> number;
  bool fine = true;
  for (const std::string_view word : words) {
    const std::size_t equals = word.find('=');
    if (equals == std::string_view::npos) {
      fine = fine && settings.empty();
      if (!settings.empty()) {
        diagnostics.error(codes::tool_value_type, where,
                          fmt::format("expected KEY=VALUE, found \"{}\"", word.substr(0, 40)));
      } else {
        if (!name.empty()) name += ' ';
        name += word;
      }
      continue;
    }
    const std::string key = std::string(trim(word.substr(0, equals)));
    const std::string value = std::string(trim(word.substr(equals + 1)));
    if (key == "number") {
      number = whole_number(value);
      if (!number) diagnostics.error(codes::tool_value_type, where, "number must be a whole number");
      fine = fine && number.has_value();
    } else {
      settings.push_back({key, where, value});
    }
  }
  if (settings.empty()) {
    if (const Tool* known = built_in_tools().find_name(name)) return *known;
  }
  if (name.empty() && !settings.empty() && settings.front().key != "shape") {
    diagnostics
        .error(codes::tool_value_type, where,
               fmt::format("\"{}\" is neither a tool number nor the name of a shape",
                           settings.front().key.substr(0, 40)))
        .hint = "expected [N=]SHAPE KEY=VALUE ..., e.g. 2=\"square d=6\"";
    return std::nullopt;
  }
  const auto blank = detail::blank_shape(name, where, diagnostics);
  if (!blank) return std::nullopt;
  std::optional<Tool> tool = detail::tool_of(*blank, settings, 1.0, where, diagnostics);
  if (!tool || !fine) return std::nullopt;
  tool->number = number.value_or(0);
  return tool;
}

}  // namespace

std::optional<Tool> read_tool_option(std::string_view text, const Origin& where, Diagnostics& diagnostics) {
  if (text.size() > limits::kMaxToolOptionBytes) {
    diagnostics.error(codes::tool_value_type, where, "a tool option is at most 4096 characters long");
    return std::nullopt;
  }
  if (const auto number = whole_number(trim(text))) return tool_of_number(*number, where, diagnostics);
  if (is_digits(trim(text))) {
    diagnostics.error(
        codes::tool_unknown, where,
        fmt::format("unknown tool {}; numbers have at most {} digits", trim(text).substr(0, 40), kMaxDigits));
    return std::nullopt;
  }
  return tool_of_words(words_of(text), where, diagnostics);
}

}  // namespace kerf

// Parameter texts and variables.
#include "front/pathdxf/text/parameters.h"

#include <algorithm>

#include "base/codes/pathdxf.h"
#include "base/names.h"
#include "base/number.h"

namespace kerf::pathdxf {
namespace {

constexpr std::size_t kMaxReplacements = 1000;    // in one value
constexpr std::size_t kMaxValueBytes = 100'000;   // after replacement
constexpr std::string_view kNoVariables = "NO@";  // keys whose values are needed before variables are known

constexpr Bilingual kRepeated{"The parameter(s) {} are specified more than once in '{}'",
                              "Parameter {} mehrfach angegeben in '{}'"};
constexpr Bilingual kNoVariable{"{} parameter '{}' cannot use variable",
                                "{}-Parameter '{}' kann keine Variable verwenden"};
constexpr Bilingual kNoPathVariable{"@ path '{}' cannot use variable",
                                    "@-Pfad '{}' kann keine Variable verwenden"};
constexpr Bilingual kVariableRepeated{"Variable {} is specified more than once in '{}'",
                                      "Variable {} mehrfach angegeben in '{}'"};
constexpr Bilingual kVariableUnnamed{"Error in variable definition: no name after : in '{}'",
                                     "Fehler in Variablendefinition: kein Name nach : in '{}'"};

bool separates(char c) { return c == ' ' || c == '\n' || c == '\r'; }

/// Joins what "~" continues: a "~" before blanks or line ends is removed together with them.
std::string join_continued(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '~' || i + 1 >= text.size() || !separates(text[i + 1])) {
      out += text[i];
      continue;
    }
    while (i + 1 < text.size() && separates(text[i + 1])) ++i;
  }
  return out;
}

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    while (end < text.size() && !separates(text[end])) ++end;
    const std::string_view word = trim(text.substr(i, end - i));
    if (!word.empty()) words.push_back(word);
    i = end + 1;
  }
  return words;
}

const Parameter* find(const std::vector<Parameter>& list, std::string_view key) {
  for (const Parameter& p : list)
    if (p.key == key) return &p;
  return nullptr;
}

}  // namespace

std::size_t first_character(std::string_view text) {
  std::size_t length = text.empty() ? 0 : 1;
  while (length < text.size() && (static_cast<unsigned char>(text[length]) & 0xC0u) == 0x80u) ++length;
  return length;
}

bool parse_parameters(std::string text, const Origin& where, Report& report, ParameterText& out) {
  out = {std::move(text), where, {}, {}};
  std::string repeated;
  bool good = true;
  const std::string joined_text = join_continued(out.text);
  for (std::string_view word : split(joined_text)) {
    const bool is_variable = word[0] == ':';
    if (is_variable) word.remove_prefix(1);
    if (word.empty()) {
      report.error(codes::pathdxf_variable, where, kVariableUnnamed, out.text);
      good = false;
      continue;
    }
    const std::size_t key_length = first_character(word);
    Parameter p{std::string(word.substr(0, key_length)), std::string(word.substr(key_length))};
    std::vector<Parameter>& list = is_variable ? out.variables : out.values;
    if (find(list, p.key) != nullptr) {
      if (is_variable) {
        report.error(codes::pathdxf_variable, where, kVariableRepeated, p.key, out.text);
        good = false;
      } else if (repeated.find(p.key) == std::string::npos) {
        repeated += p.key;
      }
      continue;
    }
    if (!is_variable && kNoVariables.find(p.key) != std::string_view::npos &&
        p.value.find('=') != std::string::npos) {
      if (p.key == "@")
        report.error(codes::pathdxf_text_syntax, where, kNoPathVariable, p.value);
      else
        report.error(codes::pathdxf_text_syntax, where, kNoVariable, p.key, p.value);
      good = false;
    }
    list.push_back(std::move(p));
  }
  if (!repeated.empty()) {
    std::sort(repeated.begin(), repeated.end());
    report.error(codes::pathdxf_text_syntax, where, kRepeated, repeated, out.text);
    good = false;
  }
  return good;
}

std::optional<std::string> replace_variables(std::string_view value, const Variables& variables,
                                             std::string& unknown) {
  std::string text(value);
  std::size_t replacements = 0;
  for (std::size_t at = text.find('='); at != std::string::npos; at = text.find('=', at)) {
    const std::size_t length = first_character(std::string_view(text).substr(at + 1));
    const std::string name = text.substr(at + 1, length);
    const auto known = variables.find(name);
    if (known == variables.end()) {
      if (unknown.find(name) == std::string::npos) unknown += name;
      at += 1 + length;
      if (at >= text.size()) break;
      continue;
    }
    if (++replacements > kMaxReplacements || text.size() > kMaxValueBytes) return std::nullopt;
    text.replace(at, 1 + length, known->second);
  }
  return text;
}

std::optional<double> parse_value(std::string_view text) {
  std::string number(text);
  std::replace(number.begin(), number.end(), ',', '.');
  return parse_number(number);
}

std::optional<VariableDefinition> VariableDefinition::parse(std::string_view text) {
  VariableDefinition d;
  const std::size_t tilde = text.find('~');
  if (tilde != std::string_view::npos) {
    const auto low = parse_value(trim(text.substr(0, tilde))),
               high = parse_value(trim(text.substr(tilde + 1)));
    if (low && high) {
      d.is_range_ = true;
      d.low_ = *low;
      d.high_ = *high;
      d.values_ = {std::string(trim(text.substr(0, tilde))), std::string(trim(text.substr(tilde + 1)))};
      return d;
    }
    if (text.find(',') == std::string_view::npos) return std::nullopt;
  }
  if (text.find(',') != std::string_view::npos) {
    std::string list(text);
    list.erase(std::remove(list.begin(), list.end(), '?'), list.end());
    for (std::size_t i = 0; i <= list.size();) {
      const std::size_t end = std::min(list.find(',', i), list.size());
      d.values_.emplace_back(trim(std::string_view(list).substr(i, end - i)));
      i = end + 1;
    }
  } else if (!text.empty() && text[0] == '?') {
    for (std::size_t i = 1; i < text.size();) {
      const std::size_t length = first_character(text.substr(i));
      d.values_.emplace_back(text.substr(i, length));
      i += length;
    }
  } else if (!text.empty()) {
    d.values_.emplace_back(text);
  }
  return d.values_.empty() ? std::nullopt : std::optional(std::move(d));
}

bool VariableDefinition::permits(std::string_view value) const {
  if (!is_range_) return std::find(values_.begin(), values_.end(), value) != values_.end();
  const auto number = parse_value(value);
  return number && *number >= low_ && *number <= high_;
}

std::string VariableDefinition::example(std::size_t k) const { return values_[k % values_.size()]; }

}  // namespace kerf::pathdxf

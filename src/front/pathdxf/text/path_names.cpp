// Names of paths.
#include "front/pathdxf/text/path_names.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/codes/pathdxf.h"

namespace kerf::pathdxf {
namespace {

constexpr Bilingual kInvalid{"Invalid expression for {}: {}", "Ungültiger Ausdruck für {}: {}"};

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_integer(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
}

int sign_of(int value) { return value < 0 ? -1 : value > 0 ? 1 : 0; }

int compare_integers(std::string_view a, std::string_view b) {
  const auto significant = [](std::string_view text) {
    const std::size_t first = std::min(text.find_first_not_of('0'), text.size());
    return text.substr(first);
  };
  a = significant(a);
  b = significant(b);
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  return sign_of(a.compare(b));
}

int compare_texts(std::string_view a, std::string_view b) {
  const auto lower = [](std::string_view text) {
    std::string out(text);
    for (char& c : out)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 'a' - 'A');
    return out;
  };
  return sign_of(lower(a).compare(lower(b)));
}

}  // namespace

int compare_groups(const std::vector<std::string>& pattern, const std::vector<std::string>& path) {
  const std::size_t both = std::min(pattern.size(), path.size());
  std::size_t i = 0;
  for (; i < both && !pattern[i].empty() && !path[i].empty(); ++i) {
    const int order = is_integer(pattern[i]) && is_integer(path[i]) ? compare_integers(pattern[i], path[i])
                                                                    : compare_texts(pattern[i], path[i]);
    if (order != 0) return order;
  }
  const bool pattern_continues = i < pattern.size() && !pattern[i].empty();
  const bool path_continues = i < path.size() && !path[i].empty();
  return pattern_continues && !path_continues ? 1 : 0;
}

std::optional<PathNames> PathNames::make(const PathdxfOptions& options, Report& report) {
  const auto compile = [&](const std::string& text, LetterCase letters, std::string_view option) {
    std::string problem;
    auto pattern = Pattern::compile(text, letters, problem);
    if (!pattern) report.error(codes::pathdxf_pattern, {}, kInvalid, option, problem);
    return pattern;
  };
  auto name = compile(options.path_names, LetterCase::ignored, "/n");
  auto pattern = compile(options.file_patterns, LetterCase::distinct, "/p");
  if (!name || !pattern) return std::nullopt;
  auto exact_name = compile(options.path_names, LetterCase::distinct, "/n");
  auto range = compile(fmt::format("(?:{0})-(?:{0})", options.file_patterns), LetterCase::distinct, "/p");
  if (!range || !exact_name) return std::nullopt;
  return PathNames(std::move(*name), std::move(*exact_name), std::move(*pattern), std::move(*range),
                   options.path_names);
}

std::optional<std::string> PathNames::of_layer(std::string_view layer) const {
  std::size_t end = layer.size();
  while (end > 0 && is_letter(layer[end - 1])) --end;
  if (end > 0 && end < layer.size() && layer[end - 1] == '~') layer = layer.substr(0, end - 1);
  std::string name(layer);
  std::replace(name.begin(), name.end(), '_', '.');
  return name_.match_whole(name) ? std::optional(name) : std::nullopt;
}

bool PathNames::has_expected_case(std::string_view name) const {
  return exact_name_.match_whole(name).has_value();
}

std::optional<std::string> PathNames::in_value(std::string_view value) const {
  return name_.match_whole(value) ? std::optional<std::string>(value) : std::nullopt;
}

bool PathNames::may_contain(std::string_view file_stem, std::string_view path) const {
  const auto name = name_.match_whole(path);
  if (!name) return false;
  const auto next = [](const PatternMatch& m) { return std::max(m.end, m.start + 1); };
  for (auto m = range_.search(file_stem); m; m = range_.search(file_stem, next(*m))) {
    const auto half = m->groups.begin() + static_cast<std::ptrdiff_t>(pattern_.groups());
    if (compare_groups({m->groups.begin(), half}, name->groups) <= 0 &&
        compare_groups({half, m->groups.end()}, name->groups) >= 0)
      return true;
  }
  for (auto m = pattern_.search(file_stem); m; m = pattern_.search(file_stem, next(*m)))
    if (compare_groups(m->groups, name->groups) == 0) return true;
  return false;
}

}  // namespace kerf::pathdxf

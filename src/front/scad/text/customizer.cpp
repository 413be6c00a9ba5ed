// Reads the comments of parameters line by line: comments are no words of the language.
#include "front/scad/text/customizer.h"

#include <cctype>

namespace kerf::scad {
namespace {

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.front())) != 0) s.remove_prefix(1);
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.back())) != 0) s.remove_suffix(1);
  return s;
}

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The end of a literal at the start of `s`: a number, string, true or false, or a vector of them; npos if it
/// is something else.
std::size_t literal_end(std::string_view s) {
  if (s.empty()) return std::string_view::npos;
  if (s[0] == '"') {
    for (std::size_t i = 1; i < s.size(); ++i) {
      if (s[i] == '\\')
        ++i;
      else if (s[i] == '"')
        return i + 1;
    }
    return std::string_view::npos;
  }
  if (s[0] == '[') {
    std::size_t i = 0;
    for (bool quoted = false; i < s.size(); ++i) {
      if (s[i] == '"') quoted = !quoted;
      if (!quoted && s[i] == ']') return i + 1;
      if (!quoted && i > 0 && !is_name(s[i]) &&
          std::string_view(" ,.+-[").find(s[i]) == std::string_view::npos)
        return std::string_view::npos;
    }
    return std::string_view::npos;
  }
  std::size_t i = s[0] == '-' || s[0] == '+' ? 1 : 0;
  const std::size_t start = i;
  while (i < s.size() && (is_name(s[i]) || s[i] == '.')) ++i;
  const std::string_view word = s.substr(start, i - start);
  const bool is_number =
      !word.empty() && (std::isdigit(static_cast<unsigned char>(word[0])) != 0 || word[0] == '.');
  return is_number || word == "true" || word == "false" ? i : std::string_view::npos;
}

class Reader {
 public:
  explicit Reader(std::uint32_t source) : source_(source) {}

  /// False at the end of the parameters.
  bool line(std::string_view text, std::uint32_t number) {
    const std::string_view s = trimmed(text);
    if (s.substr(0, 7) == "module " || s.substr(0, 9) == "function ") return false;
    if (s.substr(0, 2) == "//") {
      description_ = std::string(trimmed(s.substr(2)));
      return true;
    }
    if (s.substr(0, 2) == "/*") {
      group(s.substr(2));
      return true;
    }
    assignment(s, number, static_cast<std::uint32_t>(s.empty() ? 1 : s.data() - text.data() + 1));
    description_.clear();
    return true;
  }
  std::vector<CustomParameter> list;

 private:
  void group(std::string_view comment) {
    const std::size_t open = comment.find('['), close = comment.find(']');
    if (open != std::string_view::npos && close != std::string_view::npos && open < close)
      group_ = std::string(trimmed(comment.substr(open + 1, close - open - 1)));
  }

  void assignment(std::string_view s, std::uint32_t number, std::uint32_t column) {
    std::size_t name = 0;
    while (name < s.size() && is_name(s[name])) ++name;
    if (name == 0) return;
    std::string_view rest = trimmed(s.substr(name));
    if (rest.empty() || rest[0] != '=' || rest.substr(0, 2) == "==") return;
    rest = trimmed(rest.substr(1));
    const std::size_t end = literal_end(rest);
    if (end == std::string_view::npos) return;
    const std::string_view after = trimmed(rest.substr(end));
    if (after.empty() || after[0] != ';' || group_ == "Hidden") return;
    CustomParameter p;
    p.name = std::string(s.substr(0, name));
    p.group = group_;
    p.description = description_;
    p.value = std::string(rest.substr(0, end));
    const std::string_view comment = trimmed(after.substr(1));
    if (comment.substr(0, 2) == "//") p.choices = std::string(trimmed(comment.substr(2)));
    p.at = {source_, number, column};
    list.push_back(std::move(p));
  }

  std::uint32_t source_;
  std::string group_, description_;
};

}  // namespace

std::vector<CustomParameter> custom_parameters(std::string_view text, std::uint32_t source) {
  Reader reader(source);
  std::uint32_t number = 1;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (!reader.line(text.substr(0, end), number++)) break;
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  return std::move(reader.list);
}

}  // namespace kerf::scad

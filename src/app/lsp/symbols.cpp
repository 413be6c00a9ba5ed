// Definitions and the outline of a text, by its words.
#include "app/lsp/symbols.h"

#include <algorithm>
#include <set>
#include <utility>

#include "base/ending.h"
#include "base/file_names.h"
#include "base/names.h"

namespace kerf::app::lsp {
namespace {

constexpr std::size_t kMaxFiles = 200;  // that are searched for a definition

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_part(char c) { return is_letter(c) || is_digit(c); }

struct Token {
  std::string_view text;  // a name, a number, or one character
  Span at;
  bool is_quoted = false;  // then `text` is without the quotes
};

/// Words of gcmc and OpenSCAD.
class Tokens {
 public:
  explicit Tokens(std::string_view text) : text_(text) {}

  std::optional<Token> next() {
    skip();
    if (at_ >= text_.size()) return std::nullopt;
    if (text_[at_] == '"' || text_[at_] == '\'') return quoted();
    const std::size_t start = at_;
    if (is_part(text_[at_]))
      while (at_ < text_.size() && is_part(text_[at_])) ++at_;
    else
      ++at_;
    return token(start, at_);
  }

 private:
  Token token(std::size_t start, std::size_t end) const {
    return {text_.substr(start, end - start), {line_, start - line_start_, end - line_start_}};
  }
  void new_line() {
    ++line_;
    line_start_ = at_ + 1;
  }
  void skip() {
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\n') {
        new_line();
      } else if (text_.substr(at_, 2) == "//") {
        at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
      } else if (text_.substr(at_, 2) == "/*") {
        const std::size_t end = std::min(text_.find("*/", at_ + 2), text_.size());
        for (; at_ < end; ++at_)
          if (text_[at_] == '\n') new_line();
        ++at_;
      } else if (text_[at_] != ' ' && text_[at_] != '\t' && text_[at_] != '\r') {
        return;
      }
    }
  }
  Token quoted() {
    const char quote = text_[at_];
    const std::size_t start = ++at_;
    while (at_ < text_.size() && text_[at_] != quote && text_[at_] != '\n') at_ += text_[at_] == '\\' ? 2 : 1;
    at_ = std::min(at_, text_.size());
    Token found = token(start, at_);
    found.is_quoted = true;
    if (at_ < text_.size() && text_[at_] == quote) ++at_;
    return found;
  }

  std::string_view text_;
  std::size_t at_ = 0, line_ = 0, line_start_ = 0;
};

std::vector<Token> tokens_of(std::string_view text) {
  std::vector<Token> all;
  Tokens tokens(text);
  for (auto token = tokens.next(); token; token = tokens.next()) all.push_back(*token);
  return all;
}

/// The line of the bracket that closes what opens at or after `from`.
std::size_t last_line_of(const std::vector<Token>& tokens, std::size_t from) {
  int depth = 0;
  for (std::size_t i = from; i < tokens.size(); ++i) {
    const std::string_view text = tokens[i].is_quoted ? std::string_view() : tokens[i].text;
    if (text == "{") ++depth;
    if (text == "}" && --depth <= 0) return tokens[i].at.line;
    if (text == ";" && depth == 0) return tokens[i].at.line;
  }
  return tokens.empty() ? 0 : tokens.back().at.line;
}

/// "function f(", "module m(" and "name =" outside of blocks and parentheses; the parameters of functions and
/// the names within blocks as well with `everywhere`.
std::vector<Symbol> definitions_in(std::string_view text, bool everywhere) {
  std::vector<Symbol> found;
  std::set<std::string_view> known;
  const std::vector<Token> tokens = tokens_of(text);
  int blocks = 0, parentheses = 0;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (tokens[i].is_quoted) continue;
    const std::string_view word = tokens[i].text;
    if (word == "{" || word == "}") blocks += word == "{" ? 1 : -1;
    if (word == "(" || word == ")") parentheses += word == "(" ? 1 : -1;
    if (i + 1 >= tokens.size() || !is_letter(word.front())) continue;
    if (word == "function" || word == "module") {
      const Token& name = tokens[i + 1];
      if (!is_letter(name.text.front())) continue;
      found.push_back({std::string(name.text), word == "module" ? SymbolKind::module : SymbolKind::function,
                       name.at, last_line_of(tokens, i)});
    } else if ((blocks == 0 && parentheses == 0) || everywhere) {
      const bool is_assigned =
          tokens[i + 1].text == "=" && (i + 2 >= tokens.size() || tokens[i + 2].text != "=");
      if (is_assigned && known.insert(word).second)
        found.push_back({std::string(word), SymbolKind::variable, tokens[i].at, tokens[i].at.line});
    }
  }
  return found;
}

// -------------------------------------------------------------------------------------------------- G-code

/// A line of G-code in capitals, with blanks instead of its comments.
std::string without_comments(std::string_view line) {
  std::string out(line);
  bool in_comment = false;
  for (char& c : out) {
    if (c == '(') in_comment = true;
    const bool is_end = c == ')';
    if (c == ';' && !in_comment) {
      std::fill(out.begin() + (&c - out.data()), out.end(), ' ');
      break;
    }
    c = in_comment ? ' ' : capital_letter(c);
    if (is_end) in_comment = false;
  }
  return out;
}

/// The label of a line that starts with "O100" or "o<name>", and what follows.
std::optional<std::pair<Span, std::string>> label_of(const std::string& line, std::size_t number) {
  const std::size_t start = line.find_first_not_of(" \t");
  if (start == std::string::npos || line[start] != 'O') return std::nullopt;
  std::size_t end = start + 1;
  if (end < line.size() && line[end] == '<')
    end = std::min(line.find('>', end), line.size() - 1) + 1;
  else
    while (end < line.size() && is_digit(line[end])) ++end;
  if (end == start + 1) return std::nullopt;
  return std::pair(Span{number, start, end}, std::string(trim(std::string_view(line).substr(end))));
}

bool is_subroutine(const std::string& rest) { return rest.empty() || rest.rfind("SUB", 0) == 0; }

std::vector<Symbol> outline_of_gcode(std::string_view text) {
  std::vector<Symbol> found;
  const TextLines lines(text);
  for (std::size_t n = 0; n < lines.count(); ++n) {
    const std::string line = without_comments(lines.line(n));
    if (const auto label = label_of(line, n); label && is_subroutine(label->second)) {
      found.push_back({line.substr(label->first.start, label->first.end - label->first.start),
                       SymbolKind::function, label->first, n});
      continue;
    }
    const std::size_t change = line.find("M6");
    const bool changes =
        change != std::string::npos && (change + 2 == line.size() || !is_digit(line[change + 2]));
    const std::size_t tool = line.find('T');
    if (!changes || tool == std::string::npos) continue;
    std::size_t end = tool + 1;
    while (end < line.size() && is_digit(line[end])) ++end;
    if (!found.empty()) found.back().last_line = n == 0 ? 0 : n - 1;
    found.push_back({"tool " + line.substr(tool + 1, end - tool - 1), SymbolKind::event, {n, tool, end}, n});
  }
  if (!found.empty()) found.back().last_line = lines.count() - 1;
  return found;
}

/// "#<depth>", "#100", or the label of a call: "O100", "O<NAME>", also of "M98 P100" and "G65 P100".
std::string word_of_gcode(std::string_view line, std::size_t byte) {
  const std::string text = without_comments(line);
  std::size_t start = std::min(byte, text.empty() ? 0 : text.size() - 1);
  if (const std::size_t open = text.rfind('<', start); open != std::string::npos && open > 0) {
    const std::size_t close = text.find('>', open);
    if (close != std::string::npos && close >= start) return text.substr(open - 1, close - open + 2);
  }
  while (start > 0 && start < text.size() && is_digit(text[start])) --start;
  if (start >= text.size()) return {};
  std::size_t end = start + 1;
  while (end < text.size() && is_digit(text[end])) ++end;
  const std::string word = text.substr(start, end - start);
  const bool calls = text.find("M98") != std::string::npos || text.find("G65") != std::string::npos ||
                     text.find("G66") != std::string::npos;
  if (word.size() > 1 && word[0] == 'P' && calls) return "O" + word.substr(1);
  return word.size() > 1 && (word[0] == '#' || word[0] == 'O') ? word : std::string();
}

/// The digits of "O0100" without zeros in front, so that P100 finds it.
std::string plain_label(std::string_view label) {
  if (label.size() < 2 || !is_digit(label[1])) return std::string(label);
  const std::size_t first = std::min(label.find_first_not_of('0', 1), label.size() - 1);
  return "O" + std::string(label.substr(first));
}

std::optional<Span> definition_in_gcode(std::string_view text, const std::string& word) {
  const TextLines lines(text);
  for (std::size_t n = 0; n < lines.count(); ++n) {
    const std::string line = without_comments(lines.line(n));
    if (word[0] == 'O') {
      const auto label = label_of(line, n);
      if (label && is_subroutine(label->second) &&
          plain_label(line.substr(label->first.start, label->first.end - label->first.start)) ==
              plain_label(word))
        return label->first;
      continue;
    }
    for (std::size_t at = line.find(word); at != std::string::npos; at = line.find(word, at + 1)) {
      const std::size_t end = at + word.size();
      const std::size_t next = line.find_first_not_of(" \t", end);
      const bool is_whole = end >= line.size() || !is_digit(line[end]) || word.back() == '>';
      if (is_whole && next != std::string::npos && line[next] == '=') return Span{n, at, end};
    }
  }
  return std::nullopt;
}

// ---------------------------------------------------------------------------------------------------- jobs

std::vector<Symbol> outline_of_job(std::string_view text) {
  std::vector<Symbol> found;
  const TextLines lines(text);
  for (std::size_t n = 0; n < lines.count(); ++n) {
    const std::string_view line = trim(lines.line(n));
    if (line.rfind("op", 0) == 0 && !found.empty() && found.back().name == "operation") {
      const std::size_t open = line.find('"'), close = line.find('"', open + 1);
      if (open != std::string_view::npos && close != std::string_view::npos)
        found.back().name = line.substr(open + 1, close - open - 1);
    }
    if (line.empty() || line.front() != '[') continue;
    const std::size_t start = line.find_first_not_of('['), end = line.find(']');
    if (start == std::string_view::npos || end == std::string_view::npos || end < start) continue;
    const std::size_t offset = static_cast<std::size_t>(line.data() - lines.line(n).data());
    if (!found.empty()) found.back().last_line = n - 1;
    found.push_back({std::string(line.substr(start, end - start)),
                     SymbolKind::object,
                     {n, offset + start, offset + end},
                     n});
  }
  if (!found.empty()) found.back().last_line = lines.count() - 1;
  return found;
}

std::optional<Span> definition_in(Script script, std::string_view text, const std::string& word) {
  if (script == Script::gcode) return definition_in_gcode(text, word);
  for (const Symbol& symbol : definitions_in(text, true))
    if (symbol.name == word) return symbol.at;
  return std::nullopt;
}

}  // namespace

Script script_of(std::string_view path) {
  const std::string ending = ending_of(path);
  if (ending == ".gcmc") return Script::gcmc;
  if (ending == ".scad") return Script::scad;
  if (ending == ".toml") return Script::job;
  for (const std::string_view gcode : {".nc", ".ngc", ".gcode", ".tap", ".gc", ".cnc"})
    if (ending == gcode) return Script::gcode;
  return Script::other;
}

std::vector<Symbol> outline_of(Script script, std::string_view text) {
  switch (script) {
    case Script::gcode: return outline_of_gcode(text);
    case Script::gcmc:
    case Script::scad: return definitions_in(text, false);
    case Script::job: return outline_of_job(text);
    case Script::other: break;
  }
  return {};
}

std::string word_at(Script script, std::string_view line, std::size_t byte) {
  if (script == Script::gcode) return word_of_gcode(line, byte);
  std::size_t start = std::min(byte, line.size()), end = start;
  const auto belongs = [&](char c) { return is_part(c) || (script == Script::job && c == '-'); };
  while (start > 0 && belongs(line[start - 1])) --start;
  while (end < line.size() && belongs(line[end])) ++end;
  return std::string(line.substr(start, end - start));
}

std::vector<std::string> includes_of(Script script, std::string_view text) {
  std::vector<std::string> names;
  if (script != Script::gcmc && script != Script::scad) return names;
  const std::vector<Token> tokens = tokens_of(text);
  for (std::size_t i = 0; i + 2 < tokens.size(); ++i) {
    if (tokens[i].is_quoted) continue;
    if (script == Script::gcmc && tokens[i].text == "include" && tokens[i + 2].is_quoted)
      names.emplace_back(tokens[i + 2].text);
    const bool is_use = tokens[i].text == "include" || tokens[i].text == "use";
    if (script != Script::scad || !is_use || tokens[i + 1].text != "<") continue;
    const char* const start = tokens[i + 2].text.data();
    const std::string_view rest = text.substr(static_cast<std::size_t>(start - text.data()));
    names.emplace_back(rest.substr(0, rest.find_first_of(">\n")));
  }
  return names;
}

std::optional<Definition> definition_of(
    Script script, const std::string& path, std::string_view text, std::size_t line, std::size_t byte,
    const std::function<std::optional<std::string>(const std::string&)>& read_file) {
  const std::string word = word_at(script, TextLines(text).line(line), byte);
  if (word.empty() || script == Script::job || script == Script::other) return std::nullopt;
  if (const auto here = definition_in(script, text, word)) return Definition{path, *here};
  const std::string folder = folder_of(path);
  if (script == Script::gcode && word.size() > 3 && word[1] == '<') {
    std::string name = word.substr(2, word.size() - 3);
    std::transform(name.begin(), name.end(), name.begin(), small_letter);
    const std::string file = path_in(folder, name + ".ngc");
    if (word[0] == 'O' && read_file(file)) return Definition{file, {}};
  }
  std::vector<std::string> waiting;
  std::set<std::string> seen{path};
  const auto add = [&](const std::string& from, std::string_view of) {
    for (const std::string& name : includes_of(script, of)) waiting.push_back(path_beside(from, name));
  };
  add(path, text);
  while (!waiting.empty() && seen.size() < kMaxFiles) {
    const std::string file = waiting.front();
    waiting.erase(waiting.begin());
    const auto other = seen.insert(file).second ? read_file(file) : std::nullopt;
    if (!other) continue;
    if (const auto there = definition_in(script, *other, word)) return Definition{file, *there};
    add(file, *other);
  }
  return std::nullopt;
}

}  // namespace kerf::app::lsp

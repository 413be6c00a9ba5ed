// Parser of O-words.
#include "front/gcode/program/o_word.h"

#include "base/names.h"
#include "codec/gcode/block.h"

namespace kerf::gcode {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

OKind kind_of(const std::string& word) {
  constexpr struct {
    std::string_view word;
    OKind kind;
  } kWords[] = {
      {"", OKind::number},
      {"sub", OKind::sub},
      {"endsub", OKind::end_sub},
      {"return", OKind::return_sub},
      {"call", OKind::call},
      {"if", OKind::if_branch},
      {"elseif", OKind::else_if},
      {"else", OKind::else_branch},
      {"endif", OKind::end_if},
      {"while", OKind::loop_while},
      {"endwhile", OKind::end_while},
      {"do", OKind::loop_do},
      {"repeat", OKind::repeat},
      {"endrepeat", OKind::end_repeat},
      {"break", OKind::break_loop},
      {"continue", OKind::continue_loop},
  };
  for (const auto& entry : kWords)
    if (entry.word == word) return entry.kind;
  return OKind::invalid;
}

/// The end of the label at the start of `text`: "100", "<name>", "[2*#1]", "#1".
std::size_t label_end(std::string_view text) {
  if (text.empty()) return 0;
  std::size_t at = 0;
  if (text[0] == '<') {
    const std::size_t close = text.find('>');
    return close == std::string_view::npos ? text.size() : close + 1;
  }
  while (at < text.size() && text[at] == '#') ++at;
  if (at > 0 && at < text.size() && text[at] == '<') {
    const std::size_t close = text.find('>', at);
    return close == std::string_view::npos ? text.size() : close + 1;
  }
  if (at < text.size() && text[at] == '[') {
    int depth = 0;
    for (; at < text.size(); ++at) {
      if (text[at] == '[') ++depth;
      if (text[at] == ']' && --depth == 0) return at + 1;
    }
    return at;
  }
  while (at < text.size() && (is_digit(text[at]) || text[at] == ' ' || text[at] == '\t')) ++at;
  return at;
}

/// The offset of `word` in `text` outside of brackets, after its last letter; 0: none.
std::size_t after_word(std::string_view text, std::string_view word) {
  int depth = 0;
  for (std::size_t i = 0; i + word.size() <= text.size(); ++i) {
    if (text[i] == '[') ++depth;
    if (text[i] == ']') --depth;
    if (depth == 0 && normal_name(text.substr(i, word.size())) == word) return i + word.size();
  }
  return 0;
}

OWord read_macro_statement(std::string_view text) {
  OWord word;
  std::size_t start = 0;
  while (start < text.size() && is_letter(text[start])) ++start;
  word.values = trim(text.substr(start));
  const std::string name = normal_name(text.substr(0, start));
  const std::size_t loop = after_word(text, "do");
  if (name == "while" && loop != 0) {
    word.kind = OKind::loop_while;
    word.label = "do" + normal_name(text.substr(loop));
  } else if (name == "do" || name == "end") {
    word.kind = name == "do" ? OKind::endless_loop : OKind::end_while;
    word.label = "do" + normal_name(word.values);
  } else if (name == "goto") {
    word.kind = OKind::go_to;
  } else if (name == "if" && (after_word(text, "goto") != 0 || after_word(text, "then") != 0)) {
    const std::size_t target = after_word(text, "goto");
    word.kind = target != 0 ? OKind::go_to_if : OKind::assign_if;
    word.action = text.substr(target != 0 ? target : after_word(text, "then"));
  }
  return word;
}

}  // namespace

OWord read_o_word(std::string_view text) {
  if (starts_macro_statement(text)) return read_macro_statement(text);
  OWord word;
  text = trim(text.substr(1));
  const std::size_t end = label_end(text);
  word.label = normal_name(text.substr(0, end));
  const std::size_t digit = word.label.find_first_not_of('0');
  if (!word.label.empty() && word.label.front() == '0')
    word.label = digit == std::string::npos ? "0" : word.label.substr(digit);
  text = trim(text.substr(end));
  std::size_t letters = 0;
  while (letters < text.size() && (is_letter(text[letters]))) ++letters;
  word.kind = word.label.empty() ? OKind::invalid : kind_of(normal_name(text.substr(0, letters)));
  word.values = text.substr(letters);
  if (word.kind == OKind::number && !word.values.empty()) word.kind = OKind::invalid;
  return word;
}

}  // namespace kerf::gcode

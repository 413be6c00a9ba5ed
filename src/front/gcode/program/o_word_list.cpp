// The list of a text's O-words, paired.
#include <algorithm>
#include <array>
#include <map>

#include "base/names.h"
#include "front/gcode/program/flow.h"
#include "front/gcode/program/o_word.h"

namespace kerf::gcode {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

struct Listed {
  std::string_view word;    // from its letter to the end or comment; empty if there is none
  std::string_view number;  // the digits of N
};

/// The O-word of a line; with `macros` a statement of Fanuc's macros too.
Listed o_word_in(std::string_view line, bool macros) {
  Listed listed;
  std::size_t at = 0;
  const auto skip = [&](auto wanted) {
    while (at < line.size() && wanted(line[at])) ++at;
  };
  skip(is_blank);
  if (at < line.size() && line[at] == '/')
    skip([](char c) { return c == '/' || is_digit(c) || is_blank(c); });
  if (at < line.size() && (line[at] == 'N' || line[at] == 'n')) {
    ++at;
    skip(is_blank);
    const std::size_t digits = at;
    skip(is_digit);
    listed.number = line.substr(digits, at - digits);
    skip(is_blank);
  }
  if (at == line.size()) return listed;
  line.remove_prefix(at);
  const bool is_o_word = line[0] == 'O' || line[0] == 'o' || (macros && starts_macro_statement(line));
  if (is_o_word) listed.word = line.substr(0, line.find_first_of(";("));
  return listed;
}

std::string_view without_zeros(std::string_view number) {
  return number.substr(std::min(number.find_first_not_of('0'), number.size() - 1));
}

/// Pairs opening and closing words of equal label.
class Pairing {
 public:
  explicit Pairing(std::vector<OLine>& lines) : lines_(lines) {}

  void add(std::size_t i) {
    OLine& line = lines_[i];
    line.partner = line.branch = i;
    std::vector<std::size_t>& open = open_[line.label];
    if (line.kind == OKind::loop_while && !open.empty() && lines_[open.back()].kind == OKind::loop_do)
      line.kind = OKind::while_of_do;
    switch (line.kind) {
      case OKind::sub:
      case OKind::if_branch:
      case OKind::loop_while:
      case OKind::loop_do:
      case OKind::endless_loop:
      case OKind::repeat: open.push_back(i); return;
      case OKind::else_if:
      case OKind::else_branch: return chain(open, i);
      case OKind::end_sub: return close(open, i, OKind::sub);
      case OKind::end_if: return close(open, i, OKind::if_branch);
      case OKind::end_while: return close(open, i, OKind::loop_while);
      case OKind::while_of_do: return close(open, i, OKind::loop_do);
      case OKind::end_repeat: return close(open, i, OKind::repeat);
      default: return;
    }
  }

 private:
  /// Links the last branch of the open if to this one.
  void chain(const std::vector<std::size_t>& open, std::size_t i) {
    if (open.empty() || lines_[open.back()].kind != OKind::if_branch) return;
    lines_[last_branch(open.back())].branch = i;
  }
  std::size_t last_branch(std::size_t at) const {
    while (lines_[at].branch != at) at = lines_[at].branch;
    return at;
  }
  void close(std::vector<std::size_t>& open, std::size_t i, OKind wanted) {
    if (open.empty()) return;
    const OKind opened = lines_[open.back()].kind;
    const bool endless = opened == OKind::endless_loop && wanted == OKind::loop_while;
    if (opened != wanted && !endless) return;
    const std::size_t first = open.back();
    open.pop_back();
    lines_[i].partner = first;
    lines_[first].partner = i;
    if (wanted != OKind::if_branch) return;
    for (std::size_t at = first; lines_[at].branch != at;) {
      at = lines_[at].branch;
      lines_[at].partner = i;
    }
    lines_[last_branch(first)].branch = i;
  }

  std::vector<OLine>& lines_;
  std::map<std::string, std::vector<std::size_t>> open_;  // words of each label, innermost last
};

}  // namespace

void Flow::list_o_words(Source& source) {
  if (source.listed) return;
  source.listed = true;
  const std::string_view text = source.reader->text();
  Pairing pairing(source.o_lines);
  std::uint32_t lines = 0;
  for (std::size_t at = 0; at < text.size(); ++lines) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    const std::size_t next = end + (text.substr(end, 2) == "\r\n" ? 2 : 1);
    const auto [word, number] = o_word_in(text.substr(at, end - at), is_fanuc(dialect_));
    if (is_fanuc(dialect_) && !number.empty())
      source.line_numbers[std::string(without_zeros(number))].push_back({at, lines});
    if (!word.empty()) {
      const OWord parsed = read_o_word(trim(word));
      OLine line{at, std::min(next, text.size()), lines, parsed.label, parsed.kind, 0, 0};
      source.o_lines.push_back(std::move(line));
      pairing.add(source.o_lines.size() - 1);
      const OKind kind = source.o_lines.back().kind;
      if (kind == OKind::sub || kind == OKind::number)
        source.subs.emplace(parsed.label, source.o_lines.size() - 1);
    }
    at = next;
  }
}

}  // namespace kerf::gcode

// Regular expressions that a user gives, matched in time proportional to the text.
//
// Known are literals, ., classes [a-z] [^...] \d \w \s and their negations, groups ( ), (?: ) and (?<name> ),
// alternatives, the quantifiers * + ? {n} {n,} {n,m} and their lazy forms, and the anchors ^ $ \A \z \b \B.
// Of several matches at the leftmost position that one is found which a backtracking matcher finds first.
// Back references and look-around are refused.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kerf {

enum class LetterCase : std::uint8_t { distinct, ignored };  // ignored: of ASCII letters

struct PatternMatch {
  std::size_t start = 0, end = 0;   // bytes of the text
  std::vector<std::string> groups;  // of group 1 and further; empty where a group took no part
};

class Pattern {
 public:
  /// Nothing, with the reason in `problem`, if `text` is no valid expression or is too large.
  static std::optional<Pattern> compile(std::string_view text, LetterCase letters, std::string& problem);

  /// The leftmost match that starts at byte `from` or later.
  std::optional<PatternMatch> search(std::string_view text, std::size_t from = 0) const;
  /// A match of the whole text.
  std::optional<PatternMatch> match_whole(std::string_view text) const;
  std::size_t groups() const { return groups_; }

 private:
  friend class PatternCompiler;
  friend class PatternRun;
  enum class Op : std::uint8_t { set, split, jump, save, start, end, word_edge, no_word_edge, accept };
  struct Instruction {
    Op op = Op::accept;
    std::size_t a = 0, b = 0;  // set: index; split, jump: targets, `a` first; save: number
  };
  /// Code points, as ranges with both ends included.
  struct Set {
    bool negated = false;
    std::vector<std::pair<char32_t, char32_t>> ranges;
    bool contains(char32_t c) const;
  };

  std::vector<Instruction> program_;
  std::vector<Set> sets_;
  std::size_t groups_ = 0;
};

}  // namespace kerf

// Sorting the words of a line.
#include "front/gcode/line.h"

#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace kerf::gcode {
namespace {

constexpr double kTenthsSlack = 1e-4;  // G38.2 may arrive as 38.19999 from other programs

/// A code's number in tenths, or -1 if it has more than one place.
Tenths tenths_of(double value) {
  const double tenths = std::round(value * 10.0);
  if (!(tenths >= 0.0 && tenths < 1e6) || std::abs(value * 10.0 - tenths) > kTenthsSlack * 10.0) return -1;
  return static_cast<Tenths>(tenths);
}

}  // namespace

void Talker::error(Code code, std::uint32_t column, std::string message, std::string_view hint) {
  say(Severity::error, code, column, std::move(message), hint);
}

void Talker::unusual(Code code, std::uint32_t column, std::string message, std::string_view hint) {
  say(strict_ ? Severity::error : Severity::warning, code, column, std::move(message), hint);
}

void Talker::note(Code code, std::uint32_t column, std::string message) {
  say(Severity::note, code, column, std::move(message), {});
}

void Talker::say(Severity severity, Code code, std::uint32_t column, std::string message,
                 std::string_view hint) {
  diagnostics_.add({severity, code, spot(column), std::move(message), {}, std::string(hint)});
}

bool Line::sort(const Block& block, Talker& talker) {
  letters_ = used_ = groups_ = 0;
  column_of_block_ = block.words.empty() ? 1 : block.words.front().column;
  if (!block.assignments.empty()) {
    talker.error(Code::expression_unsupported, block.assignments.front().column,
                 "parameters are not evaluated yet; the line is left out");
    return false;
  }
  if (block.o_word) {
    talker.error(Code::o_word_unsupported, block.o_word->column,
                 "O-words are not read yet; the line is left out");
    return false;
  }
  for (const Word& word : block.words)
    if (!add_word(word, talker)) return false;
  return true;
}

bool Line::add_word(const Word& word, Talker& talker) {
  const bool plain = word.kind == ValueKind::number && word.letter >= 'A' && word.letter <= 'Z';
  if (!plain) return add_unusual_word(word, talker);
  if (((bit('G') | bit('M')) & bit(word.letter)) != 0) return add_code(word, talker);
  if (((bit('E') | bit('U') | bit('V') | bit('W')) & bit(word.letter)) != 0)
    return add_unusual_word(word, talker);
  if (has(word.letter))
    talker.unusual(Code::word_repeated, word.column,
                   fmt::format("{} stands twice on the line; the last one counts", word.letter));
  letters_ |= bit(word.letter);
  values_[index(word.letter)] = word.value;
  columns_[index(word.letter)] = word.column;
  return true;
}

bool Line::add_unusual_word(const Word& word, Talker& talker) {
  if (word.kind == ValueKind::expression) {
    talker.error(
        Code::expression_unsupported, word.column,
        fmt::format("the value of {} is computed, which is not done yet; the line is left out", word.letter));
    return false;
  }
  if (word.letter == '*') return true;  // a sender's checksum
  if (word.letter < 'A' || word.letter > 'Z') {
    talker.error(Code::code_unsupported, word.column,
                 "polar coordinates are not read yet; the line is left out");
    return false;
  }
  talker.unusual(Code::unknown_letter, word.column,
                 fmt::format("the letter {} has no meaning here and is left out", word.letter));
  return true;
}

bool Line::add_code(const Word& word, Talker& talker) {
  const bool is_g = word.letter == 'G';
  const Tenths number = tenths_of(word.value);
  const CodeEntry* entry = is_g ? find_g_code(number) : find_m_code(number);
  const std::string_view hint = "is this a program for another kind of machine?";
  if (entry == nullptr) {
    talker.unusual(is_g ? Code::unknown_g_code : Code::unknown_m_code, word.column,
                   fmt::format("unknown code {}{:g}; it is left out", word.letter, word.value), hint);
    return true;
  }
  if (entry->support == Support::ignored)
    talker.note(Code::code_ignored, word.column,
                fmt::format("{} does not change the path; it is left out", code_text(word.letter, number)));
  if (entry->support == Support::missing)
    talker.error(Code::code_unsupported, word.column,
                 fmt::format("{} is not read yet", code_text(word.letter, number)));
  const auto group = static_cast<std::size_t>(entry->group);
  if (has(entry->group) && codes_[group] != number && entry->group != Group::other)
    talker.unusual(Code::modal_conflict, word.column,
                   fmt::format("{} and {} exclude each other; the last one counts",
                               code_text(word.letter, codes_[group]), code_text(word.letter, number)));
  groups_ |= bit(entry->group);
  codes_[group] = number;
  code_columns_[group] = word.column;
  return true;
}

void Line::list_unused(Talker& talker) const {
  const std::uint32_t left = letters_ & ~used_;
  for (char letter = 'A'; letter <= 'Z'; ++letter)
    if ((left & bit(letter)) != 0)
      talker.unusual(Code::word_unused, columns_[index(letter)],
                     fmt::format("nothing on the line uses the {} word; it is left out", letter));
}

}  // namespace kerf::gcode

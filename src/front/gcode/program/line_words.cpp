// Sorting the words of a line.
#include "front/gcode/program/line_words.h"

#include <cmath>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "front/gcode/program/expression.h"

namespace kerf::gcode {
namespace {

constexpr Tenths kFirstLargeCode = 1000;  // M100
constexpr std::uint32_t kSpecialLetters = Line::bit('E') | Line::bit('U') | Line::bit('V') | Line::bit('W');
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
  unusual_at(spot(column), code, std::move(message), hint);
}

void Talker::unusual_at(TextSpot where, Code code, std::string message, std::string_view hint) {
  const Severity severity = strict_ ? Severity::error : Severity::warning;
  diagnostics_.add({severity, code, std::move(where), std::move(message), {}, std::string(hint)});
}

void Talker::note(Code code, std::uint32_t column, std::string message) {
  say(Severity::note, code, column, std::move(message), {});
}

void Talker::say(Severity severity, Code code, std::uint32_t column, std::string message,
                 std::string_view hint) {
  diagnostics_.add({severity, code, spot(column), std::move(message), {}, std::string(hint)});
}

bool Line::sort(const Block& block, Parameters& parameters, Talker& talker) {
  letters_ = used_ = groups_ = 0;
  large_m_code_ = -1;
  polar_radius_.reset();
  polar_angle_.reset();
  column_of_block_ = block.words.empty() ? 1 : block.words.front().column;
  other_spindle_ = false;
  if (block.computed) {
    if (!compute(block, parameters, talker)) return false;
  } else {
    for (const Word& word : block.words) add_word(word, word.value, talker);
  }
  if ((letters_ & kSpecialLetters) != 0) drop_letters(talker);
  return true;
}

/// Takes out letters that have no meaning here, and says so.
void Line::drop_letters(Talker& talker) {
  const bool filament = rules_ == LetterRules::printer;
  const bool taper = has(Group::motion) && code(Group::motion) == 760;
  const bool e_is_used = filament || has(Group::other) || taper;
  for (const char letter : {'E', 'U', 'V', 'W'}) {
    if (!has(letter) || (letter == 'E' && e_is_used)) continue;
    letters_ &= ~bit(letter);
    if (letter == 'E' || filament)
      talker.unusual(Code::unknown_letter, column(letter),
                     fmt::format("the letter {} has no meaning here and is left out", letter));
    else
      talker.error(
          Code::code_unsupported, column(letter),
          fmt::format("{} moves a secondary axis, beside {}, which Kerf does not follow; it is left out",
                      letter, static_cast<char>(letter + 3)));
  }
}

/// A parameter and the value that it gets.
struct Line::Setting {
  ExpressionReader::Target what;
  double value = 0.0;
};

/// A line with values that are worked out.
bool Line::compute(const Block& block, Parameters& parameters, Talker& talker) {
  for (const Word& word : block.words) {
    double value = word.value;
    if (word.kind == ValueKind::expression) {
      ExpressionReader reader(block.value_text(word), parameters);
      const std::optional<double> computed = reader.value();
      if (!computed) {
        const auto offset = static_cast<std::uint32_t>(reader.fault().offset);
        talker.error(reader.fault().code, word.column + 1 + offset,
                     reader.fault().message + "; the line is left out");
        return false;
      }
      value = *computed;
    }
    add_word(word, value, talker);
  }
  std::vector<Setting> settings;
  for (const Computation& text : block.assignments) {
    const std::optional<Setting> setting = assignment(text, parameters, talker);
    if (!setting) return false;
    settings.push_back(*setting);
  }
  for (const Setting& s : settings)
    if (s.what.name.empty())
      parameters.set_number(s.what.number, s.value);
    else
      parameters.set_name(s.what.name, s.value);
  return true;
}

std::optional<Line::Setting> Line::assignment(const Computation& text, const Parameters& parameters,
                                              Talker& talker) {
  ExpressionReader reader(text.text, parameters);
  const auto what = reader.target();
  if (what && reader.take('='))
    if (const std::optional<double> value = reader.value()) return Setting{*what, *value};
  const bool told = !reader.fault().message.empty();
  const auto offset = static_cast<std::uint32_t>(told ? reader.fault().offset : reader.position());
  talker.error(told ? reader.fault().code : Code::expression_malformed, text.column + offset,
               (told ? reader.fault().message : std::string("'=' is missing")) + "; the line is left out");
  return std::nullopt;
}

void Line::add_word(const Word& word, double value, Talker& talker) {
  const bool letter = word.letter >= 'A' && word.letter <= 'Z';
  if (!letter) return add_sign_word(word, value, talker);
  if (((bit('G') | bit('M')) & bit(word.letter)) != 0) return add_code(word, value, talker);
  if (has(word.letter))
    talker.unusual(Code::word_repeated, word.column,
                   fmt::format("{} stands twice on the line; the last one counts", word.letter));
  letters_ |= bit(word.letter);
  values_[index(word.letter)] = value;
  columns_[index(word.letter)] = word.column;
}

/// "@", "^" and "$"; "*" is a sender's checksum. "$-1" means all spindles.
void Line::add_sign_word(const Word& word, double value, Talker& talker) {
  if (word.letter == '@') polar_radius_ = value;
  if (word.letter == '^') polar_angle_ = value;
  if (word.letter != '$' || value == 0.0 || value == -1.0) return;
  other_spindle_ = true;
  talker.note(
      Code::code_ignored, word.column,
      fmt::format("spindle {:g} is not the one that cuts; what the line says of it is left out", value));
}

void Line::add_code(const Word& word, double value, Talker& talker) {
  const bool is_g = word.letter == 'G';
  const Tenths number = tenths_of(value);
  if (!is_g && number >= kFirstLargeCode && number % 10 == 0) {
    large_m_code_ = number / 10;
    code_columns_[static_cast<std::size_t>(Group::other)] = word.column;
    return;
  }
  const CodeEntry* entry = is_g ? find_g_code(number) : find_m_code(number);
  const std::string_view hint = "is this a program for another kind of machine?";
  if (entry == nullptr) {
    talker.unusual(is_g ? Code::unknown_g_code : Code::unknown_m_code, word.column,
                   fmt::format("unknown code {}{:g}; it is left out", word.letter, value), hint);
    return;
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
}

void Line::list_unused(Talker& talker) const {
  const std::uint32_t left = letters_ & ~used_;
  for (char letter = 'A'; letter <= 'Z'; ++letter)
    if ((left & bit(letter)) != 0)
      talker.unusual(Code::word_unused, columns_[index(letter)],
                     fmt::format("nothing on the line uses the {} word; it is left out", letter));
}

}  // namespace kerf::gcode

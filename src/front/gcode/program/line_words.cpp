// Sorts the words of a line and evaluates its expressions.
#include "front/gcode/program/line_words.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "base/codes/gcode.h"
#include "front/gcode/program/expression.h"

namespace kerf::gcode {
namespace {

constexpr Tenths kFirstLargeCode = 1000;  // M100
constexpr std::uint32_t kSpecialLetters =
    LineWords::bit('E') | LineWords::bit('U') | LineWords::bit('V') | LineWords::bit('W');
constexpr double kTenthsTolerance = 1e-4;  // some programs write G38.2 as 38.19999

/// A code's number in tenths, or -1 if it has more than one decimal.
Tenths tenths_of(double value) {
  const double tenths = std::round(value * 10.0);
  if (!(tenths >= 0.0 && tenths < 1e6) || std::abs(value * 10.0 - tenths) > kTenthsTolerance * 10.0)
    return -1;
  return static_cast<Tenths>(tenths);
}

/// "G54.1 P3" and "G154 P3" of Fanuc and Haas: work offsets beyond G59.
bool is_extended_offset(Tenths number) {
  constexpr Tenths kFanuc = 541, kHaas = 1540, kOldHaas = 1100, kLastOldHaas = 1290;
  return number == kFanuc || number == kHaas ||
         (number >= kOldHaas && number <= kLastOldHaas && number % 10 == 0);
}

using DialectTest = bool (*)(GcodeDialect);
constexpr bool has_pockets(GcodeDialect d) { return d == GcodeDialect::haas || d == GcodeDialect::mach3; }
constexpr bool has_polar_mode(GcodeDialect d) { return is_fanuc(d) || d == GcodeDialect::mach3; }
/// G31; plasma torches touch off by it.
constexpr bool has_skip(GcodeDialect d) { return has_polar_mode(d) || d == GcodeDialect::laser; }
constexpr bool has_none(GcodeDialect) { return false; }

/// Letters whose values count thousandths on Fanuc's controls where they have no decimal point.
constexpr std::uint32_t kCounting = LineWords::bit('P') | LineWords::bit('Q') | LineWords::bit('I') |
                                    LineWords::bit('J') | LineWords::bit('K');

/// M17, M18, M84 (motors) and M400 (waits for the motions before it) of Marlin, which drives lasers too.
constexpr bool is_idle_on_lasers(Tenths number) {
  return number == 170 || number == 180 || number == 840 || number == 4000;
}

/// A G code that only some dialects have.
struct DialectCode {
  Tenths number;
  DialectTest is_known;
  std::string_view hint;
};
constexpr Tenths kCancelCycle = 800;

/// Mach3's G70 and G71 are G20 and G21. Source: "Using Mach3Mill", chapter 10, "G20 and G21".
Tenths common_code(Tenths number, GcodeDialect dialect) {
  if (dialect != GcodeDialect::mach3 || (number != 700 && number != 710)) return number;
  return number == 700 ? 200 : 210;
}

/// Canned cycles have a group of their own there, so that G80 and G0 may be on one line: "G0 G17 G40 G49
/// G80".
bool has_cycle_group(GcodeDialect dialect) { return dialect == GcodeDialect::mach3 || is_fanuc(dialect); }

constexpr DialectCode kDialectCodes[] = {
    {120, has_pockets, "it is a circular pocket on Haas and Mach3: --dialect"},
    {130, has_pockets, "it is a circular pocket on Haas and Mach3: --dialect"},
    {160, has_polar_mode, "polar coordinates follow on Fanuc, Haas and Mach3: --dialect"},
    {310, has_skip, "it is a probe on Mach3, Fanuc and Haas: --dialect"},
    {660, is_fanuc, "it calls a macro on Fanuc and Haas: --dialect"},
    {670, is_fanuc, "it ends the calls of a macro on Fanuc and Haas: --dialect"},
    {720, has_none, "on Haas it is a row of holes, which is not supported"},
    {1500, has_none, "on Haas it is a pocket of any shape, which is not supported"}};

struct Assignment {
  ExpressionReader::Target what;
  ParameterValue value;

  void store_in(Parameters& parameters) const {
    if (what.name.empty())
      parameters.set_number(what.number, value);
    else
      parameters.set_name(what.name, value);
  }
};

std::optional<Assignment> parse_assignment(const Computation& text, const Parameters& parameters,
                                           LineReporter& reporter) {
  ExpressionReader reader(text.text, parameters);
  const auto what = reader.target();
  if (what && reader.take('='))
    if (const std::optional<double> value = reader.assigned_value(); value && reader.at_end()) {
      Assignment parsed{*what, {*value, reader.is_unknown()}};
      parsed.value.vacant = reader.is_vacant();
      if (!what->name.empty() || what->number != 0) return parsed;
      reporter.error(codes::parameter_unknown, text.column, "#0 is always vacant and cannot be set");
      return std::nullopt;
    }
  const bool has_fault = !reader.fault().message.empty();
  const auto offset = static_cast<std::uint32_t>(has_fault ? reader.fault().offset : reader.position());
  reporter.error(
      has_fault ? reader.fault().code : codes::expression_malformed, text.column + offset,
      (has_fault ? reader.fault().message : std::string("expected an operator, '=' or the end here")) +
          "; the line is skipped");
  return std::nullopt;
}

/// G65 and G66 of Fanuc and Haas: all other words, M too, are arguments.
bool calls_macro(const Block& block) {
  return std::any_of(block.words.begin(), block.words.end(), [](const Word& w) {
    return w.letter == 'G' && w.kind == ValueKind::number && (w.value == 65.0 || w.value == 66.0);
  });
}

}  // namespace

bool assign(const Computation& text, Parameters& parameters, LineReporter& reporter) {
  const std::optional<Assignment> parsed = parse_assignment(text, parameters, reporter);
  if (parsed) parsed->store_in(parameters);
  return parsed.has_value();
}

bool LineWords::sort(const Block& block, Parameters& parameters, LineReporter& reporter) {
  letters_ = used_ = groups_ = unknown_letters_ = with_point_ = 0;
  unknown_g_column_ = 0;
  unknown_m_code_.clear();
  large_m_code_ = -1;
  polar_radius_.reset();
  polar_angle_.reset();
  corner_.reset();
  arguments_.clear();
  column_of_block_ = block.words.empty() ? 1 : block.words.front().column;
  other_spindle_ = false;
  has_arguments_ = is_fanuc(dialect_) && calls_macro(block);
  if (block.computed) {
    if (!compute(block, parameters, reporter)) return false;
  } else {
    for (const Word& word : block.words) {
      note_argument(word.letter, word.value);
      add_word(word, word.value, reporter);
    }
  }
  if (is_fanuc(dialect_) && has_any(kCounting)) note_points(block);
  if (is_printer(dialect_)) drop_flags(block, reporter);
  if ((letters_ & kSpecialLetters) != 0) drop_unknown_letters(reporter);
  return true;
}

/// Removes words that have no meaning here, with a warning or an error.
void LineWords::drop_unknown_letters(LineReporter& reporter) {
  if (has(Group::subroutine) && is_macro_call(code(Group::subroutine))) return;  // arguments of a macro
  const bool filament = is_printer(dialect_);
  const bool taper = has(Group::motion) && code(Group::motion) == 760;
  const bool e_is_used = filament || has(Group::other) || taper;
  for (const char letter : {'E', 'U', 'V', 'W'}) {
    if (!has(letter) || (letter == 'E' && e_is_used) || (letter == 'U' && has(Group::dwell))) continue;
    if (filament && has(Group::reference)) continue;  // "G28 W": a flag
    letters_ &= ~bit(letter);
    if (letter == 'E' || filament)
      reporter.unusual(codes::unknown_letter, column(letter),
                       fmt::format("the letter {} has no meaning here; skipped", letter));
    else
      reporter.error(codes::code_unsupported, column(letter),
                     fmt::format("{} is a secondary axis parallel to {}, which is not supported; skipped",
                                 letter, static_cast<char>(letter + 3)));
  }
}

/// Evaluates the expressions of a line.
bool LineWords::compute(const Block& block, Parameters& parameters, LineReporter& reporter) {
  for (const Word& word : block.words) {
    double value = word.value;
    if (word.kind == ValueKind::expression) {
      ExpressionReader reader(block.value_text(word), parameters);
      const std::optional<double> computed = reader.value();
      if (!computed) {
        const auto offset = static_cast<std::uint32_t>(reader.fault().offset);
        reporter.error(reader.fault().code, word.column + 1 + offset,
                       reader.fault().message + "; the line is skipped");
        return false;
      }
      value = *computed;
      if (reader.is_vacant()) note_argument(word.letter, ParameterValue::nothing());
      if (reader.is_vacant()) continue;  // as if the word were not there
      if (reader.is_unknown()) note_unknown(word.letter);
      note_argument(word.letter, {value, reader.is_unknown()});
    } else {
      note_argument(word.letter, value);
    }
    add_word(word, value, reporter);
  }
  std::vector<Assignment> assignments;
  for (const Computation& text : block.assignments) {
    const std::optional<Assignment> parsed = parse_assignment(text, parameters, reporter);
    if (!parsed) return false;
    assignments.push_back(*parsed);
  }
  for (const Assignment& a : assignments) a.store_in(parameters);
  return true;
}

/// A letter without a number is a flag of a printer's command; a motion has none.
void LineWords::drop_flags(const Block& block, LineReporter& reporter) {
  const bool moves = has(Group::motion) || !has_codes();
  for (const Word& word : block.words) {
    if (word.value_length != 0 || word.kind != ValueKind::number || !moves) continue;
    letters_ &= ~bit(word.letter);
    reporter.error(codes::number_missing, word.column, fmt::format("no number after {}", word.letter));
  }
}

/// Fanuc's controls read a P without a decimal point in milliseconds, a Q in thousandths of a mm, the factors
/// of G51 in thousandths.
void LineWords::note_points(const Block& block) {
  for (const Word& word : block.words)
    if ((bit(word.letter) & kCounting) != 0 &&
        (word.kind == ValueKind::expression || block.value_text(word).find('.') != std::string_view::npos))
      with_point_ |= bit(word.letter);
}

void LineWords::note_argument(char letter, ParameterValue value) {
  const bool is_argument = letter >= 'A' && letter <= 'Z' && letter != 'G' && letter != 'P' && letter != 'L';
  if (has_arguments_ && is_argument) arguments_.push_back({letter, value});
}

/// Polar words are those of X and Y.
void LineWords::note_unknown(char letter) {
  if (letter == '@' || letter == '^')
    unknown_letters_ |= bit('X') | bit('Y');
  else if (letter >= 'A' && letter <= 'Z')
    unknown_letters_ |= bit(letter);
}

void LineWords::add_word(const Word& word, double value, LineReporter& reporter) {
  const bool letter = word.letter >= 'A' && word.letter <= 'Z';
  if (!letter) return add_sign_word(word, value, reporter);
  if (word.letter == 'G' || (word.letter == 'M' && !has_arguments_)) return add_code(word, value, reporter);
  const bool is_list = has_arguments_ && word.letter >= 'I' && word.letter <= 'K';
  if (has(word.letter) && !is_list)
    reporter.unusual(codes::word_repeated, word.column,
                     fmt::format("two {} words on one line; the last one is used", word.letter));
  letters_ |= bit(word.letter);
  values_[index(word.letter)] = value;
  columns_[index(word.letter)] = word.column;
}

/// "@", "^" and "$" ("$-1": all spindles), and words with a comma. "*" is a sender's checksum and ignored.
void LineWords::add_sign_word(const Word& word, double value, LineReporter& reporter) {
  if (word.letter == 'r' || word.letter == 'c') corner_ = CornerWord{value, word.letter == 'r', word.column};
  if (word.letter == 'a')
    reporter.error(codes::code_unsupported, word.column, ",A, the angle of a line, is not supported; skipped",
                   "write the line's end point");
  if (word.letter == '@') polar_radius_ = value;
  if (word.letter == '^') polar_angle_ = value;
  if (word.letter != '$' || value == 0.0 || value == -1.0) return;
  other_spindle_ = true;
  reporter.note(
      codes::code_ignored, word.column,
      fmt::format("only spindle 0 is supported; the words of this line for spindle {:g} are skipped", value));
}

void LineWords::add_code(const Word& word, double value, LineReporter& reporter) {
  const bool is_g = word.letter == 'G';
  const Tenths number = is_g ? common_code(tenths_of(value), dialect_) : tenths_of(value);
  if (!is_g && dialect_ == GcodeDialect::haas && is_idle_on_haas(number))
    return reporter.note(codes::code_ignored, word.column,
                         fmt::format("{} does not change the toolpath; skipped", code_text('M', number)));
  if (!is_g && dialect_ == GcodeDialect::laser && is_idle_on_lasers(number))
    return reporter.note(codes::code_ignored, word.column,
                         fmt::format("{} does not change the toolpath; skipped", code_text('M', number)));
  if (!is_g && number >= kFirstLargeCode && number % 10 == 0) {
    large_m_code_ = number / 10;
    code_columns_[static_cast<std::size_t>(Group::other)] = word.column;
    return;
  }
  if (is_g && is_of_other_dialect(word, number, reporter)) return;
  const bool haas = dialect_ == GcodeDialect::haas;
  const CodeEntry* entry = !is_g  ? find_m_code(number)
                           : haas ? find_haas_g_code(number)
                                  : find_g_code(number);
  const std::string_view hint = "is this program for another kind of machine?";
  if (is_g && entry == nullptr && is_extended_offset(number))  // reported where it is carried out
    return leave_out(fmt::format("G{:g}", value), word.column);
  if (entry == nullptr) {
    reporter.unusual(is_g ? codes::unknown_g_code : codes::unknown_m_code, word.column,
                     fmt::format("unknown code {}{:g}; skipped", word.letter, value), hint);
    if (is_g)
      leave_out(fmt::format("G{:g}", value), word.column);
    else
      leave_out_m_code(fmt::format("M{:g}", value));
    return;
  }
  if (entry->support == Support::ignored)
    reporter.note(codes::code_ignored, word.column,
                  fmt::format("{} does not change the toolpath; skipped", code_text(word.letter, number)));
  if (entry->support == Support::missing)
    reporter.error(codes::code_unsupported, word.column,
                   fmt::format("{} is not supported", code_text(word.letter, number)));
  const auto group = static_cast<std::size_t>(entry->group);
  if (is_g && entry->group == Group::motion && has_cycle_group(dialect_) && has(Group::motion)) {
    if (number == kCancelCycle) return;
    if (codes_[group] == kCancelCycle) groups_ &= ~bit(Group::motion);
  }
  if (has(entry->group) && codes_[group] != number && entry->group != Group::other)
    reporter.unusual(codes::modal_conflict, word.column,
                     fmt::format("{} and {} exclude each other; the last one is used",
                                 code_text(word.letter, codes_[group]), code_text(word.letter, number)));
  groups_ |= bit(entry->group);
  codes_[group] = number;
  code_columns_[group] = word.column;
}

/// Leaves a G code out that the program's dialect does not have.
bool LineWords::is_of_other_dialect(const Word& word, Tenths number, LineReporter& reporter) {
  for (const DialectCode& code : kDialectCodes) {
    if (code.number != number || code.is_known(dialect_)) continue;
    if (number == 720 && dialect_ != GcodeDialect::haas) return false;
    reporter.unusual(codes::unknown_g_code, word.column,
                     fmt::format("unknown code {}; skipped", code_text('G', number)), code.hint);
    leave_out(code_text('G', number), word.column);
    return true;
  }
  return false;
}

void LineWords::leave_out(std::string code, std::uint32_t column) {
  unknown_g_code_ = std::move(code);
  unknown_g_column_ = column;
}

void LineWords::list_unused(LineReporter& reporter) const {
  const std::uint32_t left = letters_ & ~used_;
  for (char letter = 'A'; letter <= 'Z'; ++letter)
    if ((left & bit(letter)) != 0)
      reporter.unusual(codes::word_unused, columns_[index(letter)],
                       fmt::format("no code on this line uses the {} word; skipped", letter));
}

}  // namespace kerf::gcode

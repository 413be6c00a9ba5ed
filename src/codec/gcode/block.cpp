// Splits G-code text into blocks in one pass; a faulty line is reported and skipped.
#include "codec/gcode/block.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>

#include "base/codes/gcode.h"
#include "codec/gcode/decimal.h"

namespace kerf::gcode {
namespace {

enum class CharClass : std::uint8_t { other, blank, letter, comment, hash };

constexpr std::array<CharClass, 256> make_classes() {
  std::array<CharClass, 256> classes{};
  for (unsigned c = 'a'; c <= 'z'; ++c) classes[c] = classes[c - 'a' + 'A'] = CharClass::letter;
  classes['@'] = classes['^'] = classes['*'] = classes['$'] = CharClass::letter;
  classes[' '] = classes['\t'] = CharClass::blank;
  classes['('] = classes[';'] = CharClass::comment;
  classes['#'] = CharClass::hash;
  return classes;
}
constexpr std::array<CharClass, 256> kClasses = make_classes();

CharClass class_of(char c) { return kClasses[static_cast<unsigned char>(c)]; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return class_of(c) == CharClass::blank; }
char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// How a character is named in a message.
std::string shown(char c) {
  const auto byte = static_cast<unsigned char>(c);
  if (byte >= 0x21 && byte <= 0x7e) return fmt::format("'{}'", c);
  return fmt::format("byte 0x{:02X}", byte);
}

constexpr std::string_view kFunctions[] = {"ABS", "ACOS", "ASIN", "ATAN",  "COS", "EXISTS", "EXP",
                                           "FIX", "FUP",  "LN",   "ROUND", "SIN", "SQRT",   "TAN"};

/// The end of a function's name followed by '[', or `p` if there is none.
const char* after_function_name(const char* p, const char* end) {
  for (const std::string_view name : kFunctions) {
    const char* q = p;
    std::size_t i = 0;
    while (q != end && i < name.size() && upper(*q) == name[i]) ++q, ++i;
    const char* name_end = q;
    while (q != end && is_blank(*q)) ++q;
    if (i == name.size() && q != end && *q == '[') return name_end;
  }
  return p;
}

/// The end of the bracket that opens at `p`, or `end` where it is not closed.
const char* after_bracket(const char* p, const char* end) {
  int depth = 0;
  for (; p != end; ++p) {
    if (*p == '[') ++depth;
    if (*p == ']' && --depth == 0) return p + 1;
  }
  return end;
}

constexpr std::string_view kOForZero = "is the letter O meant as the digit 0?";

/// "X4O", "XO5": whether the word at `letter`, which has no number, is or meets an O instead of the digit 0.
bool is_o_for_zero(const char* line, const char* letter, const char* end) {
  const bool after_number = letter != line && (is_digit(letter[-1]) || letter[-1] == '.');
  const bool before_o = end - letter > 1 && upper(letter[1]) == 'O';
  return before_o || (upper(*letter) == 'O' && after_number);
}

const char* after_blanks(const char* p, const char* end) {
  while (p != end && is_blank(*p)) ++p;
  return p;
}

/// The end of an O-word with its values: the first comment that no value follows.
const char* o_word_end(const char* begin, const char* end) {
  const char* stop = std::find_if(begin, end, [](char c) { return class_of(c) == CharClass::comment; });
  for (const char* p = stop; p != end && *p == '(';) {
    const char* close = std::find(p, end, ')');
    if (close == end) break;
    p = after_blanks(close + 1, end);
    if (p == end || (*p != '[' && *p != '#' && *p != '(')) break;
    if (*p == '(') continue;
    p = stop = std::find_if(p, end, [](char c) { return class_of(c) == CharClass::comment; });
  }
  return stop;
}

const char* after_computed_value(const char* p, const char* end);

/// The end of a parameter's name that starts with '#' at `p`: #1, ##2, #[...], #<name>, #-less prefixes
/// refused.
const char* after_parameter(const char* p, const char* end) {
  while (p != end && (*p == '#' || is_blank(*p))) ++p;
  if (p == end) return p;
  if (*p == '[') return after_bracket(p, end);
  if (class_of(*p) == CharClass::letter) return after_computed_value(p, end);
  if (*p == '<') {
    const char* close = std::find(p, end, '>');
    return close == end ? end : close + 1;
  }
  while (p != end && (is_digit(*p) || *p == '.')) ++p;
  return p;
}

/// The end of a computed value at `p` (parameter, bracket, function, each with a sign or without), or `p` if
/// there is none.
const char* after_computed_value(const char* p, const char* end) {
  const char* q = p;
  while (q != end && (is_blank(*q) || *q == '+' || *q == '-')) ++q;
  if (q == end) return p;
  if (*q == '#') return after_parameter(q, end);
  if (*q == '[') return after_bracket(q, end);
  if (class_of(*q) != CharClass::letter) return p;
  const char* name_end = after_function_name(q, end);
  if (name_end == q) return p;
  q = after_bracket(after_blanks(name_end, end), end);
  const char* slash = after_blanks(q, end);  // ATAN[a]/[b]
  if (slash != end && *slash == '/') {
    const char* second = after_blanks(slash + 1, end);
    if (second != end && *second == '[') return after_bracket(second, end);
  }
  return q;
}

/// The M codes of printers whose words have a meaning here; all others are passed on as they are.
bool is_read_by_printers(double code) {
  constexpr int kCodes[] = {0,  1,   2,   3,   4,   5,   7,   8,   9,   30, 82,
                            83, 104, 106, 107, 109, 140, 141, 190, 191, 200};
  return std::find(std::begin(kCodes), std::end(kCodes), code) != std::end(kCodes);
}

/// Letters whose numbers are whole or have one decimal, and no exponent.
/// ",R5": the words that have a comma, of Fanuc and Haas.
bool is_comma_letter(char letter) { return letter == 'R' || letter == 'C' || letter == 'A'; }
bool is_code_letter(char letter) { return letter == 'M' || letter == 'G' || letter == 'H' || letter == 'T'; }
/// G codes of printers that run a procedure of the firmware: levelling, calibration, parking, cleaning,
/// probing, firmware retraction. Sources: Marlin's list of G-codes, Prusa's firmware (G75 to G89), start
/// programs of Bambu's printers (G29.1, G39.4, G150.3, G380, G383, G392).
bool is_printer_procedure(double code) {
  constexpr int kCodes[] = {10, 11, 12, 26, 27, 29, 30, 31, 32, 33, 34, 35, 39,  42,  60,  61,  75,
                            76, 77, 78, 79, 80, 81, 82, 83, 86, 87, 88, 89, 150, 380, 383, 392, 425};
  return std::find(std::begin(kCodes), std::end(kCodes), std::floor(code)) != std::end(kCodes);
}

/// The end of the value of an assignment in Fanuc's macros, such as "#1 + 1": the next assignment, a comment
/// or the end of the line.
const char* after_macro_value(const char* p, const char* end) {
  while (p != end && class_of(*p) != CharClass::comment) {
    const char* parameter_end = class_of(*p) == CharClass::hash ? after_parameter(p, end) : p;
    const char* equals = after_blanks(parameter_end, end);
    if (parameter_end != p && equals != end && *equals == '=') return p;
    p = std::max(p + 1, parameter_end);
  }
  return p;
}

}  // namespace

bool starts_macro_statement(std::string_view text) {
  constexpr std::string_view kStatements[] = {"WHILE", "GOTO", "END", "IF", "DO"};
  for (const std::string_view word : kStatements) {
    std::size_t i = 0;
    while (i < word.size() && i < text.size() && upper(text[i]) == word[i]) ++i;
    if (i == word.size()) return true;
  }
  return false;
}

BlockReader::BlockReader(std::string_view text, BlockReaderOptions options, Diagnostics& diagnostics)
    : text_(text), options_(std::move(options)), diagnostics_(diagnostics) {
  if (text_.substr(0, 3) == "\xEF\xBB\xBF") text_.remove_prefix(3);
  has_returns_ = text_.find('\r') != std::string_view::npos;
  find_line_end();
}

/// Each kind of line end is searched for only once past the last one found, and returns no farther than to
/// the next line feed, so that neither a text with lone returns nor a jump back scans the whole
/// text.
void BlockReader::find_line_end() {
  const char* const begin = text_.data();
  const auto find = [&](char c, std::size_t from, std::size_t to) {
    const char* const at = std::find(begin + from, begin + to, c);
    return static_cast<std::size_t>(at - begin);
  };
  if (next_line_feed_ < position_ || next_line_feed_ == 0)
    next_line_feed_ = std::min(text_.find('\n', position_), text_.size());
  if (!has_returns_)
    next_return_ = next_line_feed_;
  else if (next_return_ < position_ || next_return_ == 0)
    next_return_ = find('\r', position_, next_line_feed_);
}

/// The end of the line at position_.
std::size_t BlockReader::line_end() {
  find_line_end();
  return std::min(next_line_feed_, next_return_);
}

void BlockReader::seek(std::size_t position, std::uint32_t lines) {
  position_ = std::min(position, text_.size());
  line_ = lines;
  next_line_feed_ = next_return_ = 0;
}

/// To the start of the line after the one that ends at `end`.
void BlockReader::go_after(std::size_t end) {
  position_ = end;
  if (position_ < text_.size()) position_ += text_.substr(position_, 2) == "\r\n" ? 2 : 1;
}

std::string_view BlockReader::peek() {
  if (position_ >= text_.size()) return {};
  return text_.substr(position_, line_end() - position_);
}

void BlockReader::skip() {
  go_after(line_end());
  ++line_;
}

bool BlockReader::next(Block& block) {
  if (position_ >= text_.size()) return false;
  const std::size_t end = line_end();
  block.text = text_.substr(position_, end - position_);
  block.line = ++line_;
  block.faulty = block.optional = block.percent = block.sender = block.computed = false;
  block.command = {};
  block.number.reset();
  block.o_word.reset();
  block.words.clear();
  block.comments.clear();
  block.assignments.clear();
  unbalanced_ = false;
  line_start_ = p_ = text_.data() + position_;
  end_ = text_.data() + end;
  go_after(end);
  if (block.text.size() > options_.max_line_bytes) {
    fault(block, codes::line_too_long, line_start_,
          fmt::format("the line is longer than {} bytes", options_.max_line_bytes), "is this a G-code file?");
    return true;
  }
  read_line(block);
  return true;
}

void BlockReader::read_line(Block& block) {
  if (!read_prefix(block)) return;
  while (p_ != end_) {
    if (class_of(*p_) == CharClass::blank) {
      ++p_;
      continue;
    }
    if (read_item(block)) continue;
    block.words.clear();
    block.assignments.clear();
    return;
  }
}

/// Prefixes of a line: '%' for a whole line, '/'. False if the line is complete.
bool BlockReader::read_prefix(Block& block) {
  skip_space();
  if (p_ == end_) return false;
  if (*p_ == '%') {
    block.percent = true;  // the rest of the line is a name
    return false;
  }
  if (*p_ == '$' || is_realtime_command()) {
    block.sender = true;
    block.command = {p_, static_cast<std::size_t>(end_ - p_)};
    return false;
  }
  if (*p_ == '/') {
    block.optional = true;
    ++p_;
    while (p_ != end_ && is_digit(*p_)) ++p_;  // "/2": switch number of the block delete
  }
  if (options_.commands == BlockReaderOptions::Commands::words && is_command()) {
    const char* stop = std::find(p_, end_, ';');
    block.command = {p_, static_cast<std::size_t>(stop - p_)};
    return false;
  }
  return true;
}

/// '?', '!' or '~' of a sender, with nothing behind it but blanks and a comment.
bool BlockReader::is_realtime_command() const {
  if (*p_ != '?' && *p_ != '!' && *p_ != '~') return false;
  const char* rest = after_blanks(p_ + 1, end_);
  return rest == end_ || class_of(*rest) == CharClass::comment;
}

/// "SET_FAN 1": three letters in a row; "M117 text"; "G29 A".
bool BlockReader::is_command() const {
  const auto letter = [this](std::ptrdiff_t i) {
    return end_ - p_ > i && (class_of(p_[i]) == CharClass::letter || p_[i] == '_');
  };
  if (letter(0) && letter(1) && letter(2)) return true;
  const char first = upper(*p_);
  if (first != 'M' && first != 'G') return false;
  const char* number_end = std::find_if_not(p_ + 1, end_, [](char c) { return is_digit(c) || c == '.'; });
  const Decimal number = read_decimal(p_ + 1, number_end);
  if (number.fault != DecimalFault::none) return false;
  if (first == 'M') return !is_read_by_printers(number.value);
  constexpr double kSetData = 10.0;  // G10 L2 sets a work offset, G10 alone retracts
  const char* comment =
      std::find_if(number_end, end_, [](char c) { return class_of(c) == CharClass::comment; });
  const bool sets_data =
      number.value == kSetData && std::any_of(number_end, comment, [](char c) { return upper(c) == 'L'; });
  return is_printer_procedure(number.value) && !sets_data;
}

/// "G28 O": printers have no O-words; after a code the letter belongs to it.
bool BlockReader::is_flag(const Block& block) const {
  return options_.commands == BlockReaderOptions::Commands::words && !block.words.empty();
}

bool BlockReader::read_item(Block& block) {
  switch (class_of(*p_)) {
    case CharClass::letter:
      if (*p_ == '$' && block.words.empty()) {  // a setting or command for GRBL, not part of a program
        block.sender = true;
        block.command = {p_, static_cast<std::size_t>(end_ - p_)};
        p_ = end_;
        return true;
      }
      if (options_.macros && block.words.empty() &&
          starts_macro_statement({p_, static_cast<std::size_t>(end_ - p_)}))
        return keep_o_word(block);
      return upper(*p_) == 'O' && !is_flag(block) ? read_o_word(block) : read_word(block);
    case CharClass::comment: read_comment(block); return true;
    case CharClass::hash: return read_assignment(block);
    case CharClass::blank:
    case CharClass::other: break;
  }
  if (*p_ == '/' && block.number && block.words.empty()) {  // "N10 /G1"
    block.optional = true;
    unusual(block, codes::bad_character, p_, "a '/' after the line number, which LinuxCNC refuses");
    ++p_;
    return true;
  }
  if (*p_ == ',' && end_ - p_ > 1 && is_comma_letter(upper(p_[1]))) {
    ++p_;
    if (!read_word(block)) return false;
    block.words.back().letter = lower(block.words.back().letter);
    return true;
  }
  return fault(block, codes::bad_character, p_,
               fmt::format("{} is not allowed here, expected a letter", shown(*p_)));
}

bool BlockReader::read_word(Block& block) {
  const char* letter = p_;
  const Decimal number = read_decimal(letter + 1, end_);
  Word word{number.value, column_of(letter), column_of(letter), 0, upper(*letter), ValueKind::number};
  switch (number.fault) {
    case DecimalFault::none: break;
    case DecimalFault::missing: return read_computed_value(block, word);
    case DecimalFault::malformed:
      if (is_code_letter(word.letter) && upper(*number.end) == 'E') break;  // "M68E0Q1" is M68 E0 Q1
      return fault(block, codes::number_malformed, number.end,
                   fmt::format("{} cannot follow the number of the {} word", shown(*number.end), word.letter),
                   "numbers have a sign, digits and one point, and no exponent");
    case DecimalFault::too_large:
      return fault(block, codes::number_too_large, letter,
                   fmt::format("the number after {} is too large or too long", word.letter));
  }
  p_ = number.end;
  if (word.letter == 'N' && !block.number && block.words.empty()) {
    block.number = number.value;
    return true;
  }
  word.value_length = static_cast<std::uint32_t>(p_ - letter) - 1;
  block.words.push_back(word);
  return true;
}

bool BlockReader::read_computed_value(Block& block, Word& word) {
  const char* letter = p_;
  const char* value_end = after_computed_value(letter + 1, end_);
  const bool printer = options_.commands == BlockReaderOptions::Commands::words;
  if (value_end == letter + 1 && printer && class_of(*letter) == CharClass::letter && upper(*letter) != 'G' &&
      upper(*letter) != 'M') {  // "G28 X": a flag
    ++p_;
    block.words.push_back(word);
    return true;
  }
  if (value_end == letter + 1)
    return fault(block, codes::number_missing, letter, fmt::format("no number after {}", shown(*letter)),
                 is_o_for_zero(line_start_, letter, end_) ? kOForZero : "");
  word.kind = ValueKind::expression;
  block.computed = true;
  word.value_length = static_cast<std::uint32_t>(value_end - letter) - 1;
  p_ = value_end;
  block.words.push_back(word);
  return true;
}

/// "#1 = 2", "#<depth> = [#1 * 2]".
bool BlockReader::read_assignment(Block& block) {
  const char* begin = p_;
  const char* equals = after_blanks(after_parameter(begin, end_), end_);
  if (equals == end_ || *equals != '=')
    return fault(block, codes::bad_character, begin,
                 "a parameter at the start of a word needs a value with '='");
  const char* value = equals + 1;
  const char* value_end =
      options_.macros ? after_macro_value(value, end_) : after_computed_value(value, end_);
  if (value_end == value) {
    const Decimal number = read_decimal(value, end_);
    if (number.fault != DecimalFault::none)
      return fault(block, codes::number_missing, equals, "no value after '='");
    value_end = number.end;
  }
  block.computed = true;
  block.assignments.push_back({{begin, static_cast<std::size_t>(value_end - begin)}, column_of(begin)});
  p_ = value_end;
  return true;
}

/// "O100" alone is a program's number and stays a word; with a name or a keyword after it, it controls the
/// program.
bool BlockReader::read_o_word(Block& block) {
  const char* begin = p_;
  if (!block.words.empty() && is_o_for_zero(line_start_, begin, end_))  // "X4O"; "N10O100 sub" is one
    return fault(
        block, codes::number_malformed, begin,
        fmt::format("{} cannot follow the number of the {} word", shown(*begin), block.words.back().letter),
        kOForZero);
  const Decimal number = read_decimal(begin + 1, end_);
  if (number.fault == DecimalFault::none) {
    const char* rest = after_blanks(number.end, end_);
    if (rest == end_ || class_of(*rest) == CharClass::comment) return read_word(block);
  }
  return keep_o_word(block);
}

bool BlockReader::keep_o_word(Block& block) {
  const char* begin = p_;
  const char* stop = o_word_end(begin, end_);
  while (stop != begin && is_blank(stop[-1])) --stop;
  block.o_word = Computation{{begin, static_cast<std::size_t>(stop - begin)}, column_of(begin)};
  p_ = stop;
  return true;
}

/// The end of the comment that opens at p_: its closing parenthesis, counting inner pairs, otherwise the
/// first closing parenthesis; null if there is none.
const char* BlockReader::comment_end(const Block& block) {
  const char* first = std::find(p_ + 1, end_, ')');
  if (first == end_) return nullptr;
  if (std::find(p_ + 1, first, '(') == first) return first;
  unusual(block, codes::comment_nested, p_,
          "a comment within a comment; controllers end it at the first ')'");
  int depth = 0;
  for (const char* q = p_; q != end_ && !unbalanced_; ++q) {
    if (*q == '(') ++depth;
    if (*q == ')' && --depth == 0) return q;
  }
  unbalanced_ = true;
  return first;
}

void BlockReader::read_comment(Block& block) {
  const std::uint32_t column = column_of(p_);
  const char* begin = p_ + 1;
  const char* close = *p_ == ';' ? end_ : comment_end(block);
  if (close == nullptr) {
    unusual(block, codes::comment_unclosed, p_,
            "the comment is not closed; it is assumed to end with the line");
    close = end_;
  }
  block.comments.push_back({{begin, static_cast<std::size_t>(close - begin)}, column});
  p_ = close == end_ ? end_ : close + 1;
}

void BlockReader::skip_space() {
  while (p_ != end_ && is_blank(*p_)) ++p_;
}

bool BlockReader::fault(Block& block, Code code, const char* at, std::string message, std::string_view hint) {
  block.faulty = true;
  if (ended_) return false;
  Diagnostic& d = diagnostics_.error(code, TextLocation{options_.file_name, block.line, column_of(at)},
                                     std::move(message));
  d.hint = hint;
  return false;
}

void BlockReader::unusual(const Block& block, Code code, const char* at, std::string message) {
  if (ended_) return;
  const Severity severity = options_.strict ? Severity::error : Severity::warning;
  diagnostics_.add({severity,
                    code,
                    TextLocation{options_.file_name, block.line, column_of(at)},
                    std::move(message),
                    {},
                    {}});
}

}  // namespace kerf::gcode

// Programs for controls and processes that are not supported, by words that G-code for mills does not have.
#include <algorithm>
#include <cctype>
#include <string>

#include "front/gcode/comments/program_lines.h"

#include "kerf/program/gcode_options.h"

namespace kerf {
namespace {

using namespace gcode;

constexpr std::string_view kHeidenhain = "a Heidenhain control", kSiemens = "a Siemens control";

/// A word of another control's language, in a line in capitals without blanks and without what is in
/// parentheses.
struct ForeignWord {
  std::string_view word, control;
  bool starts_line;
};
constexpr ForeignWord kForeignWords[] = {
    {"BEGINPGM", kHeidenhain, false}, {"TOOLCALL", kHeidenhain, false}, {"BLKFORM", kHeidenhain, false},
    {"CYCLDEF", kHeidenhain, false},  {"FMAX", kHeidenhain, false},     {"WORKPIECE", kSiemens, true},
    {"SUPA", kSiemens, true},         {"CYCLE8", kSiemens, true},       {"MCALL", kSiemens, true},
    {"DEFREAL", kSiemens, true},      {"DEFINT", kSiemens, true},       {"DEFBOOL", kSiemens, true},
    {"TRANSX", kSiemens, true},       {"TRANSY", kSiemens, true},       {"TRANSZ", kSiemens, true},
    {"ATRANS", kSiemens, true},       {"AROT", kSiemens, true},         {"ENDFOR", kSiemens, true},
    {"REPEAT", kSiemens, true},       {"GOTOF", kSiemens, false},       {"GOTOB", kSiemens, false},
    {"STOPRE", kSiemens, true},       {"%_N_", kSiemens, true},         {"CR=", kSiemens, false}};

/// A word of words_of(line) as the line has it, with its blanks: "BLK FORM" for BLKFORM.
std::string_view as_written(std::string_view line, std::string_view word) {
  for (std::size_t start = 0; start < line.size(); ++start) {
    std::size_t at = start, matched = 0;
    for (; at < line.size() && matched < word.size(); ++at) {
      const char c = line[at];
      if (matched > 0 && (c == ' ' || c == '\t')) continue;
      if (std::toupper(static_cast<unsigned char>(c)) != word[matched]) break;
      ++matched;
    }
    if (matched == word.size()) return line.substr(start, at - start);
  }
  return word;
}

bool has_foreign_word(std::string_view line, const ForeignWord& foreign) {
  const std::size_t at = line.find(foreign.word);
  if (at == std::string_view::npos) return false;
  if (foreign.word == "CR=") return at > 0 && (is_digit(line[at - 1]) || line[at - 1] == '.');
  return !foreign.starts_line || at == after_number(line);
}

/// "R1=10" and "X=R1", "F=200": Siemens' assignments. Parameters of other controls have a # before their
/// number.
std::string_view assignment_of_siemens(std::string_view line) {
  if (line.find_first_of("#<_[{") != std::string_view::npos) return {};
  const std::size_t start = after_number(line);
  for (std::size_t sign = line.find('='); sign != std::string_view::npos; sign = line.find('=', sign + 1)) {
    std::size_t letter = sign;
    while (letter > start && is_digit(line[letter - 1])) --letter;
    if (letter == start) continue;
    --letter;
    const bool after_word = letter == start || is_digit(line[letter - 1]) || line[letter - 1] == '.';
    const bool variable = line[letter] == 'R' && letter + 1 < sign && letter == start;
    const bool axis =
        letter + 1 == sign && std::string_view("XYZIJKFT").find(line[letter]) != std::string_view::npos;
    const std::size_t value = sign + 1;
    const bool has_value =
        value < line.size() && (std::isalnum(static_cast<unsigned char>(line[value])) != 0 ||
                                std::string_view("-+.\"").find(line[value]) != std::string_view::npos);
    if (after_word && has_value && (variable || axis)) return line.substr(letter, sign + 1 - letter);
  }
  return {};
}

/// "5LX+10Y+3": a numbered line of Heidenhain's dialogue; "%TESTG71*", the first line in DIN/ISO there.
bool is_line_of_heidenhain(std::string_view line) {
  const std::size_t digits = std::min(line.find_first_not_of("0123456789"), line.size());
  const std::string_view text = line.substr(digits);
  if (digits > 0 && text.size() > 2 && (text[0] == 'L' || text.substr(0, 2) == "CC"))
    return std::string_view("XYZ").find(text[text[0] == 'L' ? 1 : 2]) != std::string_view::npos;
  const std::string_view end = line.size() > 4 ? line.substr(line.size() - 4) : std::string_view();
  return line[0] == '%' && (end == "G71*" || end == "G70*");
}

/// Words of turning and of wire machines, which have the G codes of mills with other axes.
class OtherProcess {
 public:
  void add(std::string_view line, std::uint32_t number) {
    const bool has_y = !after(line, 'Y').empty(), has_z = !after(line, 'Z').empty();
    has_y_ = has_y_ || has_y;
    has_z_ = has_z_ || has_z;
    const std::string_view code = after(line, 'M');
    changes_tools_ = changes_tools_ || code == "6" || code == "06";
    if (line.find('#') != std::string_view::npos) return;
    const std::string_view motion = line.substr(after_number(line));
    if (is_turning_cycle(motion)) cycle_.add(number, motion.substr(0, motion.find_first_of("PUWX")));
    if (is_speed_of_lathe(motion)) speed_.add(number, motion.substr(0, kSpeedWord));
    if (is_tool_with_offset(motion)) tool_.add(number, motion.substr(0, kToolWord));
    if (!after(line, 'U').empty() && !after(line, 'V').empty() && !after(line, 'X').empty())
      wire_.add(number, "U and V");
  }
  void add_comment(std::string_view comment, std::uint32_t number) {
    std::string text(comment);
    for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    for (const std::string_view word : {"WIRE EDM", "WIRE-EDM", "WIREEDM", "WEDM", "WIRE CUT"})
      if (text.find(word) != std::string::npos) wire_name_.add(number, word);
  }

  std::optional<ForeignProgram> found() const {
    const bool turns = has_z_ && !has_y_;
    if (turns && cycle_) return ForeignProgram{"a lathe", cycle_.text, cycle_.line};
    if (turns && tool_ && !changes_tools_) return ForeignProgram{"a lathe", tool_.text, tool_.line};
    if (turns && speed_) return ForeignProgram{"a lathe", speed_.text, speed_.line};
    if (has_z_) return std::nullopt;
    if (wire_name_) return ForeignProgram{"a wire machine", wire_name_.text, wire_name_.line};
    if (wire_.count >= kWireMotions) return ForeignProgram{"a wire machine", wire_.text, wire_.line};
    return std::nullopt;
  }

 private:
  static constexpr std::size_t kToolWord = 5, kSpeedWord = 3;  // "T0101", "G96"
  static constexpr int kWireMotions = 3;

  /// "G71P10Q20": a cycle of rough turning, facing or a pattern, or G70, with the lines of its contour;
  /// "G71U2R1", its depth.
  static bool is_turning_cycle(std::string_view line) {
    const std::string_view code = after(line, 'G');
    const bool rough = code == "71" || code == "72" || code == "73" || code == "70";
    const bool contour = !after(line, 'P').empty() && !after(line, 'Q').empty();
    const bool depth = (code == "71" || code == "72") && !after(line, 'R').empty() &&
                       (!after(line, 'U').empty() || !after(line, 'W').empty());
    return line[0] == 'G' && rough && (contour || depth);
  }
  /// "G50S2500", the highest speed, and "G96S180", the cutting speed.
  static bool is_speed_of_lathe(std::string_view line) {
    const std::string_view start = line.substr(0, kSpeedWord + 1);
    return start == "G50S" || start == "G96S";
  }
  /// "T0101": a tool with its offset.
  static bool is_tool_with_offset(std::string_view line) {
    const std::string_view number = after(line, 'T');
    return line[0] == 'T' && number.size() == 4 && number.find_first_not_of("0123456789") == number.npos &&
           number.substr(0, 2) == number.substr(2);
  }

  bool has_y_ = false, has_z_ = false, changes_tools_ = false;
  Evidence cycle_, tool_, speed_, wire_, wire_name_;
};

}  // namespace

std::optional<ForeignProgram> find_foreign_language(std::string_view text) {
  OtherProcess process;
  for (LineScanner scanner(text); scanner.next();) {
    if (scanner.line.substr(0, 7) == ";$PATH=") return ForeignProgram{kSiemens, ";$PATH", scanner.number};
    if (scanner.comment != std::string_view::npos)
      process.add_comment(scanner.line.substr(scanner.comment), scanner.number);
    const std::string words = words_of(scanner.line);
    if (words.size() <= after_number(words)) continue;
    for (const ForeignWord& foreign : kForeignWords)
      if (has_foreign_word(words, foreign))
        return ForeignProgram{foreign.control, std::string(as_written(scanner.line, foreign.word)),
                              scanner.number};
    if (is_line_of_heidenhain(words))
      return ForeignProgram{kHeidenhain, words.substr(0, kMaxEvidenceChars), scanner.number};
    if (const std::string_view word = assignment_of_siemens(words); !word.empty())
      return ForeignProgram{kSiemens, std::string(as_written(scanner.line, word)), scanner.number};
    process.add(words, scanner.number);
  }
  return process.found();
}

}  // namespace kerf

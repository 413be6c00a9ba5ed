// The words of one line: G and M codes by modal group, other words by letter, and which of them have been
// used.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "codec/gcode/block.h"
#include "codec/gcode/code_table.h"
#include "front/gcode/program/line_reporter.h"
#include "front/gcode/program/parameters.h"

#include "kerf/program/gcode_options.h"

namespace kerf::gcode {

/// ",R5" or ",C5": the corner at the end of a straight motion (Fanuc, Haas).
struct CornerWord {
  double size =
      0.0;  // in the units of the program: the radius, or the distance of the chamfer from the corner
  bool is_round = false;
  std::uint32_t column = 0;
};

/// Executes an assignment such as "#1 = 2"; false with an error.
bool assign(const Computation& text, Parameters& parameters, LineReporter& reporter);

/// A word of a line that calls a macro.
struct ArgumentWord {
  char letter = ' ';
  ParameterValue value;
};

class LineWords {
 public:
  /// Sorts a block's words and evaluates their expressions; the line's assignments take effect after that. Of
  /// two words with one letter or two codes of one group the last one counts, with a warning. False with an
  /// error if an expression has no value.
  bool sort(const Block& block, Parameters& parameters, LineReporter& reporter);
  /// What letters and codes mean. E is the filament of printers, and belongs to some codes (inputs, G76) of
  /// mills, where U, V and W are secondary axes, which Kerf does not support.
  void set_dialect(GcodeDialect dialect) { dialect_ = dialect; }
  /// "@" and "^": radius and angle of polar coordinates.
  std::optional<double> polar_radius() const { return polar_radius_; }
  std::optional<double> polar_angle() const { return polar_angle_; }
  /// The line's corner; another call gives none.
  std::optional<CornerWord> take_corner() { return std::exchange(corner_, std::nullopt); }
  const std::optional<CornerWord>& corner() const { return corner_; }
  /// Sets a word that is computed from other words of the line.
  void set(char letter, double value) {
    letters_ |= bit(letter);
    used_ &= ~bit(letter);
    values_[index(letter)] = value;
  }
  /// Letters (a mask of bit()) whose values are known only at run time; G and M for codes.
  std::uint32_t unknown_letters() const { return unknown_letters_; }
  /// The column of a G code that is not known, 0 if there is none; and its name.
  std::uint32_t unknown_g_column() const { return unknown_g_column_; }
  const std::string& unknown_g_code() const { return unknown_g_code_; }
  /// "M123": the last M code that is not known; empty if there is none.
  const std::string& unknown_m_code() const { return unknown_m_code_; }
  void leave_out_m_code(std::string code) { unknown_m_code_ = std::move(code); }
  /// Marks a code of this line as one that is not known.
  void leave_out(std::string code, std::uint32_t column);
  /// "$1": the line's spindle words are for another spindle than the first.
  bool other_spindle() const { return other_spindle_; }
  /// M codes from M100 on, of printers and user-defined programs; -1: none.
  int large_m_code() const { return large_m_code_; }

  /// The words but P, L and G of a line that calls a macro of Fanuc or Haas, in their order.
  const std::vector<ArgumentWord>& arguments() const { return arguments_; }

  std::uint32_t column() const { return column_of_block_; }

  bool has_codes() const { return groups_ != 0; }
  /// Whether all codes of the line are of these groups (a mask of bit()).
  bool has_only(std::uint32_t groups) const {
    return (groups_ & ~groups) == 0 && large_m_code_ < 0 && unknown_g_column_ == 0 && unknown_m_code_.empty();
  }
  bool has(Group group) const { return (groups_ & bit(group)) != 0; }
  Tenths code(Group group) const { return codes_[static_cast<std::size_t>(group)]; }
  std::uint32_t column(Group group) const { return code_columns_[static_cast<std::size_t>(group)]; }

  bool has(char letter) const { return (letters_ & bit(letter)) != 0; }
  bool has_any(std::uint32_t letters) const { return (letters_ & letters) != 0; }
  std::uint32_t column(char letter) const { return columns_[index(letter)]; }
  /// The value, 0 without such a word; does not mark the word as used.
  double value(char letter) const { return has(letter) ? values_[index(letter)] : 0.0; }
  /// The value; marks the word as used. Nothing if the word is missing or used already.
  std::optional<double> take(char letter) {
    if (!unused(letter)) return std::nullopt;
    used_ |= bit(letter);
    return values_[index(letter)];
  }
  /// Whether the word (P or Q) is a number without a decimal point.
  bool is_integer_text(char letter) const { return has(letter) && (with_point_ & bit(letter)) == 0; }
  /// Marks words (a mask of bit()) as used.
  void use(std::uint32_t letters) { used_ |= letters; }
  bool unused(char letter) const { return (letters_ & ~used_ & bit(letter)) != 0; }
  bool has_unused(std::uint32_t letters) const { return (letters_ & ~used_ & letters) != 0; }
  /// Warns of words that have not been used.
  void report_unused(LineReporter& reporter) const {
    if ((letters_ & ~used_) != 0) list_unused(reporter);
  }

  static constexpr std::uint32_t bit(char letter) { return 1u << (letter - 'A'); }
  static constexpr std::uint32_t bit(Group group) { return 1u << static_cast<unsigned>(group); }

 private:
  static constexpr std::size_t index(char letter) { return static_cast<std::size_t>(letter - 'A'); }
  bool compute(const Block& block, Parameters& parameters, LineReporter& reporter);
  void note_points(const Block& block);
  void drop_flags(const Block& block, LineReporter& reporter);
  void note_unknown(char letter);
  void note_argument(char letter, ParameterValue value);
  void add_word(const Word& word, double value, LineReporter& reporter);
  void add_sign_word(const Word& word, double value, LineReporter& reporter);
  void drop_unknown_letters(LineReporter& reporter);
  void list_unused(LineReporter& reporter) const;
  void add_code(const Word& word, double value, LineReporter& reporter);
  bool is_of_other_dialect(const Word& word, Tenths number, LineReporter& reporter);

  std::uint32_t letters_ = 0, used_ = 0, groups_ = 0;
  std::uint32_t unknown_letters_ = 0, with_point_ = 0;
  std::uint32_t unknown_g_column_ = 0;
  std::string unknown_g_code_, unknown_m_code_;
  GcodeDialect dialect_ = GcodeDialect::rs274;
  bool has_arguments_ = false;  // the line calls a macro of Fanuc
  std::vector<ArgumentWord> arguments_;
  int large_m_code_ = -1;
  bool other_spindle_ = false;
  std::optional<double> polar_radius_, polar_angle_;
  std::optional<CornerWord> corner_;
  std::uint32_t column_of_block_ = 0;
  std::array<double, 26> values_{};
  std::array<std::uint32_t, 26> columns_{};
  std::array<Tenths, kGroups> codes_{};
  std::array<std::uint32_t, kGroups> code_columns_{};
};

inline constexpr std::uint32_t kAxisLetters = LineWords::bit('X') | LineWords::bit('Y') | LineWords::bit('Z');
inline constexpr std::uint32_t kRotaryLetters =
    LineWords::bit('A') | LineWords::bit('B') | LineWords::bit('C');

}  // namespace kerf::gcode

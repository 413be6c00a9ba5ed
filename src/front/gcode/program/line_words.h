// The words of one line, sorted: G and M codes by modal group, all other letters by name, and which of them
// were used.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "codec/gcode/block.h"
#include "front/gcode/program/code_table.h"
#include "front/gcode/program/parameters.h"

#include "kerf/diagnostics.h"

namespace kerf::gcode {

/// Says things about the program, each with its place. Unusual things are warnings, or errors in a strict
/// reading.
class Talker {
 public:
  Talker(std::string file, bool strict, Diagnostics& diagnostics)
      : file_(std::move(file)), strict_(strict), diagnostics_(diagnostics) {}

  void at_line(std::uint32_t line) { line_ = line; }
  /// What is said from now on is about another text.
  void in_file(std::string file) { file_ = std::move(file); }
  std::uint32_t line() const { return line_; }
  TextSpot spot(std::uint32_t column) const { return {file_, line_, column}; }
  Diagnostics& diagnostics() { return diagnostics_; }

  void error(Code code, std::uint32_t column, std::string message, std::string_view hint = {});
  void unusual(Code code, std::uint32_t column, std::string message, std::string_view hint = {});
  /// Of a place that was passed before.
  void unusual_at(TextSpot where, Code code, std::string message, std::string_view hint);
  void note(Code code, std::uint32_t column, std::string message);

 private:
  void say(Severity severity, Code code, std::uint32_t column, std::string message, std::string_view hint);

  std::string file_;
  bool strict_;
  Diagnostics& diagnostics_;
  std::uint32_t line_ = 0;
};

/// Printers have filament (E) and commands with letters of their own; mills have inputs and tapers (E), and
/// no secondary axes (U V W) that Kerf could follow.
enum class LetterRules : unsigned char { mill, printer };

class Line {
 public:
  /// Sorts a block's words. Two words of a letter or two codes of a group: the last one counts, and it is
  /// said. Computed values are worked out, and parameters are set after all of the line's values are known.
  /// False if the line cannot be meant (a value that cannot be computed), which is then said.
  bool sort(const Block& block, Parameters& parameters, Talker& talker);
  /// What the controller makes of the letters E, U, V and W.
  void follow(LetterRules rules) { rules_ = rules; }
  /// "@" and "^": distance and angle of polar coordinates.
  std::optional<double> polar_radius() const { return polar_radius_; }
  std::optional<double> polar_angle() const { return polar_angle_; }
  /// Gives a letter a value that other words of the line work out to.
  void put(char letter, double value) {
    letters_ |= bit(letter);
    used_ &= ~bit(letter);
    values_[index(letter)] = value;
  }
  /// "$1": what the line says of a spindle is about another one than the first.
  bool other_spindle() const { return other_spindle_; }
  /// M codes from M100 on, which printers and users' own programs have; -1: none.
  int large_m_code() const { return large_m_code_; }

  std::uint32_t column() const { return column_of_block_; }

  bool has_codes() const { return groups_ != 0; }
  bool has(Group group) const { return (groups_ & bit(group)) != 0; }
  Tenths code(Group group) const { return codes_[static_cast<std::size_t>(group)]; }
  std::uint32_t column(Group group) const { return code_columns_[static_cast<std::size_t>(group)]; }

  bool has(char letter) const { return (letters_ & bit(letter)) != 0; }
  bool has_any(std::uint32_t letters) const { return (letters_ & letters) != 0; }
  std::uint32_t column(char letter) const { return columns_[index(letter)]; }
  /// The value without taking it; 0 where the letter is absent.
  double value(char letter) const { return has(letter) ? values_[index(letter)] : 0.0; }
  /// The value, marked as used; nothing where the letter is absent or was used already.
  std::optional<double> take(char letter) {
    if (!unused(letter)) return std::nullopt;
    used_ |= bit(letter);
    return values_[index(letter)];
  }
  /// Marks letters (a mask of bit()) as used.
  void use(std::uint32_t letters) { used_ |= letters; }
  bool unused(char letter) const { return (letters_ & ~used_ & bit(letter)) != 0; }
  bool has_unused(std::uint32_t letters) const { return (letters_ & ~used_ & letters) != 0; }
  /// Says which words nothing has used.
  void report_unused(Talker& talker) const {
    if ((letters_ & ~used_) != 0) list_unused(talker);
  }

  static constexpr std::uint32_t bit(char letter) { return 1u << (letter - 'A'); }
  static constexpr std::uint32_t bit(Group group) { return 1u << static_cast<unsigned>(group); }

 private:
  static constexpr std::size_t index(char letter) { return static_cast<std::size_t>(letter - 'A'); }
  struct Setting;
  bool compute(const Block& block, Parameters& parameters, Talker& talker);
  std::optional<Setting> assignment(const Computation& text, const Parameters& parameters, Talker& talker);
  void add_word(const Word& word, double value, Talker& talker);
  void add_sign_word(const Word& word, double value, Talker& talker);
  void drop_letters(Talker& talker);
  void list_unused(Talker& talker) const;
  void add_code(const Word& word, double value, Talker& talker);

  std::uint32_t letters_ = 0, used_ = 0, groups_ = 0;
  LetterRules rules_ = LetterRules::mill;
  int large_m_code_ = -1;
  bool other_spindle_ = false;
  std::optional<double> polar_radius_, polar_angle_;
  std::uint32_t column_of_block_ = 0;
  std::array<double, 26> values_{};
  std::array<std::uint32_t, 26> columns_{};
  std::array<Tenths, kGroups> codes_{};
  std::array<std::uint32_t, kGroups> code_columns_{};
};

inline constexpr std::uint32_t kAxisLetters = Line::bit('X') | Line::bit('Y') | Line::bit('Z');
inline constexpr std::uint32_t kRotaryLetters = Line::bit('A') | Line::bit('B') | Line::bit('C');

}  // namespace kerf::gcode

// The linter: reads G-code line by line like a controller of the profile, and reports what that refuses. The
// words are those of the profile; the rules for their combination are the same for all (RS274/NGC, GRBL).
#include "back/gcode/lint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <optional>

#include "base/codes/gcode.h"
#include "base/number.h"
#include "codec/gcode/block.h"
#include "codec/gcode/code_table.h"
#include "codec/gcode/lasting_effect.h"

#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"

namespace kerf::gcode {
namespace {

constexpr ArcMismatch kMismatch;  // GRBL's

constexpr std::uint32_t bit(char letter) { return 1u << (letter - 'A'); }
constexpr std::uint32_t kAxes = bit('X') | bit('Y') | bit('Z') | bit('A') | bit('B') | bit('C');
constexpr std::uint32_t kLinear = bit('X') | bit('Y') | bit('Z');
constexpr std::uint32_t kCentre = bit('I') | bit('J') | bit('K');

constexpr std::uint32_t bit(Group group) { return 1u << static_cast<unsigned>(group); }
/// What a code occupies on its line, which no other code of the line may; 0: nothing.
std::uint32_t occupied_by(Group group) {
  switch (group) {
    case Group::dwell:
    case Group::machine_coordinates:
    case Group::reference: return bit(Group::reference);  // the codes that are not modal
    case Group::no_coolant: return bit(Group::mist) | bit(Group::flood);
    case Group::tool_change:
    case Group::override_switch:
    case Group::subroutine:
    case Group::saved_modes:
    case Group::other: return 0;
    case Group::motion:
    case Group::plane:
    case Group::distance:
    case Group::arc_distance:
    case Group::feed_mode:
    case Group::units:
    case Group::compensation:
    case Group::tool_length:
    case Group::retract:
    case Group::coordinates:
    case Group::path_control:
    case Group::spindle_mode:
    case Group::lathe:
    case Group::scaling:
    case Group::polar:
    case Group::rotation:
    case Group::stop:
    case Group::spindle:
    case Group::mist:
    case Group::flood: break;
  }
  return bit(group);
}

bool is_small(char c) { return c >= 'a' && c <= 'z'; }

class Linter {
 public:
  Linter(const PostProfile& profile, const std::string& file, LintStart start, Diagnostics& diagnostics)
      : profile_(profile),
        file_(file),
        diagnostics_(diagnostics),
        foreign_(start == LintStart::foreign_line) {
    feed_known_ = foreign_;
    position_known_ = start == LintStart::of_program;
  }

  void check(const Block& block);

 private:
  bool check_form(const Block& block);
  void check_command(std::string_view command);
  void check_comments(const Block& block);
  void check_length(const Block& block);
  void check_foreign(const Block& block);
  bool read_words(const Block& block);
  bool read_code(const Word& word);
  void check_point(const Block& block, const Word& word);
  bool read_value(const Word& word);
  bool occupy(const CodeEntry* code);
  bool states(Group group) const { return (groups_ & bit(group)) != 0; }
  void check_single();
  void run();
  void set_modes();
  void use_offset_words(bool axes);
  void use_special();
  void move();
  void use_arc();
  void check_arc(Point3 to);
  void check_unused();
  Point3 target() const;

  bool has(char letter) const { return (letters_ & bit(letter)) != 0; }
  bool has_code(int tenths) const { return std::find(codes_.begin(), codes_.end(), tenths) != codes_.end(); }
  double value(char letter) const { return values_[static_cast<std::size_t>(letter - 'A')]; }
  void use(std::uint32_t letters) { used_ |= letters; }
  void refuse(Code code, std::string message) {
    refused_ = true;
    diagnostics_.error(code, TextLocation{file_, line_, column_}, std::move(message));
  }

  const PostProfile& profile_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  bool foreign_;

  // of the line
  std::uint32_t line_ = 0, column_ = 1;
  std::uint32_t letters_ = 0, used_ = 0;
  std::array<double, 26> values_{};
  std::vector<int> codes_;    // G codes in tenths
  std::vector<int> m_codes_;  // in tenths
  std::uint32_t groups_ = 0;  // occupied by its codes
  bool refused_ = false;

  // of the program
  int motion_ = 0;  // in tenths; GRBL starts with G0
  Plane plane_ = Plane::xy;
  bool absolute_ = true, absolute_centres_ = false, inverse_time_ = false;
  double scale_ = 1.0;  // mm of a unit
  bool feed_known_ = false, position_known_ = true;
  Point3 at_;  // mm
};

void Linter::check(const Block& block) {
  line_ = block.line;
  column_ = 1;
  refused_ = false;
  if (profile_.form.capitals && std::any_of(block.text.begin(), block.text.end(), is_small))
    refuse(codes::lint_syntax, "the controller has capital letters only");
  check_comments(block);
  if (block.faulty) return;  // reported by BlockReader
  if (foreign_) check_foreign(block);
  if (!check_form(block)) return;
  check_length(block);
  if (!block.command.empty()) return check_command(block.command);
  if (read_words(block) && !refused_) run();
}

/// A line in words: "M117 ready", "G29 A", or a macro such as "PAUSE".
void Linter::check_command(std::string_view command) {
  if (command.front() == 'M' || command.front() == 'G') {
    const bool is_m = command.front() == 'M';
    const auto digits = std::min(command.find_first_not_of("0123456789", 1), command.size());
    if (const auto number = parse_number(command.substr(1, digits - 1))) {
      const int tenths = static_cast<int>(std::lround(std::min(*number, 1e6) * 10.0));
      if (!(is_m ? profile_.has_m(tenths) : profile_.has_g(tenths)))
        refuse(codes::lint_code, fmt::format("the controller has no {}{:g}", is_m ? 'M' : 'G', *number));
      return;
    }
  }
  if (profile_.commands == std::vector<std::string>{"*"}) return;
  if (profile_.commands.empty()) return refuse(codes::lint_syntax, "the controller has no commands in words");
  const std::string_view word = command.substr(0, command.find_first_of(" \t{"));
  if (std::find(profile_.commands.begin(), profile_.commands.end(), word) == profile_.commands.end())
    refuse(codes::lint_syntax, fmt::format("the controller has no command \"{}\"", word));
}

bool Linter::check_form(const Block& block) {
  if (block.percent && !profile_.form.percent_lines)
    refuse(codes::lint_syntax, "the controller has no percent lines");
  if (block.percent) return false;
  const bool is_o_line = !block.words.empty() && block.words.front().letter == 'O';
  if (profile_.form.program_numbers && is_o_line && block.words.size() == 1) return false;
  if (profile_.form.program_numbers && block.o_word) {
    refuse(codes::lint_syntax, "the controller has no O-words");
    return false;
  }
  if (block.o_word || !block.assignments.empty()) {
    if (!profile_.form.parameters)
      refuse(codes::lint_syntax, "the controller has neither parameters nor O-words");
    position_known_ = false;
    return false;
  }
  if (block.number && *block.number > profile_.highest_line_number)
    refuse(codes::lint_value, fmt::format("the maximum line number is {}", profile_.highest_line_number));
  return true;
}

void Linter::check_comments(const Block& block) {
  for (const Comment& comment : block.comments) {
    column_ = comment.column;
    const bool semicolon = block.text[comment.column - 1] == ';';
    if (profile_.comments == CommentStyle::none ||
        (profile_.comments == CommentStyle::semicolon && !semicolon))
      refuse(codes::lint_comment, "the controller has no comments of this form");
    if (!semicolon && comment.text.find('(') != std::string_view::npos)
      refuse(codes::lint_comment, "a comment within a comment");
    for (const char c : comment.text) {
      const bool plain = static_cast<unsigned char>(c) >= 0x20 && static_cast<unsigned char>(c) < 0x7f;
      if ((plain || c == '\t') && profile_.comment_forbidden.find(c) == std::string::npos) continue;
      refuse(codes::lint_comment, "a comment with a character that controllers execute or cannot read");
      break;
    }
  }
  column_ = 1;
}

/// A printer's M codes take words of their own, such as the S of a temperature. M73 sets the progress shown;
/// M112 is the emergency stop.
void Linter::check_foreign(const Block& block) {
  constexpr double kProgress = 73.0, kFirstPrinterCode = 100.0, kEmergencyStop = 112.0;
  if (profile_.syntax == LineSyntax::commands && !block.words.empty() && block.words[0].letter == 'M') {
    const double code = block.words[0].value;
    if (code == kProgress || (code >= kFirstPrinterCode && code != kEmergencyStop)) return;
  }
  const LastingEffect lasting = lasting_effect(block);
  if (lasting.effect.empty()) return;
  column_ = lasting.column;
  refuse(codes::lint_mode, fmt::format("{} changes {}", lasting.word, lasting.effect));
  column_ = 1;
}

void Linter::check_length(const Block& block) {
  std::size_t length = block.text.size();
  if (profile_.line_measure == LineMeasure::significant) {
    for (const Comment& comment : block.comments) length -= std::min(length, comment.text.size() + 2);
    const std::string_view words =
        block.text.substr(0, block.comments.empty() ? block.text.npos : block.comments.front().column - 1);
    const auto blanks =
        std::count_if(words.begin(), words.end(), [](char c) { return c == ' ' || c == '\t'; });
    length -= std::min(length, static_cast<std::size_t>(blanks));
  }
  if (length > profile_.longest_line)
    refuse(codes::lint_line, fmt::format("the line has {} bytes; the maximum of the controller is {}", length,
                                         profile_.longest_line));
}

bool Linter::read_words(const Block& block) {
  letters_ = used_ = groups_ = 0;
  codes_.clear();
  m_codes_.clear();
  for (const Word& word : block.words) {
    column_ = word.column;
    if (word.kind == ValueKind::expression && !profile_.form.parameters)
      refuse(codes::lint_syntax, "the controller has no expressions");
    if (word.kind == ValueKind::expression) position_known_ = false;
    const bool letter = word.letter >= 'A' && word.letter <= 'Z';
    if (!letter || !profile_.has_letter(word.letter)) {
      refuse(codes::lint_letter, fmt::format("the controller does not have the letter {}", word.letter));
      continue;
    }
    if (word.letter == 'G' || word.letter == 'M')
      read_code(word);
    else if (read_value(word))
      check_point(block, word);
  }
  column_ = 1;
  return !refused_;
}

bool Linter::read_code(const Word& word) {
  const bool is_g = word.letter == 'G';
  const int tenths = word.value < 1e6 ? static_cast<int>(std::lround(word.value * 10.0)) : -1;
  const bool exact = std::abs(word.value * 10.0 - tenths) < 1e-6;
  if (!exact || !(is_g ? profile_.has_g(tenths) : profile_.has_m(tenths))) {
    refuse(codes::lint_code, fmt::format("the controller has no {}{:g}", word.letter, word.value));
    return false;
  }
  if (is_g) {
    codes_.push_back(tenths);
    return occupy(find_g_code(tenths));
  }
  m_codes_.push_back(tenths);
  return occupy(find_m_code(tenths));
}

/// Records the group of a code; false with an error if the line already has a code of that group.
bool Linter::occupy(const CodeEntry* code) {
  const std::uint32_t groups = code != nullptr ? occupied_by(code->group) : 0u;
  if ((groups_ & groups) != 0) {
    refuse(codes::lint_conflict, "two codes of one group on the line");
    return false;
  }
  groups_ |= groups;
  return true;
}

/// A number without a point is in other units than one with it, where the controller has such.
void Linter::check_point(const Block& block, const Word& word) {
  constexpr std::string_view kLengths = "XYZABCUVWIJKRQF", kIntegers = "PSTHDLON";
  if (profile_.zeros != Zeros::point || word.kind == ValueKind::expression) return;
  const bool has_point =
      block.text.substr(word.value_offset, word.value_length).find('.') != std::string_view::npos;
  column_ = word.column;
  if (!has_point && word.value != 0.0 && kLengths.find(word.letter) != std::string_view::npos)
    refuse(codes::lint_value, fmt::format("{} without a decimal point is in thousandths", word.letter));
  if (has_point && kIntegers.find(word.letter) != std::string_view::npos)
    refuse(codes::lint_value, fmt::format("{} must have no decimal point", word.letter));
}

bool Linter::read_value(const Word& word) {
  if (has(word.letter)) {
    refuse(codes::lint_conflict, fmt::format("two {} words on the line", word.letter));
    return false;
  }
  letters_ |= bit(word.letter);
  values_[static_cast<std::size_t>(word.letter - 'A')] = word.value;
  const bool never_negative = (bit(word.letter) & (bit('F') | bit('S') | bit('T') | bit('N'))) != 0;
  if (never_negative && word.value < 0.0)
    refuse(codes::lint_value, fmt::format("{} cannot be negative", word.letter));
  if (word.letter == 'T' && word.value > profile_.highest_tool)
    refuse(codes::lint_value, fmt::format("the maximum tool number is {}", profile_.highest_tool));
  return !refused_;
}

/// Checks that a line of LineSyntax::commands is a single command.
void Linter::check_single() {
  const std::size_t commands = codes_.size() + m_codes_.size();
  const bool tool_alone = letters_ == bit('T') || letters_ == (bit('T') | bit('N'));
  if (commands > 1) refuse(codes::lint_conflict, "a line of this controller has one command only");
  if (commands == 0 && letters_ != 0 && !tool_alone)
    refuse(codes::lint_missing, "a line of this controller starts with its command, such as G1");
}

void Linter::run() {
  if (profile_.syntax == LineSyntax::commands) check_single();
  if (refused_) return;
  set_modes();
  use_special();
  for (const int code : codes_)
    if (const CodeEntry* entry = find_g_code(code); entry != nullptr && entry->group == Group::motion)
      motion_ = code;
  move();
  check_unused();
}

void Linter::set_modes() {
  for (const int code : codes_) {
    switch (code) {
      case 170: plane_ = Plane::xy; break;
      case 180: plane_ = Plane::xz; break;
      case 190: plane_ = Plane::yz; break;
      case 200: scale_ = kMmPerInch; break;
      case 210: scale_ = 1.0; break;
      case 900: absolute_ = true; break;
      case 910: absolute_ = false; break;
      case 901: absolute_centres_ = true; break;
      case 911: absolute_centres_ = false; break;
      case 930: inverse_time_ = true; break;
      case 940: inverse_time_ = false; break;
      case 430: use(bit('H')); break;
      case 640: use(profile_.form.blend_tolerance ? bit('P') | bit('Q') : 0); break;
      default: break;
    }
  }
  if (has('F') && value('F') > 0.0) feed_known_ = true;
  if (has('F') && value('F') == 0.0) feed_known_ = false;
  use(bit('F') | bit('S') | bit('T') | bit('N'));
  if (states(Group::spindle_mode)) use(bit('D'));
  if (states(Group::spindle) && profile_.drive.full_speed > SpindleSpeed{}) use(bit('P'));
  const bool other =
      std::any_of(m_codes_.begin(), m_codes_.end(), [](int m) { return m >= 100 && m != 300; });
  if (other) use((1u << 26) - 1);  // printers' codes take words of their own
}

/// G10 L2 and L20: P0 is the selected work offset, P1 is G54, and so on.
void Linter::use_offset_words(bool axes) {
  const double l = has('L') ? value('L') : 0.0, p = has('P') ? value('P') : -1.0;
  if (!axes) return refuse(codes::lint_missing, "G10 needs axis words");
  int highest = 0;
  while (profile_.has_g(work_offset_code(highest + 1))) ++highest;
  if ((l != 2.0 && l != 20.0) || !(p >= 0.0 && p <= highest) || p != std::floor(p))
    return refuse(codes::lint_value, fmt::format("G10 takes L2 or L20 and P0 to P{}", highest));
  use(bit('L') | bit('P') | kAxes);
}

/// Codes that use the line's axis words or P themselves.
void Linter::use_special() {
  const bool axes = (letters_ & kAxes) != 0;
  const bool takes_axes =
      has_code(280) || has_code(300) || has_code(520) || has_code(920) || has_code(100) || has_code(431);
  if (takes_axes && states(Group::motion) && axes)
    refuse(codes::lint_conflict, "two codes of the line use its axis words");
  if (has_code(40)) {
    if (!has('P')) return refuse(codes::lint_missing, "G4 needs a time, P");
    if (value('P') < 0.0) refuse(codes::lint_value, "a time cannot be negative");
    use(bit('P'));
  }
  if (has_code(100)) use_offset_words(axes);
  const bool filament = has_code(920) && has('E');  // of a printer
  if (filament) use(bit('E'));
  if (has_code(920) && !axes && !filament) return refuse(codes::lint_missing, "G92 needs axis words");
  const bool only_z = !profile_.has_g(432);  // GRBL has lengths along Z only; LinuxCNC, with G43.2, along all
  if (has_code(431) && only_z && (letters_ & kAxes) != bit('Z'))
    return refuse(codes::lint_missing, "G43.1 needs Z and nothing else");
  if (has_code(490) && states(Group::motion) && axes)
    refuse(codes::lint_conflict, "G49 on a line with a motion");
  if (has_code(530) && motion_ > 10 && axes && !states(Group::motion))
    refuse(codes::lint_conflict, "G53 is allowed with G0 and G1 only");
  if (!takes_axes) return;
  use(kAxes);
  position_known_ = false;
}

Point3 Linter::target() const {
  Point3 to = at_;
  for (int axis = 0; axis < 3; ++axis) {
    const char letter = static_cast<char>('X' + axis);
    if (!has(letter)) continue;
    to[axis] = value(letter) * scale_ + (absolute_ ? 0.0 : at_[axis]);
  }
  return to;
}

void Linter::move() {
  const bool stated = states(Group::motion);
  const bool axes = (letters_ & ~used_ & kAxes) != 0;
  if (!stated && !axes) return;
  const bool special = states(Group::reference) && (used_ & letters_ & kAxes) != 0;
  if (special) return;
  if (motion_ == kNoMotion) {
    if (axes) refuse(codes::lint_conflict, "axis words after G80, which ends the modal motion");
    return;
  }
  const bool thread = is_thread(motion_);  // its feed follows from the spindle
  const bool feeds = motion_ >= 10 && motion_ < kNoMotion && !thread;
  if (feeds && (inverse_time_ ? !(has('F') && value('F') > 0.0) : !feed_known_))
    return refuse(codes::lint_missing, "a cut before any feed");
  const bool probe = is_probe(motion_) || motion_ == kSkip;
  const bool arc = is_arc(motion_);
  if (!axes && (probe || arc)) return refuse(codes::lint_missing, "the motion needs axis words");
  if (thread && !has('K')) return refuse(codes::lint_missing, "G33 needs K, the distance per revolution");
  if (thread) use(bit('K'));
  if (is_cycle(motion_) || is_spline(motion_) || motion_ == kThreadCycle)
    use(bit('R') | bit('Q') | bit('P') | bit('L') | kCentre);
  if (motion_ == kThreadCycle) use(bit('H'));
  use(kAxes | bit('E'));
  const Point3 to = target();
  if (probe && position_known_ && to == at_) return refuse(codes::lint_value, "a probing motion of length 0");
  if (arc) use_arc();
  if (refused_) return;
  if (arc) check_arc(to);
  at_ = to;
  if (has_code(530) || probe) position_known_ = false;
  // After all axes in work coordinates the position is known.
  else if (absolute_ && (letters_ & kLinear) == kLinear)
    position_known_ = true;
}

void Linter::use_arc() {
  const PlaneAxes axes = axes_of(plane_);
  const std::uint32_t in_plane = bit(static_cast<char>('X' + axes.u)) | bit(static_cast<char>('X' + axes.v));
  const std::uint32_t centre = bit(static_cast<char>('I' + axes.u)) | bit(static_cast<char>('I' + axes.v));
  if ((letters_ & in_plane) == 0)
    return refuse(codes::lint_missing, "an arc needs an axis word of its plane");
  if (has('R')) {
    use(bit('R'));
    return;
  }
  if ((letters_ & centre) == 0) return refuse(codes::lint_missing, "an arc needs its centre or its radius");
  use(kCentre | bit('P'));
}

void Linter::check_arc(Point3 to) {
  if (!position_known_ || absolute_centres_) return;
  const PlaneAxes axes = axes_of(plane_);
  const Point2 offset{to[axes.u] - at_[axes.u], to[axes.v] - at_[axes.v]};
  if (has('R')) {
    const double chord = length(offset);
    if (chord == 0.0) return refuse(codes::lint_missing, "an arc with R ends at its start point");
    if (chord > 2.0 * std::abs(value('R')) * scale_ + kMismatch.absolute.mm())
      refuse(codes::lint_arc, "the radius is smaller than half the distance to the end point");
    return;
  }
  const auto word = [this](int axis) {
    const char letter = static_cast<char>('I' + axis);
    return has(letter) ? value(letter) * scale_ : 0.0;
  };
  const Point2 centre{word(axes.u), word(axes.v)};
  const double start = length(centre), end = distance(centre, offset);
  if (!kMismatch.permits(start, end))
    refuse(codes::lint_arc,
           fmt::format("the arc starts {:.4f} mm and ends {:.4f} mm from its centre", start, end));
}

void Linter::check_unused() {
  const std::uint32_t left = letters_ & ~used_;
  for (char letter = 'A'; letter <= 'Z' && !refused_; ++letter)
    if ((left & bit(letter)) != 0)
      refuse(codes::lint_unused, fmt::format("no code on this line uses the {} word", letter));
}

}  // namespace

bool lint(std::string_view text, const PostProfile& profile, const std::string& file_name, LintStart start,
          Diagnostics& diagnostics) {
  const std::size_t errors = diagnostics.errors();
  BlockReaderOptions options;
  options.file_name = file_name;
  if (profile.syntax == LineSyntax::commands) options.commands = BlockReaderOptions::Commands::words;
  BlockReader reader(text, options, diagnostics);
  Linter linter(profile, file_name, start, diagnostics);
  Block block;
  while (reader.next(block)) linter.check(block);
  return diagnostics.errors() == errors;
}

}  // namespace kerf::gcode

namespace kerf {

bool lint_gcode(std::string_view text, const PostProfile& profile, const std::string& file_name,
                Diagnostics& diagnostics) {
  return gcode::lint(text, profile, file_name, gcode::LintStart::of_program, diagnostics);
}

}  // namespace kerf

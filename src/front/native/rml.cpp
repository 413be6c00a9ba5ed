// Reads RML-1: commands of one or two letters, "!" or "^" before some, their numbers after them.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <utility>
#include <vector>

#include "base/codes/gcode.h"
#include "base/ending.h"
#include "base/names.h"
#include "base/number.h"
#include "front/native/native_program.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace {

constexpr double kCoarseStep = 0.025, kFineStep = 0.01;       // mm
constexpr double kCoarseFastest = 15.0, kFineFastest = 50.0;  // mm/s: the highest speeds of the models
constexpr unsigned kZ = 4, kPlaneXy = 3;
constexpr std::size_t kMaxNumbers = 100'000;  // of one command
constexpr std::size_t kLongestNumber = 40;    // characters

class RmlReader {
 public:
  RmlReader(std::string_view text, const std::string& file, Diagnostics& diagnostics)
      : text_(text), file_(file), diagnostics_(diagnostics) {}
  NativeProgram read();

 private:
  struct Command {
    std::string name;  // in capitals, without ^
    std::vector<double> numbers;
  };
  bool next(Command& command);
  bool numbers(Command& command);
  char take();
  void skip(char also);
  void run(const Command& command);
  bool motion(const Command& command);
  bool setting(const Command& command);
  void find_step();
  void to_points(const Command& command);
  void pen(bool up);
  void plane(const Command& command, bool up, bool relative);
  void lift(double z);
  void home();
  void go(Point3 to, unsigned unknown, double mm_per_second, bool rapid);
  double number(const Command& command, std::size_t index, double otherwise) const {
    return index < command.numbers.size() ? command.numbers[index] : otherwise;
  }
  void error(Code code, std::string message) {
    diagnostics_.error(code, TextLocation{file_, line_, column_}, std::move(message));
  }
  OriginId here() { return out_.path.origins().text(file_index_, line_, column_); }
  bool fits(double steps) const { return std::abs(steps * step_) <= limits::kMaxCoordinate; }

  std::string_view text_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  NativeProgram out_;
  std::uint32_t file_index_ = 0, line_ = 1, column_ = 0, next_column_ = 1;
  double step_ = kCoarseStep, fastest_ = kCoarseFastest;
  double speed_xy_ = 0.0, speed_z_ = 0.0;  // mm/s; 0: unknown
  std::optional<double> up_, down_;        // mm, of !PZ; the machine's own until then
  bool pen_is_up_ = true, relative_ = false;
  PathPosition position_;
};

/// ^DF starts the files for models of 0.01 mm.
void RmlReader::find_step() {
  constexpr std::size_t kStart = 200;
  const std::string start = fold_name(text_.substr(0, kStart));
  const bool fine = start.find("^df") != std::string::npos, coarse = start.find("^in") != std::string::npos;
  if (fine) step_ = kFineStep, fastest_ = kFineFastest;
  out_.units_given = fine != coarse;
  if (!out_.units_given)
    diagnostics_.note(
        codes::native_assumed, TextLocation{file_, 0, 0},
        fmt::format("the program does not start with ^IN (steps of 0.025 mm) or ^DF (0.01 mm); its "
                    "steps are read as {} mm",
                    step_));
}

char RmlReader::take() {
  const char c = text_.front();
  text_.remove_prefix(1);
  next_column_ = c == '\n' ? 1 : next_column_ + 1;
  if (c == '\n') ++line_;
  return c;
}

/// Past blanks and the given character.
void RmlReader::skip(char also) {
  while (!text_.empty() && (static_cast<unsigned char>(text_.front()) <= ' ' || text_.front() == also))
    take();
}

/// The numbers of a command, with commas or blanks between them. False, with an error, after a wrong one.
bool RmlReader::numbers(Command& command) {
  for (skip(','); !text_.empty(); skip(',')) {
    const std::size_t length = std::min(text_.find_first_not_of("0123456789+-."), text_.size());
    if (length == 0) return true;
    const auto value = length > kLongestNumber ? std::nullopt : parse_number(text_.substr(0, length));
    if (!value || !fits(*value) || command.numbers.size() == kMaxNumbers) {
      error(codes::native_value, fmt::format("a number of {} is wrong or too large", command.name));
      return false;
    }
    for (std::size_t i = 0; i < length; ++i) take();
    command.numbers.push_back(*value);
  }
  return true;
}

/// The next command; false at the end, or after an error.
bool RmlReader::next(Command& command) {
  skip(';');
  if (text_.empty()) return false;
  column_ = next_column_;
  command = {};
  if (text_.front() == '^') take();
  while (!text_.empty()) {
    const char c = capital_letter(text_.front());
    const std::size_t longest = !command.name.empty() && command.name[0] == '!' ? 3 : 2;
    const bool mark = (c == '!' || c == '@') && command.name.empty();
    if (command.name.size() == longest || command.name == "@" || (!mark && !(c >= 'A' && c <= 'Z'))) break;
    command.name += capital_letter(take());
  }
  if (!command.name.empty() && command.name != "!") return numbers(command);
  error(codes::native_command,
        fmt::format("\"{}\" is no command of RML-1", clipped(text_.substr(0, 20), 20)));
  return false;
}

void RmlReader::go(Point3 to, unsigned unknown, double mm_per_second, bool rapid) {
  const Feed feed = mm_per_min(60.0 * mm_per_second);
  const std::size_t i =
      rapid ? out_.path.add(step::Rapid{to}, here()) : out_.path.add(step::Cut{to, feed}, here());
  out_.path.set_unknown_axes(i, unknown);
  position_.pass(out_.path[i]);
}

/// Z and !ZZ: points of three numbers at the speed of V.
void RmlReader::to_points(const Command& command) {
  if (command.numbers.empty() || command.numbers.size() % 3 != 0)
    return error(codes::native_value, fmt::format("{} is not followed by x, y, z", command.name));
  for (std::size_t k = 0; k < command.numbers.size(); k += 3) {
    Point3 to{step_ * command.numbers[k], step_ * command.numbers[k + 1], step_ * command.numbers[k + 2]};
    if (relative_) to = to + position_.at;
    const bool rapid = speed_z_ >= fastest_ && to.z >= 0.0;
    go(to, relative_ ? position_.unknown : 0, speed_z_, rapid);
  }
}

/// To the upper or lower height of !PZ, alone.
void RmlReader::pen(bool up) {
  pen_is_up_ = up;
  const std::optional<double> z = up ? up_ : down_;
  const bool known = (position_.unknown & kZ) == 0;
  if (z ? known && position_.at.z == *z : !known) return;
  go({position_.at.x, position_.at.y, z.value_or(position_.at.z)},
     z ? position_.unknown & ~kZ : position_.unknown | kZ, speed_z_, up);
}

/// PU, PD, PA, PR, M, D, R, I with points of two numbers.
void RmlReader::plane(const Command& command, bool up, bool relative) {
  if (command.numbers.size() % 2 != 0)
    return error(codes::native_value, fmt::format("{} is not followed by x, y", command.name));
  if (!command.numbers.empty() || command.name[0] == 'P') pen(up);
  for (std::size_t k = 0; k < command.numbers.size(); k += 2) {
    Point3 to{step_ * command.numbers[k], step_ * command.numbers[k + 1], position_.at.z};
    if (relative) to = {to.x + position_.at.x, to.y + position_.at.y, to.z};
    go(to, relative ? position_.unknown : position_.unknown & ~kPlaneXy, speed_xy_, up);
  }
}

void RmlReader::lift(double z) {
  const double to = relative_ ? position_.at.z + z : z;
  const unsigned unknown = relative_ ? position_.unknown : position_.unknown & ~kZ;
  go({position_.at.x, position_.at.y, to}, unknown, speed_z_, speed_z_ >= fastest_ && to >= 0.0);
}

/// Up to the machine's top, to the origin, the spindle off.
void RmlReader::home() {
  const std::size_t i = out_.path.add(step::Rapid{{position_.at.x, position_.at.y, 0.0}}, here());
  out_.path.set_unknown_axes(i, position_.unknown | kZ);
  out_.path.set_reference(i, Reference::machine, kZ);
  position_.pass(out_.path[i]);
  go({0.0, 0.0, position_.at.z}, kZ, 0.0, true);
  out_.path.add(step::Spindle{}, here());
}

bool RmlReader::motion(const Command& command) {
  const std::string& name = command.name;
  if (name == "Z" || name == "!ZZ") return to_points(command), true;
  if (name == "!ZM") return lift(step_ * number(command, 0, 0.0)), true;
  if (name == "PU" || name == "PD") return plane(command, name == "PU", relative_), true;
  if (name == "M" || name == "D") return plane(command, name == "M", false), true;
  if (name == "R" || name == "I") return plane(command, name == "R", true), true;
  if (name == "H") return home(), true;
  if (name != "PA" && name != "PR") return false;
  relative_ = name == "PR";
  if (!command.numbers.empty()) plane(command, pen_is_up_, relative_);
  return true;
}

bool RmlReader::setting(const Command& command) {
  const std::string& name = command.name;
  const bool xy = name == "VS" || name == "F", z = name == "!VZ" || name == "V";
  if (xy || z) {
    const double speed = number(command, 0, 0.0);
    if (!(speed > 0.0)) return error(codes::native_value, fmt::format("{} has no speed above 0", name)), true;
    (xy ? speed_xy_ : speed_z_) = speed;
    return true;
  }
  if (name == "!PZ" || name == "@") {
    down_ = step_ * number(command, 0, 0.0);
    if (command.numbers.size() > 1) up_ = step_ * command.numbers[1];
    return true;
  }
  if (name == "!MC") {
    const bool on = number(command, 0, 1.0) != 0.0;
    out_.path.add(step::Spindle{{}, on ? SpindleTurn::cw : SpindleTurn::off}, here());
    return true;
  }
  if (name == "IN" || name == "DF") return relative_ = false, true;
  if (name != "!RC" && name != "!DW" && name != "W" && name != "!NR") return false;
  if ((name == "!DW" || name == "W") && number(command, 0, 0.0) != 0.0)
    diagnostics_.warning(codes::native_command, TextLocation{file_, line_, column_},
                         "dwells before motions are not read");
  return true;
}

void RmlReader::run(const Command& command) {
  if (!motion(command) && !setting(command))
    error(codes::native_command, fmt::format("\"{}\" is no command of RML-1 that is read", command.name));
}

NativeProgram RmlReader::read() {
  find_step();
  file_index_ = out_.path.origins().file(file_);
  Command command;
  while (next(command) && !diagnostics_.has_errors()) run(command);
  out_.ended = true;  // the language has no word for it
  return std::move(out_);
}

}  // namespace

NativeProgram read_rml(std::string_view text, const std::string& file_name, Diagnostics& diagnostics) {
  return RmlReader(text, file_name, diagnostics).read();
}

bool looks_like_rml(std::string_view text) {
  constexpr std::size_t kStart = 64;
  const std::string start = fold_name(text.substr(0, kStart));
  for (const std::string_view mark : {";;^in", ";;^df", "^in;", "^df;", "pa;pa;", "^pa;"})
    if (start.rfind(mark, 0) == 0) return true;
  return false;
}

}  // namespace kerf

// Reads OpenSBP, line by line.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/codes/gcode.h"
#include "base/ending.h"
#include "base/names.h"
#include "base/number.h"
#include "front/native/native_program.h"

#include "kerf/base/limits.h"
#include "kerf/base/tolerance.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxParameters = 40;
constexpr unsigned kAllAxes = 7;

std::string in_capitals(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), capital_letter);
  return out;
}

/// &NAME, or $NAME for one that the control stores.
bool is_variable(std::string_view text) { return text.size() > 1 && (text[0] == '&' || text[0] == '$'); }

/// A line without its comment; an apostrophe starts one.
std::string_view code_of(std::string_view line) { return trim(line.substr(0, line.find('\''))); }

class OpenSbpReader {
 public:
  OpenSbpReader(std::string_view text, const std::string& file, Diagnostics& diagnostics)
      : text_(text), file_(file), diagnostics_(diagnostics) {}
  NativeProgram read();

 private:
  void find_unit();
  void line(std::string_view line);
  void command(std::string_view code);
  bool statement(std::string_view code);
  void assign(std::string_view code);
  /// The value of a variable that is known, else the text itself.
  std::string_view value_of(std::string_view text) const;
  bool motion(std::string_view name);
  bool setting(std::string_view name);
  void straight(bool rapid, unsigned axes);
  void arc();
  void speeds();
  void output();
  void turn(bool on);
  void tool(std::string_view value);
  void pause();

  OriginId here() { return out_.path.origins().text(file_index_, line_, 0); }
  void error(Code code, std::string message) {
    diagnostics_.error(code, TextLocation{file_, line_, 0}, std::move(message));
  }
  /// A parameter from 0 on; nothing if it is empty, or, with an error, if it is no number.
  std::optional<double> parameter(std::size_t index);
  std::optional<double> length(std::size_t index);

  std::string_view text_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  NativeProgram out_;
  std::uint32_t file_index_ = 0, line_ = 0;
  std::vector<std::string_view> parameters_;
  std::map<std::string, std::string_view> variables_;  // by their names in capitals
  double unit_mm_ = 1.0;
  Feed feed_xy_, feed_z_;
  SpindleSpeed speed_;
  bool turns_ = false;
  PathPosition position_;
};

/// IF %(25)=0 leads to an error where the machine is set to inches: the file is in mm.
void OpenSbpReader::find_unit() {
  const std::string all = fold_name(text_.substr(0, std::size_t{1} << 16));
  const bool in_mm = all.find("if%(25)=0") != std::string::npos;
  const bool in_inches = all.find("if%(25)=1") != std::string::npos;
  out_.units_given = in_mm != in_inches;
  out_.inch = !in_mm || in_inches;
  unit_mm_ = out_.inch ? kMmPerInch : 1.0;
  if (!out_.units_given)
    diagnostics_.note(codes::native_assumed, TextLocation{file_, 0, 0},
                      "the program does not test the unit of the machine (IF %(25)=0 for mm); it is read in "
                      "inches");
}

std::optional<double> OpenSbpReader::parameter(std::size_t index) {
  if (index >= parameters_.size() || parameters_[index].empty()) return std::nullopt;
  const std::string_view text = parameters_[index];
  const std::string_view known = value_of(text);
  const auto value = parse_number(known);
  if (value && std::abs(*value) <= limits::kMaxCoordinate) return value;
  const bool unknown = text.front() == '%' || (is_variable(text) && known == text);
  error(codes::native_value,
        fmt::format("parameter {} is \"{}\", {}", index + 1, clipped(text, 40),
                    unknown         ? "whose value is unknown"
                    : known != text ? fmt::format("which is \"{}\", not a number", clipped(known, 40))
                                    : "not a number"));
  return std::nullopt;
}

std::string_view OpenSbpReader::value_of(std::string_view text) const {
  if (!is_variable(text)) return text;
  const auto known = variables_.find(in_capitals(text));
  return known == variables_.end() ? text : known->second;
}

/// &NAME = VALUE: a number, a text with or without quotes, or another variable. What has to be computed stays
/// a text, which no motion can use.
void OpenSbpReader::assign(std::string_view code) {
  const std::size_t equals = code.find('=');
  const std::string_view name = trim(code.substr(0, equals));
  if (equals == std::string_view::npos || !is_variable(name))
    return error(codes::native_command,
                 fmt::format("\"{}\" is no assignment, such as &depth = 3", clipped(code, 60)));
  const std::string_view value = value_of(trim(code.substr(equals + 1)));
  const bool quoted = value.size() > 1 && value.front() == '"' && value.back() == '"';
  variables_[in_capitals(name)] = quoted ? value.substr(1, value.size() - 2) : value;
  if (in_capitals(name) == "&TOOL") tool(value);
}

std::optional<double> OpenSbpReader::length(std::size_t index) {
  const auto value = parameter(index);
  if (!value || std::abs(*value * unit_mm_) <= limits::kMaxCoordinate)
    return value ? std::optional(*value * unit_mm_) : std::nullopt;
  error(codes::native_value, fmt::format("parameter {} is too large", index + 1));
  return std::nullopt;
}

/// `axes`: those of the parameters, in their order.
void OpenSbpReader::straight(bool rapid, unsigned axes) {
  Point3 to = position_.at;
  unsigned unknown = position_.unknown;
  std::size_t index = 0;
  const std::array<double*, 3> values{&to.x, &to.y, &to.z};
  for (unsigned axis = 0; axis < values.size(); ++axis) {
    if ((axes >> axis & 1u) == 0) continue;
    const auto value = length(index++);
    if (!value) continue;
    *values[axis] = *value;
    unknown &= ~(1u << axis);
  }
  const bool in_plane = to.x != position_.at.x || to.y != position_.at.y;
  const Feed feed = in_plane || !(feed_z_ > Feed{}) ? feed_xy_ : feed_z_;
  const std::size_t i =
      rapid ? out_.path.add(step::Rapid{to}, here()) : out_.path.add(step::Cut{to, feed}, here());
  out_.path.set_unknown_axes(i, unknown);
  position_.pass(out_.path[i]);
}

/// CG, unused, end X, end Y, centre X and Y from the start, I-O-T, direction (1 clockwise), plunge.
void OpenSbpReader::arc() {
  const auto x = length(1), y = length(2), u = length(3), v = length(4);
  if (!u || !v) return error(codes::native_value, "CG has no centre: parameters 4 and 5");
  const std::string side = parameters_.size() > 5 ? in_capitals(parameters_[5]) : "";
  const double turn = parameter(6).value_or(1.0);
  if (!side.empty() && side != "T")
    return error(codes::native_command, "CG with compensation of the cutter (I or O) is not read");
  for (const std::size_t further : {7u, 11u})
    if (parameter(further).value_or(0.0) != 0.0)
      return error(codes::native_command, "CG with a plunge or a pocket is not read");
  if (position_.unknown != 0)
    return error(codes::native_value, "CG starts at an unknown position; move X, Y and Z before it");
  const Point3 from = position_.at;
  const Point3 to{x.value_or(from.x), y.value_or(from.y), from.z};
  const Point2 centre{from.x + *u, from.y + *v};
  const double start = std::hypot(*u, *v), end = std::hypot(to.x - centre.x, to.y - centre.y);
  if (!(start > 0.0) || !ArcMismatch().permits(start, end))
    return error(codes::native_value,
                 fmt::format("the arc starts {:.4f} mm and ends {:.4f} mm from its centre", start, end));
  const std::size_t i =
      out_.path.add(step::Arc{to, centre, Plane::xy, turn < 0.0 ? Turn::ccw : Turn::cw, 0, feed_xy_}, here());
  position_.pass(out_.path[i]);
}

/// MS and VS: of X and Y, of Z, in units per second.
void OpenSbpReader::speeds() {
  const auto xy = length(0), z = length(1);
  if ((xy && !(*xy > 0.0)) || (z && !(*z > 0.0))) return error(codes::native_value, "a speed is not above 0");
  if (xy) feed_xy_ = mm_per_min(60.0 * *xy);
  if (z) feed_z_ = mm_per_min(60.0 * *z);
}

void OpenSbpReader::turn(bool on) {
  turns_ = on;
  out_.path.add(step::Spindle{on ? speed_ : SpindleSpeed{}, on ? SpindleTurn::cw : SpindleTurn::off}, here());
}

/// SO, number, 1 or 0: output 1 is the spindle.
void OpenSbpReader::output() {
  constexpr double kSpindle = 1.0;
  const auto number = parameter(0), value = parameter(1);
  if (number == kSpindle) return turn(value.value_or(0.0) != 0.0);
  diagnostics_.warning(codes::native_command, TextLocation{file_, line_, 0},
                       "an output other than 1 is not read");
}

bool OpenSbpReader::setting(std::string_view name) {
  if (name == "MS" || name == "VS") return speeds(), true;
  if (name == "SO") return output(), true;
  if (name == "C6" || name == "C7") return turn(name == "C6"), true;
  if (name == "TR") {
    const auto rpm_value = parameter(0);
    if (!rpm_value || !(*rpm_value >= 0.0 && *rpm_value <= limits::kMaxSpeed))
      return error(codes::native_value, "TR has no speed of the spindle in rpm"), true;
    speed_ = rpm(*rpm_value);
    if (turns_) turn(true);
    return true;
  }
  // Speeds and ramps of jogs, absolute distances, the change of the tool that &Tool has named, messages.
  for (const std::string_view known : {"JS", "VR", "VC", "SA", "C9", "CN", "C#"})
    if (name == known) return true;
  return false;
}

bool OpenSbpReader::motion(std::string_view name) {
  struct Move {
    std::string_view ending;
    unsigned axes;
  };
  constexpr std::array kMoves{Move{"X", 1}, Move{"Y", 2}, Move{"Z", 4}, Move{"2", 3}, Move{"3", kAllAxes}};
  if (name == "CG") return arc(), true;
  if (name == "MH" || name == "JH") {
    parameters_ = {"0", "0"};
    return straight(name == "JH", 3), true;
  }
  for (const Move& move : kMoves)
    if (name.size() == 2 && name.substr(1) == move.ending && (name[0] == 'M' || name[0] == 'J'))
      return straight(name[0] == 'J', move.axes), true;
  return false;
}

void OpenSbpReader::tool(std::string_view value) {
  const auto number = parse_number(value);
  if (!number || !(*number >= 0.0 && *number <= limits::kMaxToolNumber) || *number != std::floor(*number))
    return error(codes::native_value, "&Tool is not set to the number of a tool");
  out_.path.add(step::ToolChange{static_cast<int>(*number)}, here());
}

void OpenSbpReader::pause() {
  if (parameters_.empty() || parameters_[0].empty()) return void(out_.path.add(step::Pause{}, here()));
  const auto time = parameter(0);
  if (time && *time >= 0.0 && *time <= limits::kMaxDwellSeconds)
    out_.path.add(step::Dwell{seconds(*time)}, here());
  else if (time)
    error(codes::native_value, "PAUSE is not followed by seconds");
}

/// Statements of the language that are no commands. True if it was one.
bool OpenSbpReader::statement(std::string_view code) {
  const std::string folded = fold_name(code);
  if (folded.rfind("if%(25)=", 0) == 0) return true;  // the unit, see find_unit
  if (code.front() == '&' || code.front() == '$') return assign(code), true;
  if (code.back() == ':') return true;  // a label
  if (code.front() == '%' || folded.rfind("if", 0) == 0 || folded.rfind("goto", 0) == 0 ||
      folded.rfind("gosub", 0) == 0) {
    error(codes::native_command,
          fmt::format("\"{}\": branches and settings of the control are not read", clipped(code, 60)));
    return true;
  }
  return false;
}

void OpenSbpReader::command(std::string_view code) {
  const std::size_t end = std::min(code.find_first_of(", \t"), code.size());
  const std::string name = in_capitals(code.substr(0, end));
  parameters_.clear();
  std::string_view rest = end < code.size() ? code.substr(end + 1) : std::string_view();
  if (end < code.size() && code[end] != ',') {
    rest = trim(rest);
    if (!rest.empty() && rest.front() == ',') rest.remove_prefix(1);
  }
  while (end < code.size() && parameters_.size() < kMaxParameters) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    parameters_.push_back(trim(rest.substr(0, comma)));
    if (comma == rest.size()) break;
    rest.remove_prefix(comma + 1);
  }
  if (name == "END") {
    out_.ended = true;
    out_.path.add(step::End{}, here());
  } else if (name == "PAUSE") {
    pause();
  } else if (!motion(name) && !setting(name)) {
    error(codes::native_command,
          fmt::format("\"{}\" is no command of OpenSBP that is read", clipped(name, 40)));
  }
}

void OpenSbpReader::line(std::string_view line) {
  const std::size_t quote = line.find('\'');
  if (quote != std::string_view::npos)
    if (const std::string_view text = trim(line.substr(quote + 1)); !text.empty())
      out_.path.add(step::Note{std::string(text)}, here());
  const std::string_view code = code_of(line);
  if (!code.empty() && !statement(code)) command(code);
}

NativeProgram OpenSbpReader::read() {
  find_unit();
  file_index_ = out_.path.origins().file(file_);
  while (!text_.empty() && !out_.ended) {
    ++line_;
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    line(text_.substr(0, end));
    text_.remove_prefix(std::min(end + 1, text_.size()));
  }
  return std::move(out_);
}

}  // namespace

NativeProgram read_opensbp(std::string_view text, const std::string& file_name, Diagnostics& diagnostics) {
  return OpenSbpReader(text, file_name, diagnostics).read();
}

bool looks_like_opensbp(std::string_view text) {
  if (text.find('\0') != std::string_view::npos) return false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string code = in_capitals(code_of(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (code.empty() || code == "SA" || (is_variable(code) && code.find('=') != std::string::npos)) continue;
    if (code.rfind("IF %(25)", 0) == 0) return true;
    for (const std::string_view name :
         {"MS,", "JS,", "VS,", "M2,", "M3,", "MX,", "MY,", "MZ,", "J2,", "J3,", "JZ,", "CG,"})
      if (code.rfind(name, 0) == 0) return true;
    return false;
  }
  return false;
}

}  // namespace kerf

// Commands as rows of a table, and what a call of one gives it: arguments, location, messages.
//
//   Value rapid(Machine& machine, Call& call) {
//     machine.rapid(call.point(0));
//     return {};
//   }
//   constexpr const char* kText = "Move at rapid speed.";
//   const Command row{"rapid", parameters_of("ex, ey, ez, laser=0"), rapid, kText};
//
// A language has a CallSite: the location of a call, how a message reaches the user, and how a value is
// shown. A wrong argument ends its command by Refusal, which run() of this file reports; nothing else is
// thrown.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "design/call/value.h"

#include "kerf/base/diagnostics.h"
#include "kerf/base/origin.h"

namespace kerf::design {

class Call;
class Machine;

/// What is wrong about a call: the type of an argument, its value, or the time of the call (no stock, no open
/// file).
enum class Problem : unsigned char { type, value, state };

/// Ends the command that runs.
struct Refusal {
  Problem problem;
  std::string message;
};
[[noreturn]] void refuse(std::string message);
[[noreturn]] void refuse_type(std::string message);
[[noreturn]] void refuse_now(std::string message);
/// Ends the command that runs: its error has been reported.
struct Reported {};

/// The call of a command in the user's text or script.
class CallSite {
 public:
  CallSite() = default;
  CallSite(const CallSite&) = delete;
  CallSite& operator=(const CallSite&) = delete;
  virtual ~CallSite() = default;

  virtual Origin where() const = 0;
  /// The location, with its callers, in the table of a toolpath.
  virtual OriginId origin(OriginTable& origins) = 0;
  /// Messages of the machine about this call; they start with the name of the command.
  virtual void error(Problem problem, std::string message) = 0;
  virtual void warning(std::string message) = 0;
  /// Receives the messages of the library's functions.
  virtual Diagnostics& diagnostics() = 0;
  /// A line of text for the user, as of echo() or print().
  virtual void print(std::string_view line) = 0;
  /// A value as the language writes it in a program, and as its text: "a" and a.
  virtual std::string shown(const Value& value) const = 0;
  virtual std::string as_text(const Value& value) const = 0;
  /// The outlines that a call has besides its arguments: OpenSCAD's children. Nothing where there are none.
  virtual std::optional<std::vector<Outline>> children() = 0;
  /// A number that the program sets by assigning to a variable of this name, in languages that do so.
  virtual std::optional<double> variable(std::string_view name) const = 0;
};

/// A parameter; without a default it is required.
struct Parameter {
  std::string_view name;
  Value standard = {};
  bool required = false;
};
/// The parameters of "ex, ey, laser=0, name="Default", outline=undef, joined=true". The text must outlive
/// them.
std::vector<Parameter> parameters_of(std::string_view signature);

/// Whether further positional arguments are an error or come after the parameters.
enum class Further : unsigned char { refused, taken };

/// What a command yields.
enum class Gives : unsigned char {
  nothing,
  motions,  ///< the steps that it adds
  value
};

struct Command {
  std::string_view name;
  std::vector<Parameter> parameters;  // in the order of positional arguments
  Value (*run)(Machine& machine, Call& call) = nullptr;
  std::string text = {};  // what it does: a sentence, then details after an empty line
  Gives gives = Gives::nothing;
  Further further = Further::refused;
  bool needs_start = true;  // gcodepreview(...) comes first
  /// In the form of gcodepreview 0.93 the number of a tool comes first, in that of 0.9313 it is left out and
  /// this many numbers come first. Nothing: the command has one form.
  std::optional<std::size_t> numbers_without_tool = {};

  bool may_leave_out(std::size_t i) const {
    return !parameters[i].required || (i == 0 && numbers_without_tool);
  }
};

/// "name(first, second=1)", as in the manual.
std::string signature_of(const Command& command);
/// Both forms of a command that has two, for messages; otherwise empty.
std::string forms_of(const Command& command);

/// The parameter of the first positional argument: 1 where a call leaves out the number of the tool.
/// `numbers` positional arguments before the first of another kind are numbers; `names` are those given.
std::size_t first_parameter(const Command& command, std::size_t numbers,
                            std::span<const std::string_view> names);

class Call {
 public:
  /// `given` are in the order of the parameters, unset where none is given; missing ones at the end may be
  /// left out. All must outlive the call.
  Call(const Command& command, CallSite& site, std::span<const Value> given)
      : command_(command), site_(site), given_(given) {}

  const Command& command() const { return command_; }
  CallSite& site() { return site_; }

  // ---- arguments, by index of the parameter
  std::size_t size() const {  // parameters and further arguments
    return given_.size() > command_.parameters.size() ? given_.size() : command_.parameters.size();
  }
  /// The argument, or the parameter's default.
  const Value& operator[](std::size_t i) const {
    return i < given_.size() && !given_[i].is(Type::unset) ? given_[i] : command_.parameters[i].standard;
  }
  std::string_view name(std::size_t i) const { return command_.parameters[i].name; }

  // ---- arguments of a type; a wrong one ends the command
  /// A finite number.
  double number(std::size_t i) const {
    const Value& v = (*this)[i];
    if (v.is(Type::number) && v.number() - v.number() == 0.0) return v.number();
    not_a_number(i);
  }
  const std::string& text(std::size_t i) const;
  /// True, false, or a number (0: false).
  bool truth(std::size_t i) const;
  Point2 point2(std::size_t i) const { return {number(i), number(i + 1)}; }
  Point3 point3(std::size_t i) const { return {number(i), number(i + 1), number(i + 2)}; }
  /// The argument, or nothing for an undefined value.
  std::optional<double> optional_number(std::size_t i) const;
  std::optional<std::string> optional_text(std::size_t i) const;
  /// "x must be a finite number, not "a""
  [[noreturn]] void wrong_type(std::size_t i, std::string_view expected) const;

 private:
  [[noreturn]] void not_a_number(std::size_t i) const;

  const Command& command_;
  CallSite& site_;
  std::span<const Value> given_;
};

}  // namespace kerf::design

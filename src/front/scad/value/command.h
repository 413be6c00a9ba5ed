// Built-in commands: the table from which the interpreter calls them, and what a call gives them.
//
// A command is callable as a module (`rapid(1, 2, 3);`), as a function (`x = xpos();`) and as a method of an
// object (`gcp.rapid(1, 2, 3);`, `gcp.xpos()`). Definitions of the program with the same name come first.
//
//   Value rapid(Call& call) {
//     State& state = call.state<State>();
//     const auto to = call.point(0);  // x, y, z; an error has been reported if there is none
//     if (!to) return {};
//     state.path.add(step::Rapid{*to}, call.origin(state.path.origins()));
//     return {};
//   }
//   const std::vector<Command> commands{{"rapid", {{"x"}, {"y"}, {"z", 0.0}}, rapid}};
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "front/scad/value/shape.h"
#include "front/scad/value/value.h"

#include "kerf/base/diagnostics.h"
#include "kerf/base/origin.h"

namespace kerf::scad {

class Call;

/// What all commands of a run share: toolpath, position, tool and so on. The commands derive from it.
class CommandState {
 public:
  virtual ~CommandState() = default;
};

/// A parameter; without a default it is required.
struct CommandParameter {
  CommandParameter(std::string_view n) : name(n), required(true) {}  // NOLINT
  CommandParameter(const char* n) : name(n), required(true) {}       // NOLINT
  CommandParameter(std::string_view n, Value v) : name(n), standard(std::move(v)) {}
  std::string_view name;
  Value standard = {};
  bool required = false;
};

/// Whether further positional arguments are an error or come after the parameters.
enum class FurtherArguments : unsigned char { refused, taken };

struct Command {
  std::string_view name;
  std::vector<CommandParameter> parameters;  // in the order of positional arguments
  Value (*run)(Call& call);
  FurtherArguments further = FurtherArguments::refused;
};

/// The location of a call with the calls of modules and functions around it. The interpreter derives from it.
class CallSite {
 public:
  virtual ~CallSite() = default;
  virtual TextLocation where() const = 0;
  /// Calls that led here, innermost first: location, and "called by module side" or the like.
  virtual std::vector<DiagnosticNote> callers() const = 0;
  /// The location and its callers in the table of a toolpath. Equal callers are added once.
  virtual OriginId origin(OriginTable& origins) = 0;
  /// The union of the children `{ square(5); }` of the call, evaluated now: their commands run and their
  /// shapes are returned.
  virtual Shape children() = 0;
  virtual std::size_t child_count() const = 0;
  /// The value of a special variable such as "$fn"; undef if it has none.
  virtual Value special(std::string_view name) const = 0;
  /// Calls a function literal.
  virtual Value call(const Value& function, const std::vector<Value>& arguments) = 0;
  /// A line on the program's output, as of echo().
  virtual void print(std::string_view line) = 0;
};

class Call {
 public:
  /// `arguments` are in the order of the parameters; Type::unset where none is given.
  Call(const Command& command, CommandState* state, CallSite& site, Diagnostics& diagnostics,
       std::vector<Value> arguments, const Object* object = nullptr);

  const Command& command() const { return command_; }
  template <class State>
  State& state() const {
    return static_cast<State&>(*state_);
  }
  /// The object of a call as a method, else null.
  const Object* object() const { return object_; }

  // ---- arguments, by index of the parameter
  std::size_t size() const { return arguments_.size(); }  // parameters and further arguments
  /// The argument, or the parameter's default.
  const Value& operator[](std::size_t i) const { return arguments_[i]; }
  /// By the name of a parameter of the table (asserted).
  const Value& operator[](std::string_view name) const { return arguments_[index_of(name)]; }
  std::size_t index_of(std::string_view name) const;
  bool given(std::size_t i) const { return given_[i]; }
  bool given(std::string_view name) const { return given_[index_of(name)]; }

  // ---- arguments of a type; a wrong one is an error with the parameter's name, and gives nothing
  /// A finite number.
  std::optional<double> number(std::size_t i);
  std::optional<double> number(std::string_view name) { return number(index_of(name)); }
  /// Within limits, which the message names.
  std::optional<double> number_in(std::size_t i, double low, double high);
  std::optional<int> integer(std::size_t i, int low, int high);
  std::optional<std::string> text(std::size_t i);
  std::optional<std::string> text(std::string_view name) { return text(index_of(name)); }
  /// true, false, or a number (0: false).
  std::optional<bool> truth(std::size_t i);
  /// The coordinates in the parameters i, i + 1, i + 2.
  std::optional<Point3> point(std::size_t i);
  /// A vector of finite numbers.
  std::optional<std::vector<double>> numbers(std::size_t i);
  /// A vector of points of `dimension` numbers each.
  std::optional<std::vector<std::vector<double>>> points(std::size_t i, std::size_t dimension);

  // ---- position and messages
  CallSite& site() { return site_; }
  Origin where() const { return site_.where(); }
  OriginId origin(OriginTable& origins) { return site_.origin(origins); }
  /// Messages at the call, with its callers as notes. The reference is valid until the next message.
  Diagnostic& error(Code code, std::string message);
  Diagnostic& warning(Code code, std::string message);
  Diagnostic& note(Code code, std::string message);
  Diagnostics& diagnostics() { return diagnostics_; }
  /// Whether an error was reported by this call.
  bool failed() const { return failed_; }

  /// The shape that a command makes when called as a module.
  void give(Shape shape) { shape_ = std::move(shape); }
  Shape& shape() { return shape_; }

 private:
  Diagnostic& with_callers(Diagnostic& message);
  void wrong(std::size_t i, std::string_view expected);

  const Command& command_;
  CommandState* state_;
  CallSite& site_;
  Diagnostics& diagnostics_;
  std::vector<Value> arguments_;
  std::vector<bool> given_;
  const Object* object_;
  Shape shape_;
  bool failed_ = false;
};

/// The commands of a program and the state that they share.
struct CommandSet {
  const std::vector<Command>* commands = nullptr;
  CommandState* state = nullptr;
};

}  // namespace kerf::scad

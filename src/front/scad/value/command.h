// Built-in commands: the table from which the interpreter calls them, and what a call gives them.
//
// A command is callable as a module (`rapid(1, 2, 3);`), as a function (`x = xpos();`) and as a method of an
// object (`gcp.rapid(1, 2, 3);`, `gcp.xpos()`). Definitions of the program with the same name come first.
//
//   Value rapid(Call& call) {
//     State& state = call.state<State>();
//     if (!call[0].is_number()) return call.error(code, "x must be a number"), Value();
//     ...
//   }
//   const std::vector<Command> commands{{"rapid", {{"x"}, {"y"}, {"z", 0.0}}, rapid}};
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
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
  /// The parameter of the first positional argument, of which `numbers` are numbers before the first of
  /// another kind; null: the first.
  std::size_t (*first_parameter)(const Command& command, std::size_t numbers,
                                 std::span<const std::string_view> names) = nullptr;
  std::string forms = {};  // of commands with two: both, for messages
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
  /// The value of a variable of the program's top level; undef if there is none.
  virtual Value variable(std::string_view name) const = 0;
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

  /// In the order of the parameters, then the further ones; Type::unset where none is given.
  const std::vector<Value>& arguments() const { return arguments_; }

  // ---- position and messages
  CallSite& site() { return site_; }
  Origin where() const { return site_.where(); }
  OriginId origin(OriginTable& origins) { return site_.origin(origins); }
  /// Messages at the call, with its callers as notes. The reference is valid until the next message.
  Diagnostic& error(Code code, std::string message);
  Diagnostic& warning(Code code, std::string message);
  Diagnostics& diagnostics() { return diagnostics_; }

  /// The shape that a command makes when called as a module.
  void give(Shape shape) { shape_ = std::move(shape); }
  Shape& shape() { return shape_; }

 private:
  Diagnostic& with_callers(Diagnostic& message);

  const Command& command_;
  CommandState* state_;
  CallSite& site_;
  Diagnostics& diagnostics_;
  std::vector<Value> arguments_;
  const Object* object_;
  Shape shape_;
};

/// What import() asks for: a file beside the program, and of a drawing the layer (empty: all).
struct ImportedFile {
  std::string path, layer;
  TextLocation where;
};
/// A dimension or crossing of a DXF file, as dxf_dim() and dxf_cross() measure them.
struct Measured {
  ImportedFile file;
  std::string name;  // of a dimension
  Point2 origin;
  double scale = 1.0;
};
/// A text of text() in the first of some font files that has a family and style (empty: any).
struct FileText {
  std::vector<std::string> files;
  std::string family, style;
  std::string text;
  double em = 0.0;       // the size of the font, mm
  double spacing = 1.0;  // of characters, as a multiple of that of the font
  TextLocation where;
};
struct PlacedText {
  Region region;       // from the origin
  double width = 0.0;  // from the first character to the next after the last one
  std::string file;
};
/// Reads what programs import; nothing, with errors, for what cannot be read.
struct Imports {
  std::function<std::optional<Region>(const ImportedFile&, Diagnostics&)> drawing;
  std::function<std::optional<SolidBody>(const ImportedFile&, Diagnostics&)> mesh;
  std::function<std::optional<double>(const Measured&, Diagnostics&)> dimension;
  std::function<std::optional<Point2>(const Measured&, Diagnostics&)> crossing;
  /// Nothing without an error if no file has the family.
  std::function<std::optional<PlacedText>(const FileText&, Diagnostics&)> text;
};

/// The commands of a program and the state that they share; and what reads files.
struct CommandSet {
  const std::vector<Command>* commands = nullptr;
  CommandState* state = nullptr;
  const Imports* imports = nullptr;
};

}  // namespace kerf::scad

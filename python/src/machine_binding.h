// gcodepreview's machine in Python: the object, the call site of a script, and values both ways.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "design/commands/commands.h"
#include "design/machine/machine.h"

namespace kerf::python {

/// Origins of calls by their position in the script's code, so that a call in a loop is looked up once.
class ScriptLocations {
 public:
  ScriptLocations() = default;
  ~ScriptLocations() { clear(); }
  ScriptLocations(const ScriptLocations&) = delete;
  ScriptLocations& operator=(const ScriptLocations&) = delete;
  /// The origin of the running call of a command, in the table of `path`.
  OriginId origin(const std::shared_ptr<Toolpath>& path, const design::Command& command);

 private:
  struct Entry {
    PyObject* code = nullptr;  // owned
    int at = -1;               // position in the code
    const design::Command* command = nullptr;
    OriginId origin = OriginId::none;
  };
  void clear();

  static constexpr std::size_t kEntries = 64;
  std::array<Entry, kEntries> entries_{};
  std::shared_ptr<Toolpath> path_;
};

/// The progress of a call: signals are checked from its first use on.
class CallProgress final : public Progress {
 public:
  void phase(std::string_view what) override { signals().phase(what); }
  void report(double fraction) override { signals().report(fraction); }
  bool stop_requested() override { return signals().stop_requested(); }
  /// Raises what has stopped the call, and forgets it.
  void finish();

 private:
  SignalProgress& signals();
  std::optional<SignalProgress> signals_;
};

/// The machine of an object.
class PyMachine {
 public:
  PyMachine();
  PyMachine(const PyMachine&) = delete;
  PyMachine& operator=(const PyMachine&) = delete;

  /// Writes the files that a command has made; raises OSError, or kerf.Error if a post refuses the toolpath.
  void write_outputs();

  CallProgress progress;
  pybind11::handle self;            // the object, while a command runs
  std::string folder;               // of outputs with a relative name
  std::vector<std::string> inputs;  // files that were read
  design::Machine machine;
  ScriptLocations locations;
};

/// Calls a command with the arguments of Python's vector call; returns a new reference, or null with an
/// error.
PyObject* call_command(const design::Command& command, PyMachine& object, PyObject* self,
                       PyObject* const* args, Py_ssize_t count, PyObject* names);
/// The same, of the machine that `find` has for `self`.
PyObject* call_command(const design::Command& command, PyObject* self, PyObject* const* args,
                       Py_ssize_t count, PyObject* names, PyMachine& (*find)(PyObject*));
[[noreturn]] void raise_machine_error(const std::string& text);
/// The end of the last motion before step `first`.
Point3 start_of(const Toolpath& path, std::size_t first);

/// A value of Python for a command. The object must outlive it.
design::Value to_value(PyObject* object, int depth = 0);
pybind11::object to_object(const design::Value& value);
/// "name($self, ex, ey, ez, laser=0)\n--\n\n" and the text of the command.
std::string docstring_of(const design::Command& command);

/// The moves of the steps from number `first` on, as a list of the class `Moves`; `at` is their start.
pybind11::object moves_of(const Toolpath& path, std::size_t first, Point3 at, int tool);
/// Sets the classes of moves and of lists of them.
void set_move_classes(const pybind11::object& move, const pybind11::object& moves);
/// Makes gcodepreview's exception.
void add_machine_error(pybind11::module_& m);
/// Keeps the exception that is set, which a function of the script has raised, until the command has ended.
void keep_error_of_callback();

void bind_machine(pybind11::module_& m);

}  // namespace kerf::python

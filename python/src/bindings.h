// Common to the bindings: diagnostics as exceptions, conversion of arguments, the location in the script.
#pragma once

#include <chrono>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>

#include "kerf/base/diagnostics.h"
#include "kerf/base/limits.h"
#include "kerf/base/progress.h"
#include "kerf/geom/geometry.h"
#include "kerf/program/path_drawing.h"

namespace kerf::python {

/// Raises kerf.Error with the list if it contains errors; else passes its warnings to the module warnings.
void raise_or_warn(const Diagnostics& diagnostics);
/// As raise_or_warn, but raises OSError if a file could not be read or written.
void raise_os_error_or_warn(const Diagnostics& diagnostics);
/// A list of kerf.Diagnostic.
pybind11::list to_list(const Diagnostics& diagnostics);

/// A point from any sequence of three finite numbers; otherwise raises TypeError or ValueError that names the
/// argument.
Point3 to_point3(const pybind11::handle& value, const char* argument);
Point2 to_point2(const pybind11::handle& value, const char* argument);
pybind11::tuple to_tuple(Point3 p);
/// A finite number; raises ValueError naming the argument.
double finite_number(double value, const char* argument);

/// A number from `low` to `high`; raises ValueError that names the argument and its unit.
double number_within(double value, double low, double high, const char* argument, const char* unit);
int whole_within(long long value, long long low, long long high, const char* argument);

/// Lets copy.copy and copy.deepcopy make a copy of a value.
template <class Value, class... Rest>
void bind_copy(pybind11::class_<Value, Rest...>& c) {
  c.def("__copy__", [](const Value& value) { return Value(value); });
  c.def(
      "__deepcopy__", [](const Value& value, const pybind11::dict&) { return Value(value); },
      pybind11::arg("memo"));
}

/// Text for Python; bytes that are not UTF-8 (comments of old files) become the replacement character.
pybind11::str to_str(std::string_view text);

/// The location of the running call in the user's script: the innermost that is not in a file registered by
/// `_library_file`.
CallLocation script_location(const char* call);

/// Whether a code object is of a file registered by `_library_file`.
bool is_library_code(PyObject* code);
/// Issues a UserWarning at the line of the user's script.
void warn_script(const std::string& text);

/// Stops long work on Ctrl-C, and calls the handler of kerf.progress, if there is one. Made and used on the
/// caller's thread, which holds the GIL; rethrow() raises the exception of the signal handler or of the
/// handler of progress.
class SignalProgress final : public Progress {
 public:
  SignalProgress();
  ~SignalProgress() override;
  SignalProgress(const SignalProgress&) = delete;
  SignalProgress& operator=(const SignalProgress&) = delete;

  void phase(std::string_view what) override;
  void report(double fraction) override;
  bool stop_requested() override;
  void rethrow();

 private:
  void call(double fraction);
  void keep_error();

  PyObject* handler_ = nullptr;  // callable(phase, fraction); owned
  std::string phase_;
  std::chrono::steady_clock::time_point next_call_;
  bool stopped_ = false;
  PyObject *type_ = nullptr, *value_ = nullptr, *traceback_ = nullptr;  // of the error, until rethrow()
};

/// The keywords of path drawings that Python passes on in a dict.
PathDrawingOptions to_drawing_options(const pybind11::dict& given);

void bind_toolpath(pybind11::module_& m);
void bind_tools(pybind11::module_& m);
void bind_program(pybind11::module_& m);
void bind_job(pybind11::module_& m);
void bind_operations(pybind11::module_& m);
void bind_burn(pybind11::module_& m);
void bind_configuration(pybind11::module_& m);
void bind_drop_in(pybind11::module_& m);
void bind_live(pybind11::module_& m);
void bind_scad(pybind11::module_& m);
void bind_outputs(pybind11::module_& m);
void bind_printer(pybind11::module_& m);
void bind_simulation(pybind11::module_& m);
void bind_print(pybind11::module_& m);
void bind_bodies(pybind11::module_& m);
void bind_region(pybind11::module_& m);
void bind_drawing(pybind11::module_& m);
void bind_drawing_writer(pybind11::module_& m);
void bind_machine(pybind11::module_& m);

}  // namespace kerf::python

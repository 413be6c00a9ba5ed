// What the parts of the binding share: diagnostics as exceptions, points from Python, the script's own line.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>

#include "kerf/diagnostics.h"
#include "kerf/geometry.h"
#include "kerf/limits.h"
#include "kerf/progress.h"

namespace kerf::python {

/// Raises kerf.Error with the list where it holds errors; passes warnings to Python's warnings module else.
void raise_or_warn(const Diagnostics& diagnostics);
/// As raise_or_warn, but OSError where a file could not be written.
void raise_os_error_or_warn(const Diagnostics& diagnostics);
/// A list of kerf.Diagnostic.
pybind11::list to_list(const Diagnostics& diagnostics);

/// A point from any sequence of three numbers; raises ValueError naming the argument where it is not, or not
/// finite.
Point3 to_point3(const pybind11::handle& value, const char* argument);
Point2 to_point2(const pybind11::handle& value, const char* argument);
pybind11::tuple to_tuple(Point3 p);
/// A finite number; raises ValueError naming the argument.
double finite_number(double value, const char* argument);

/// A number from `low` to `high`; raises ValueError that names the argument and its unit.
double number_within(double value, double low, double high, const char* argument, const char* unit);
int whole_within(long long value, long long low, long long high, const char* argument);

/// Lets copy.copy and copy.deepcopy make a copy of a value.
template <class Value>
void bind_copy(pybind11::class_<Value>& c) {
  c.def("__copy__", [](const Value& value) { return Value(value); });
  c.def(
      "__deepcopy__", [](const Value& value, const pybind11::dict&) { return Value(value); },
      pybind11::arg("memo"));
}

/// Text for Python; bytes that are no UTF-8 (an old file's comment) become the replacement character.
pybind11::str to_str(std::string_view text);

/// Where in the user's script the call that is running stands.
CallSpot script_location(const char* call);

/// Lets Ctrl-C stop long work: asks Python for signals now and then. Made and used with the GIL held by the
/// caller's thread; `check` re-raises what the signal handler raised.
class SignalProgress final : public Progress {
 public:
  void phase(std::string_view) override {}
  void report(double) override {}
  bool stop_requested() override;
  void rethrow() const;

 private:
  bool stopped_ = false;
};

void bind_toolpath(pybind11::module_& m);
void bind_tools(pybind11::module_& m);
void bind_program(pybind11::module_& m);
void bind_job(pybind11::module_& m);
void bind_outputs(pybind11::module_& m);
void bind_simulation(pybind11::module_& m);
void bind_print(pybind11::module_& m);
void bind_bodies(pybind11::module_& m);
void bind_region(pybind11::module_& m);
void bind_drawing(pybind11::module_& m);

}  // namespace kerf::python

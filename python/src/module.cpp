// The compiled module kerf._kerf: diagnostics, conversion of arguments, and the list of bindings.
#include <cmath>

#include "bind_joints.h"
#include "bindings.h"

#include "kerf/number.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

PyObject* error_type =
    nullptr;  // kerf.Error; never released, so that no destructor runs after the interpreter's end

py::list origins_of(const Diagnostic& d) {
  py::list notes;
  for (const DiagnosticNote& note : d.notes)
    notes.append(py::make_tuple(to_str(to_string(note.where)), to_str(note.text)));
  return notes;
}

void bind_diagnostics(py::module_& m) {
  py::class_<Diagnostic>(m, "Diagnostic", R"(An error, a warning or a note about the input.

Diagnostics are made by Kerf; see `kerf.Error.diagnostics`.)")
      .def_property_readonly(
          "severity", [](const Diagnostic& d) { return std::string(to_string(d.severity)); },
          "str: 'error', 'warning' or 'note'.")
      .def_property_readonly(
          "code", [](const Diagnostic& d) { return static_cast<int>(d.code); },
          "int: stable number of the kind of diagnostic.")
      .def_property_readonly(
          "name", [](const Diagnostic& d) { return std::string(name_of(d.code)); },
          "str: stable name of the code, e.g. 'no_feed'.")
      .def_property_readonly(
          "where", [](const Diagnostic& d) { return to_str(to_string(d.where)); },
          "str: file, line and column; or file, layer, handle and coordinates in a drawing.")
      .def_property_readonly(
          "line",
          [](const Diagnostic& d) -> py::object {
            if (const auto* text = std::get_if<TextLocation>(&d.where)) return py::int_(text->line);
            if (const auto* call = std::get_if<CallLocation>(&d.where)) return py::int_(call->line);
            return py::none();
          },
          "int or None: line in the file or script.")
      .def_property_readonly(
          "message", [](const Diagnostic& d) { return to_str(d.message); },
          "str: the error, and what was expected.")
      .def_property_readonly(
          "hint", [](const Diagnostic& d) { return to_str(d.hint); }, "str: the remedy; may be empty.")
      .def_property_readonly("notes", &origins_of, "list of (str, str): further locations and texts.")
      .def("__repr__", [](const Diagnostic& d) { return to_str("<kerf.Diagnostic " + to_string(d) + ">"); })
      .def("__str__", [](const Diagnostic& d) { return to_str(to_string(d)); });
}

}  // namespace

py::list to_list(const Diagnostics& diagnostics) {
  py::list list;
  for (const Diagnostic& d : diagnostics.list()) list.append(py::cast(d));
  return list;
}

void raise_or_warn(const Diagnostics& diagnostics) {
  if (!diagnostics.has_errors()) {
    for (const Diagnostic& d : diagnostics.list())
      if (d.severity == Severity::warning &&
          PyErr_WarnEx(PyExc_UserWarning, py::cast<std::string>(to_str(to_string(d))).c_str(), 2) != 0)
        throw py::error_already_set();
    return;
  }
  std::string text;
  for (const Diagnostic& d : diagnostics.list())
    if (d.severity == Severity::error) text += (text.empty() ? "" : "\n") + to_string(d);
  py::object error = py::handle(error_type)(to_str(text));
  error.attr("diagnostics") = to_list(diagnostics);
  PyErr_SetObject(error_type, error.ptr());
  throw py::error_already_set();
}

void raise_os_error_or_warn(const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics.list()) {
    if (d.code != Code::file_unwritable) continue;
    PyErr_SetString(PyExc_OSError, py::cast<std::string>(to_str(to_string(d))).c_str());
    throw py::error_already_set();
  }
  raise_or_warn(diagnostics);
}

double finite_number(double value, const char* argument) {
  if (!std::isfinite(value)) throw py::value_error(std::string(argument) + " must be a finite number");
  return value;
}

namespace {

std::string outside(const char* argument, double low, double high, const char* unit) {
  return std::string(argument) + " must be from " + number_text(low, 3) + " to " + number_text(high, 3) +
         (*unit == 0 ? "" : " ") + unit;
}

}  // namespace

double number_within(double value, double low, double high, const char* argument, const char* unit) {
  if (value >= low && value <= high) return value;
  throw py::value_error(outside(argument, low, high, unit));
}

int whole_within(long long value, long long low, long long high, const char* argument) {
  if (value < low || value > high)
    throw py::value_error(outside(argument, static_cast<double>(low), static_cast<double>(high), ""));
  return static_cast<int>(value);
}

namespace {

void read_numbers(const py::handle& value, const char* argument, double* out, std::size_t count) {
  const std::string expected =
      std::string(argument) + " must be " + std::to_string(count) + " finite numbers";
  if (!py::isinstance<py::sequence>(value) || py::isinstance<py::str>(value)) throw py::type_error(expected);
  const auto sequence = py::reinterpret_borrow<py::sequence>(value);
  if (sequence.size() != count) throw py::value_error(expected + ", not " + std::to_string(sequence.size()));
  for (std::size_t i = 0; i < count; ++i) {
    const py::object item = sequence[i];
    out[i] = PyFloat_AsDouble(item.ptr());
    if (PyErr_Occurred() != nullptr) {
      PyErr_Clear();
      throw py::type_error(expected);
    }
    if (!std::isfinite(out[i])) throw py::value_error(expected);
    number_within(out[i], -limits::kMaxCoordinate, limits::kMaxCoordinate, argument, "mm");
  }
}

}  // namespace

Point3 to_point3(const py::handle& value, const char* argument) {
  double v[3];
  read_numbers(value, argument, v, 3);
  return {v[0], v[1], v[2]};
}

Point2 to_point2(const py::handle& value, const char* argument) {
  double v[2];
  read_numbers(value, argument, v, 2);
  return {v[0], v[1]};
}

py::str to_str(std::string_view text) {
  PyObject* decoded = PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "replace");
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

py::tuple to_tuple(Point3 p) { return py::make_tuple(p.x, p.y, p.z); }

namespace {

PyObject* library_files = nullptr;  // set of str; never released, as error_type

/// The file name of the code that a frame runs.
py::object file_of(PyFrameObject* frame) {
  const auto code = py::reinterpret_steal<py::object>(reinterpret_cast<PyObject*>(PyFrame_GetCode(frame)));
  return code.attr("co_filename");
}

}  // namespace

CallLocation script_location(const char* call) {
  CallLocation location;
  location.call = call;
  PyFrameObject* innermost = PyEval_GetFrame();  // borrowed
  if (innermost == nullptr) return location;
  Py_INCREF(innermost);
  auto frame = py::reinterpret_steal<py::object>(reinterpret_cast<PyObject*>(innermost));
  py::object file = file_of(innermost);
  while (PySet_Contains(library_files, file.ptr()) == 1) {
    PyFrameObject* caller = PyFrame_GetBack(reinterpret_cast<PyFrameObject*>(frame.ptr()));
    if (caller == nullptr) break;
    frame = py::reinterpret_steal<py::object>(reinterpret_cast<PyObject*>(caller));
    file = file_of(caller);
  }
  location.line =
      static_cast<std::uint32_t>(PyFrame_GetLineNumber(reinterpret_cast<PyFrameObject*>(frame.ptr())));
  location.file = py::cast<std::string>(file);
  return location;
}

bool SignalProgress::stop_requested() {
  if (stopped_) return true;
  const py::gil_scoped_acquire gil;
  stopped_ = PyErr_CheckSignals() != 0;
  return stopped_;
}

void SignalProgress::rethrow() const {
  if (stopped_) throw py::error_already_set();
}

}  // namespace kerf::python

PYBIND11_MODULE(_kerf, m) {
  using namespace kerf::python;
  m.doc() = "Kerf's compiled core; import the package `kerf` instead.";
  m.attr("__version__") = KERF_VERSION;
  error_type = PyErr_NewExceptionWithDoc(
      "kerf.Error",
      "The input is invalid. `diagnostics` is the list of kerf.Diagnostic, errors and warnings.",
      PyExc_ValueError, nullptr);
  if (error_type == nullptr) throw pybind11::error_already_set();
  m.add_object("Error", error_type);
  library_files = PySet_New(nullptr);
  if (library_files == nullptr) throw pybind11::error_already_set();
  m.def(
      "_library_file",
      [](const pybind11::str& file) {
        if (PySet_Add(library_files, file.ptr()) != 0) throw pybind11::error_already_set();
      },
      pybind11::arg("file"),
      "Calls from this file of Python code are reported with the location of its own caller.");
  bind_diagnostics(m);
  bind_tools(m);
  bind_program(m);
  bind_toolpath(m);
  bind_job(m);
  bind_operations(m);
  bind_outputs(m);
  bind_simulation(m);
  bind_print(m);
  bind_printer(m);
  bind_bodies(m);
  bind_region(m);
  bind_joints(m);
  bind_drawing(m);
  bind_drawing_writer(m);
}

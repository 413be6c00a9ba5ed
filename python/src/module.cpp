// The compiled module kerf._kerf: diagnostics, conversion of arguments, and the list of bindings.
#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "base/codes/files.h"
#include "base/number.h"
#include "bind_joints.h"
#include "bindings.h"
#include "values.h"

#include "kerf/base/limits.h"

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

// A diagnostic as a tuple for pickling; names of files are bytes, they need not be UTF-8.

py::tuple state_of(const Origin& where) {
  if (const auto* text = std::get_if<TextLocation>(&where))
    return py::make_tuple("text", py::bytes(text->file), text->line, text->column);
  if (const auto* drawing = std::get_if<DrawingLocation>(&where))
    return py::make_tuple("drawing", py::bytes(drawing->file), py::bytes(drawing->layer),
                          py::bytes(drawing->handle), drawing->x, drawing->y, py::bytes(drawing->entity));
  if (const auto* call = std::get_if<CallLocation>(&where))
    return py::make_tuple("call", py::bytes(call->file), call->line, py::bytes(call->call));
  return py::tuple();
}

Origin origin_of_state(const py::tuple& state) {
  if (state.empty()) return {};
  const auto kind = py::cast<std::string>(state[0]);
  const auto text = [&](std::size_t i) { return py::cast<std::string>(state[i]); };
  const auto whole = [&](std::size_t i) { return py::cast<std::uint32_t>(state[i]); };
  if (kind == "text") return TextLocation{text(1), whole(2), whole(3)};
  if (kind == "call") return CallLocation{text(1), whole(2), text(3)};
  return DrawingLocation{text(1), text(2), text(3), py::cast<double>(state[4]), py::cast<double>(state[5]),
                         text(6)};
}

py::tuple state_of_diagnostic(const Diagnostic& d) {
  py::list notes;
  for (const DiagnosticNote& note : d.notes)
    notes.append(py::make_tuple(state_of(note.where), py::bytes(note.text)));
  return py::make_tuple(static_cast<int>(d.severity), static_cast<int>(d.code), state_of(d.where),
                        py::bytes(d.message), py::tuple(notes), py::bytes(d.hint));
}

Diagnostic diagnostic_of_state(const py::tuple& state) {
  Diagnostic d{static_cast<Severity>(py::cast<int>(state[0])),
               static_cast<Code>(py::cast<int>(state[1])),
               origin_of_state(state[2]),
               py::cast<std::string>(state[3]),
               {},
               py::cast<std::string>(state[5])};
  for (const py::handle note : py::cast<py::tuple>(state[4]))
    d.notes.push_back({origin_of_state(note[py::int_(0)]), py::cast<std::string>(note[py::int_(1)])});
  return d;
}

void bind_diagnostics(py::module_& m) {
  py::class_<Diagnostic> c(m, "Diagnostic", R"(An error, a warning or a note about the input.

Diagnostics are made by Kerf; see `kerf.Error.diagnostics`.

Examples
--------
>>> try:
...     kerf.Tool("square d=-3")
... except kerf.Error as error:
...     first = error.diagnostics[0]
>>> first.severity
'error')");
  bind_copy(c);
  c.def(
       "__eq__",
       [](const Diagnostic& a, const Diagnostic& b) {
         return state_of_diagnostic(a).equal(state_of_diagnostic(b));
       },
       py::is_operator())
      .def("__hash__", [](const Diagnostic& d) { return py::hash(state_of_diagnostic(d)); })
      .def(py::pickle(&state_of_diagnostic, &diagnostic_of_state))
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

namespace {

PyObject* library_files = nullptr;  // set of str; never released, as error_type

/// The file name of the code that a frame runs.
py::object file_of(PyFrameObject* frame) {
  const auto code = py::reinterpret_steal<py::object>(reinterpret_cast<PyObject*>(PyFrame_GetCode(frame)));
  return code.attr("co_filename");
}

/// Calls `visit(frame)` for the running code and its callers, until it returns false.
template <class Visit>
void walk_frames(Visit visit) {
  PyFrameObject* innermost = PyEval_GetFrame();  // borrowed
  if (innermost == nullptr) return;
  Py_INCREF(innermost);
  auto frame = py::reinterpret_steal<py::object>(reinterpret_cast<PyObject*>(innermost));
  while (visit(reinterpret_cast<PyFrameObject*>(frame.ptr()))) {
    PyFrameObject* caller = PyFrame_GetBack(reinterpret_cast<PyFrameObject*>(frame.ptr()));
    if (caller == nullptr) return;
    frame = py::reinterpret_steal<py::object>(reinterpret_cast<PyObject*>(caller));
  }
}

bool is_library(PyFrameObject* frame) { return PySet_Contains(library_files, file_of(frame).ptr()) == 1; }

/// The level of a warning that names the line of the user's script.
py::ssize_t levels_to_script() {
  py::ssize_t levels = 0;
  walk_frames([&](PyFrameObject* frame) {
    ++levels;
    return is_library(frame);
  });
  return std::max<py::ssize_t>(levels, 1);
}

}  // namespace

bool is_library_code(PyObject* code) {
  const auto file = py::reinterpret_steal<py::object>(PyObject_GetAttrString(code, "co_filename"));
  if (!file) throw py::error_already_set();
  return PySet_Contains(library_files, file.ptr()) == 1;
}

void warn_script(const std::string& text) {
  if (PyErr_WarnEx(PyExc_UserWarning, py::cast<std::string>(to_str(text)).c_str(), levels_to_script()) != 0)
    throw py::error_already_set();
}

namespace {

/// Of the option of a command, the argument of the same name; nothing if the location is another one.
std::optional<std::string> argument_of(const Origin& where) {
  const auto* call = std::get_if<CallLocation>(&where);
  if (call == nullptr || !call->file.empty() || !call->call.starts_with("--")) return std::nullopt;
  std::string name = call->call.substr(2);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

/// Messages about an option of the command name the argument, and the line of the script.
Diagnostics of_arguments(const Diagnostics& found) {
  Diagnostics renamed;
  for (Diagnostic d : found.list()) {
    if (const auto name = argument_of(d.where)) {
      d.message = *name + ": " + d.message;
      d.where = script_location(name->c_str());
      if (d.hint.find("--") != std::string::npos) d.hint.clear();
    }
    renamed.add(d);
  }
  return renamed;
}

}  // namespace

void raise_or_warn(const Diagnostics& found) {
  const auto& list = found.list();
  if (std::any_of(list.begin(), list.end(),
                  [](const Diagnostic& d) { return argument_of(d.where).has_value(); }))
    return raise_or_warn(of_arguments(found));
  const Diagnostics& diagnostics = found;
  if (!diagnostics.has_errors()) {
    for (const Diagnostic& d : diagnostics.list())
      if (d.severity == Severity::warning) warn_script(to_string(d));
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
    if (d.code != codes::file_unwritable && d.code != codes::file_unreadable) continue;
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

CallLocation script_location(const char* call) {
  CallLocation location;
  location.call = call;
  walk_frames([&](PyFrameObject* frame) {
    location.line = static_cast<std::uint32_t>(PyFrame_GetLineNumber(frame));
    if (is_library(frame)) return true;
    location.file = py::cast<std::string>(file_of(frame));
    return false;
  });
  return location;
}

namespace {

constexpr std::chrono::milliseconds kBetweenCalls{100};  // of the handler of progress

PyObject* progress_handler = nullptr;  // context variable; never released, as error_type

}  // namespace

SignalProgress::SignalProgress() {
  if (PyContextVar_Get(progress_handler, nullptr, &handler_) != 0) throw py::error_already_set();
  if (handler_ == Py_None) Py_CLEAR(handler_);
}

SignalProgress::~SignalProgress() {
  for (PyObject* held : {handler_, type_, value_, traceback_}) Py_XDECREF(held);
}

void SignalProgress::phase(std::string_view what) {
  if (handler_ == nullptr) return;
  phase_ = what;
  call(0.0);
}

void SignalProgress::report(double fraction) {
  if (handler_ != nullptr && (fraction >= 1.0 || std::chrono::steady_clock::now() >= next_call_))
    call(fraction);
}

/// An exception of the handler stops the work.
void SignalProgress::call(double fraction) {
  if (stopped_) return;
  const py::gil_scoped_acquire gil;
  PyObject* result = PyObject_CallFunction(handler_, "sd", phase_.c_str(), fraction);
  if (result == nullptr) keep_error();
  Py_XDECREF(result);
  next_call_ = std::chrono::steady_clock::now() + kBetweenCalls;
}

bool SignalProgress::stop_requested() {
  if (stopped_) return true;
  const py::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() != 0) keep_error();
  return stopped_;
}

void SignalProgress::keep_error() {
  stopped_ = true;
  PyErr_Fetch(&type_, &value_, &traceback_);
}

void SignalProgress::rethrow() {
  if (!stopped_ && handler_ != nullptr && !phase_.empty()) call(1.0);
  if (!stopped_) return;
  PyErr_Restore(std::exchange(type_, nullptr), std::exchange(value_, nullptr),
                std::exchange(traceback_, nullptr));
  throw py::error_already_set();
}

}  // namespace kerf::python

PYBIND11_MODULE(_kerf, m) {
  using namespace kerf::python;
  m.doc() = "Kerf's compiled core; import the package `kerf` instead.";
  m.attr("__version__") = KERF_VERSION;
  error_type = PyErr_NewExceptionWithDoc("kerf.Error",
                                         R"(The input is invalid; `diagnostics` lists the errors and warnings.

Parameters
----------
message : str
    What is wrong.

Examples
--------
>>> try:
...     kerf.Tool("square d=-3")
... except kerf.Error as error:
...     names = [diagnostic.name for diagnostic in error.diagnostics])",
                                         PyExc_ValueError, nullptr);
  if (error_type == nullptr) throw pybind11::error_already_set();
  m.add_object("Error", error_type);
  library_files = PySet_New(nullptr);
  if (library_files == nullptr) throw pybind11::error_already_set();
  // Values of a wrong type inside of others: sequences, dicts.
  pybind11::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const pybind11::cast_error& error) {
      PyErr_SetString(PyExc_TypeError, error.what());
    }
  });
  progress_handler = PyContextVar_New("kerf_progress", Py_None);
  if (progress_handler == nullptr) throw pybind11::error_already_set();
  m.attr("_progress") = pybind11::reinterpret_borrow<pybind11::object>(progress_handler);
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
  bind_burn(m);
  bind_configuration(m);
  bind_drop_in(m);
  bind_scad(m);
  bind_live(m);
  bind_region(m);
  bind_joints(m);
  bind_plane_shapes(m);
  bind_drawing(m);
  bind_drawing_writer(m);
  bind_machine(m);
}

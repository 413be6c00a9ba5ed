// A call of a command from a script: arguments, location, errors as exceptions, warnings.
#include <algorithm>
#include <memory>
#include <new>

#include "base/codes/files.h"
#include "base/names.h"
#include "base/number.h"
#include "machine_binding.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

PyObject* machine_error = nullptr;  // gcodepreview.GcodePreviewError; never released

/// The exception of a function of the script that a command has called; null: none.
PyObject* callback_error[3] = {};

/// The arguments of a call, a few of them without memory of the heap.
class Arguments {
 public:
  explicit Arguments(std::size_t count) : count_(count) {
    if (count > kFew) {
      many_.resize(count, design::Value::unset());
      values_ = many_.data();
      return;
    }
    values_ = reinterpret_cast<design::Value*>(few_);
    for (std::size_t i = 0; i < count; ++i) new (values_ + i) design::Value(design::Value::unset());
  }
  ~Arguments() {
    if (many_.empty()) std::destroy_n(values_, count_);
  }
  Arguments(const Arguments&) = delete;
  Arguments& operator=(const Arguments&) = delete;
  design::Value& operator[](std::size_t i) { return values_[i]; }
  std::span<const design::Value> all() const { return {values_, count_}; }

 private:
  static constexpr std::size_t kFew = 14;  // the parameters of most commands
  alignas(design::Value) std::byte few_[kFew * sizeof(design::Value)];
  std::vector<design::Value> many_;
  design::Value* values_ = nullptr;
  std::size_t count_;
};

/// A message of the machine that waits for the end of the command.
struct Message {
  bool error = false;
  design::Problem problem = design::Problem::value;
  std::string text;
};

class ScriptSite final : public design::CallSite {
 public:
  ScriptSite(PyMachine& object, const design::Command& command) : object_(object), command_(command) {}
  Origin where() const override { return script_location(std::string(command_.name).c_str()); }
  OriginId origin(OriginTable&) override {
    return object_.locations.origin(object_.machine.shared_path(), command_);
  }
  void error(design::Problem problem, std::string message) override {
    messages.push_back({true, problem, std::move(message)});
  }
  void warning(std::string message) override {
    messages.push_back({false, design::Problem::value, std::move(message)});
  }
  Diagnostics& diagnostics() override {
    if (!found) found = std::make_unique<Diagnostics>();
    return *found;
  }
  void print(std::string_view line) override { py::print(to_str(line)); }
  std::string shown(const design::Value& value) const override { return shown_value(value, true); }
  std::string as_text(const design::Value& value) const override { return shown_value(value, false); }
  std::optional<std::vector<Outline>> children() override { return std::nullopt; }
  std::optional<double> variable(std::string_view) const override { return std::nullopt; }

  std::vector<Message> messages;
  std::unique_ptr<Diagnostics> found;  // of the library's functions

 private:
  static std::string shown_value(const design::Value& value, bool quoted);
  PyMachine& object_;
  const design::Command& command_;
};

std::string ScriptSite::shown_value(const design::Value& value, bool quoted) {
  switch (value.type()) {
    case design::Type::unset:
    case design::Type::undefined: return "None";
    case design::Type::truth: return value.truth() ? "True" : "False";
    case design::Type::number: return exact_text(value.number());
    case design::Type::text: return quoted ? "'" + value.text() + "'" : value.text();
    case design::Type::list: return quoted ? "a list" : design::text_of(value);
    case design::Type::surface: return "a function";
    default: return design::text_of(value);
  }
}

// ------------------------------------------------------------------------------------- arguments of a call

std::string plural(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

[[noreturn]] void wrong_call(const design::Command& command, const std::string& text) {
  throw py::type_error(std::string(command.name) + "() " + text);
}

std::size_t parameter_named(const design::Command& command, PyObject* name) {
  const std::string given = py::cast<std::string>(py::handle(name));
  for (std::size_t i = 0; i < command.parameters.size(); ++i)
    if (command.parameters[i].name == given) return i;
  std::string known;
  for (const design::Parameter& p : command.parameters)
    known += (known.empty() ? "" : ", ") + std::string(p.name);
  wrong_call(command, "got an unexpected keyword argument '" + given + "'; known: " + known);
}

std::string hint_of_forms(const design::Command& command) {
  return command.numbers_without_tool ? "; the forms are " + design::forms_of(command) : std::string();
}

/// The parameter of the first positional argument.
std::size_t first_parameter(const design::Command& command, PyObject* const* args, std::size_t count,
                            PyObject* names) {
  if (!command.numbers_without_tool) return 0;
  std::size_t numbers = 0;
  while (numbers < count && to_value(args[numbers]).is(design::Type::number)) ++numbers;
  std::vector<std::string_view> given;
  for (Py_ssize_t k = 0; names != nullptr && k < PyTuple_GET_SIZE(names); ++k)
    if (const char* name = PyUnicode_AsUTF8(PyTuple_GET_ITEM(names, k))) given.emplace_back(name);
  return design::first_parameter(command, numbers, given);
}

void take_arguments(const design::Command& command, Arguments& values, PyObject* const* args,
                    std::size_t count, PyObject* names, std::size_t first) {
  const std::size_t parameters = command.parameters.size();
  const Py_ssize_t named = names == nullptr ? 0 : PyTuple_GET_SIZE(names);
  if (first + count > parameters && command.further == design::Further::refused)
    wrong_call(command, "takes at most " + plural(parameters, "argument") + " (" + std::to_string(count) +
                            " given)" + hint_of_forms(command));
  for (std::size_t i = 0; i < count; ++i) values[first + i] = to_value(args[i]);
  for (Py_ssize_t k = 0; k < named; ++k) {
    const std::size_t i = parameter_named(command, PyTuple_GET_ITEM(names, k));
    if (!values.all()[i].is(design::Type::unset))
      wrong_call(command,
                 "got multiple values for argument '" + std::string(command.parameters[i].name) + "'");
    values[i] = to_value(args[count + static_cast<std::size_t>(k)]);
  }
  for (std::size_t i = 0; i < parameters; ++i)
    if (!command.may_leave_out(i) && values.all()[i].is(design::Type::unset))
      wrong_call(command, "missing the argument '" + std::string(command.parameters[i].name) + "'" +
                              hint_of_forms(command));
}

// -------------------------------------------------------------------------------------- messages of a call

void raise_callback_error() {
  if (callback_error[0] == nullptr) return;
  PyErr_Restore(std::exchange(callback_error[0], nullptr), std::exchange(callback_error[1], nullptr),
                std::exchange(callback_error[2], nullptr));
  throw py::error_already_set();
}

PyObject* exception_of(const std::vector<Message>& messages) {
  const auto first = std::find_if(messages.begin(), messages.end(), [](const Message& m) { return m.error; });
  return first != messages.end() && first->problem == design::Problem::type ? PyExc_TypeError : machine_error;
}

/// Raises the errors of the command as one exception.
void raise_errors(const ScriptSite& site) {
  std::string text;
  const auto add = [&](const std::string& message) { text += (text.empty() ? "" : "\n") + message; };
  for (const Message& message : site.messages)
    if (message.error) add(message.text);
  if (site.found) {
    for (const Diagnostic& d : site.found->list())
      if (d.severity == Severity::error) add(d.message);
    if (site.found->has_errors()) {
      const auto& list = site.found->list();
      const bool of_files = std::any_of(list.begin(), list.end(), [](const Diagnostic& d) {
        return d.code == codes::file_unreadable || d.code == codes::file_unwritable;
      });
      if (of_files) raise_os_error_or_warn(*site.found);
    }
  }
  if (text.empty()) return;
  PyErr_SetObject(exception_of(site.messages), to_str(text).ptr());
  throw py::error_already_set();
}

void issue_warnings(const ScriptSite& site) {
  for (const Message& message : site.messages)
    if (!message.error) warn_script(message.text);
  if (!site.found) return;
  for (const Diagnostic& d : site.found->list())
    if (d.severity == Severity::warning) warn_script(to_string(d));
}

void report(PyMachine& object, const ScriptSite& site) {
  object.progress.finish();
  raise_callback_error();
  if (site.messages.empty() && !site.found) return;
  issue_warnings(site);
  raise_errors(site);
}

/// The object of the running command, for callbacks of its services.
class Running {
 public:
  Running(PyMachine& object, PyObject* self) : object_(object), before_(object.self) { object.self = self; }
  ~Running() { object_.self = before_; }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

 private:
  PyMachine& object_;
  py::handle before_;
};

PyObject* called(const design::Command& command, PyMachine& object, PyObject* self, PyObject* const* args,
                 Py_ssize_t count, PyObject* names) {
  const std::size_t given = static_cast<std::size_t>(count);
  const std::size_t offset = first_parameter(command, args, given, names);
  Arguments values(std::max(offset + given, command.parameters.size()));
  take_arguments(command, values, args, given, names, offset);
  const Running running(object, self);
  ScriptSite site(object, command);
  design::Call call(command, site, values.all());
  design::Machine& machine = object.machine;
  const std::size_t first = machine.path().size();
  const Point3 from = machine.start_of_moves();
  const int tool = machine.tool().number;
  const design::Value result = design::run(machine, call);
  report(object, site);
  if (machine.has_outputs()) object.write_outputs();
  switch (command.gives) {
    case design::Gives::motions: return moves_of(machine.path(), first, from, tool).release().ptr();
    case design::Gives::value: return to_object(result).release().ptr();
    case design::Gives::nothing: break;
  }
  Py_RETURN_NONE;
}

}  // namespace

namespace {

/// Exceptions of C++ as those of Python.
template <class Work>
PyObject* guarded(Work work) {
  try {
    return work();
  } catch (py::error_already_set& error) {
    error.restore();
  } catch (const py::builtin_exception& error) {
    error.set_error();
  } catch (const std::bad_alloc&) {
    PyErr_NoMemory();
  }
  return nullptr;
}

}  // namespace

PyObject* call_command(const design::Command& command, PyMachine& object, PyObject* self,
                       PyObject* const* args, Py_ssize_t count, PyObject* names) {
  return guarded([&] { return called(command, object, self, args, count, names); });
}

PyObject* call_command(const design::Command& command, PyObject* self, PyObject* const* args,
                       Py_ssize_t count, PyObject* names, PyMachine& (*find)(PyObject*)) {
  return guarded([&] { return called(command, find(self), self, args, count, names); });
}

void raise_machine_error(const std::string& text) {
  PyErr_SetObject(machine_error, to_str(text).ptr());
  throw py::error_already_set();
}

void keep_error_of_callback() {
  if (callback_error[0] != nullptr) {
    PyErr_Clear();
    return;
  }
  PyErr_Fetch(&callback_error[0], &callback_error[1], &callback_error[2]);
}

void add_machine_error(py::module_& m) {
  machine_error = PyErr_NewExceptionWithDoc("gcodepreview.GcodePreviewError",
                                            "A call with a wrong value, or at a time when it is impossible; "
                                            "the message names the argument or the call.",
                                            PyExc_ValueError, nullptr);
  if (machine_error == nullptr) throw py::error_already_set();
  m.add_object("GcodePreviewError", machine_error);
}

// ------------------------------------------------------------------------------------------ locations,
// progress

OriginId ScriptLocations::origin(const std::shared_ptr<Toolpath>& path, const design::Command& command) {
  if (path_ != path) {
    clear();
    path_ = path;
  }
  PyFrameObject* frame = PyEval_GetFrame();  // borrowed
  if (frame == nullptr) return path->origins().add(script_location(std::string(command.name).c_str()));
  auto* code = reinterpret_cast<PyObject*>(PyFrame_GetCode(frame));
#if PY_VERSION_HEX >= 0x030B0000
  const int at = PyFrame_GetLasti(frame);
#else
  const int at = PyFrame_GetLineNumber(frame);
#endif
  const std::size_t key = reinterpret_cast<std::uintptr_t>(code) / 16 + static_cast<std::size_t>(at) / 2;
  Entry& entry = entries_[key % kEntries];
  if (entry.code == code && entry.at == at && entry.command == &command) {
    Py_DECREF(code);
    return entry.origin;
  }
  const OriginId origin = path->origins().add(script_location(std::string(command.name).c_str()));
  if (is_library_code(code)) {  // the location is that of its caller
    Py_DECREF(code);
    return origin;
  }
  Py_XDECREF(entry.code);
  entry = {code, at, &command, origin};
  return origin;
}

void ScriptLocations::clear() {
  for (Entry& entry : entries_) {
    Py_XDECREF(entry.code);
    entry = {};
  }
}

SignalProgress& CallProgress::signals() {
  if (!signals_) {
    const py::gil_scoped_acquire gil;
    signals_.emplace();
  }
  return *signals_;
}

void CallProgress::finish() {
  if (!signals_) return;
  struct Forget {
    std::optional<SignalProgress>& signals;
    ~Forget() { signals.reset(); }
  } const forget{signals_};
  signals_->rethrow();
}

}  // namespace kerf::python

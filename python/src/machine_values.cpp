// Values of Python as values of commands, and back; moves of steps.
#include <cmath>

#include "base/number.h"
#include "machine_binding.h"
#include "region_binding.h"

#include "kerf/base/limits.h"
#include "kerf/geom/shapes.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr int kMaxDepth = 8;  // of lists in lists: a list may hold itself

/// A function of the script, or an object that is called as one.
class ScriptSurface final : public design::Surface {
 public:
  explicit ScriptSurface(PyObject* function) : function_(function) {}
  double height(Point2 at) const override {
    PyObject* result = PyObject_CallFunction(function_, "dd", at.x, at.y);
    if (result == nullptr) {
      keep_error_of_callback();
      return std::nan("");
    }
    const double z = PyFloat_AsDouble(result);
    Py_DECREF(result);
    if (z != -1.0 || PyErr_Occurred() == nullptr) return z;
    PyErr_Clear();
    return std::nan("");
  }

 private:
  PyObject* function_;  // an argument of the running call
};

class ShapedSurface final : public design::Surface {
 public:
  explicit ShapedSurface(const BezierSurface& surface) : surface_(surface) {}
  double height(Point2 at) const override { return surface_.at(at); }

 private:
  BezierSurface surface_;
};

design::Value list_value(PyObject* object, int depth) {
  if (depth >= kMaxDepth) return design::Other{"a list of lists that has no end"};
  PyObject* items = PySequence_Fast(object, "");
  if (items == nullptr) {
    PyErr_Clear();
    return design::Other{Py_TYPE(object)->tp_name};
  }
  design::Value::List list;
  const Py_ssize_t count = PySequence_Fast_GET_SIZE(items);
  list.reserve(static_cast<std::size_t>(count));
  for (Py_ssize_t i = 0; i < count; ++i)
    list.push_back(to_value(PySequence_Fast_GET_ITEM(items, i), depth + 1));
  Py_DECREF(items);
  return list;
}

design::Value text_value(PyObject* object) {
  Py_ssize_t size = 0;
  const char* text = PyUnicode_AsUTF8AndSize(object, &size);
  if (text != nullptr) return std::string(text, static_cast<std::size_t>(size));
  PyErr_Clear();  // half of a surrogate pair
  return design::Other{"a text that is not Unicode"};
}

/// The text of an object that no command takes.
design::Value other_value(PyObject* object) {
  PyObject* text = PyObject_Str(object);
  Py_ssize_t size = 0;
  const char* bytes = text == nullptr ? nullptr : PyUnicode_AsUTF8AndSize(text, &size);
  design::Other other{bytes == nullptr ? std::string(Py_TYPE(object)->tp_name)
                                       : std::string(bytes, static_cast<std::size_t>(size))};
  Py_XDECREF(text);
  PyErr_Clear();
  return other;
}

/// Numbers of other types: those of numpy, fractions.
std::optional<double> other_number(PyObject* object) {
  const PyNumberMethods* methods = Py_TYPE(object)->tp_as_number;
  if (methods == nullptr || (methods->nb_float == nullptr && methods->nb_index == nullptr))
    return std::nullopt;
  const double value = PyFloat_AsDouble(object);
  if (value != -1.0 || PyErr_Occurred() == nullptr) return value;
  const bool too_large = PyErr_ExceptionMatches(PyExc_OverflowError) != 0;
  PyErr_Clear();
  return too_large ? std::optional(HUGE_VAL) : std::nullopt;
}

/// Objects that are less usual as arguments than numbers, texts and lists.
design::Value special_value(PyObject* object, int depth) {
  const py::handle handle(object);
  if (py::isinstance<PyRegion>(handle))
    return design::Outlines{py::cast<const PyRegion&>(handle).region.loops, false};
  if (py::isinstance<BezierSurface>(handle))
    return std::shared_ptr<const design::Surface>(
        std::make_shared<ShapedSurface>(py::cast<const BezierSurface&>(handle)));
  if (py::hasattr(handle, "__fspath__")) {
    PyObject* path = PyOS_FSPath(object);
    design::Value value = path == nullptr ? design::Value(design::Other{"a path"}) : to_value(path, depth);
    Py_XDECREF(path);
    PyErr_Clear();
    return value;
  }
  if (PyBytes_Check(object) || PyByteArray_Check(object)) return other_value(object);
  const bool is_sequence = PySequence_Check(object) != 0 && PySequence_Size(object) >= 0;
  PyErr_Clear();
  if (is_sequence || PyIter_Check(object)) return list_value(object, depth);
  if (const auto number = other_number(object)) return *number;
  if (PyCallable_Check(object) != 0)
    return std::shared_ptr<const design::Surface>(std::make_shared<ScriptSurface>(object));
  return other_value(object);
}

PyObject* move_class = nullptr;   // set once, never released
PyObject* moves_class = nullptr;  // as move_class

py::object tuple3(Point3 p) { return to_tuple(p); }

/// An object of the class Move, which is a named tuple of six.
py::object made_move(const char* kind, Point3 from, Point3 to, int tool, const Step& step) {
  auto* type = reinterpret_cast<PyTypeObject*>(move_class);
  py::object move = py::reinterpret_steal<py::object>(type->tp_alloc(type, 6));
  if (!move) throw py::error_already_set();
  py::object centre = py::none(), turn = py::none();
  if (step.kind() == StepKind::arc) {
    const step::Arc arc = step.arc();
    centre = py::make_tuple(arc.centre.x, arc.centre.y);
    turn = py::str(arc.turn == Turn::cw ? "cw" : "ccw");
  }
  static PyObject* const kRapid = PyUnicode_InternFromString("rapid");
  static PyObject* const kCut = PyUnicode_InternFromString("cut");
  static PyObject* const kExtrude = PyUnicode_InternFromString("extrude");
  PyObject* name = *kind == 'r' ? kRapid : *kind == 'c' ? kCut : kExtrude;
  Py_INCREF(name);
  PyTuple_SET_ITEM(move.ptr(), 0, name);
  PyTuple_SET_ITEM(move.ptr(), 1, tuple3(from).release().ptr());
  PyTuple_SET_ITEM(move.ptr(), 2, tuple3(to).release().ptr());
  PyTuple_SET_ITEM(move.ptr(), 3, PyLong_FromLong(tool));
  PyTuple_SET_ITEM(move.ptr(), 4, centre.release().ptr());
  PyTuple_SET_ITEM(move.ptr(), 5, turn.release().ptr());
  return move;
}

/// The kind of the move that a step is; null for other steps, and filament that is drawn back or pushed.
const char* kind_of(const Step& step, Point3 from) {
  switch (step.kind()) {
    case StepKind::rapid: return "rapid";
    case StepKind::cut:
    case StepKind::arc: return "cut";
    case StepKind::extrude: return step.to() == from ? nullptr : "extrude";
    case StepKind::dwell:
    case StepKind::tool_change:
    case StepKind::spindle:
    case StepKind::coolant:
    case StepKind::path_mode:
    case StepKind::probe:
    case StepKind::temperature:
    case StepKind::fan:
    case StepKind::laser_power:
    case StepKind::layer:
    case StepKind::note:
    case StepKind::verbatim:
    case StepKind::pause:
    case StepKind::end:
    case StepKind::close_path:
    case StepKind::store_home:
    case StepKind::work_zero:
    case StepKind::tool_length:
    case StepKind::unresolved:
    case StepKind::motion_limits:
    case StepKind::extruder: break;
  }
  return nullptr;
}

}  // namespace

design::Value to_value(PyObject* object, int depth) {
  if (PyFloat_Check(object)) return PyFloat_AS_DOUBLE(object);
  if (object == Py_None) return {};
  if (PyBool_Check(object)) return design::Value::truth(object == Py_True);
  if (PyLong_Check(object)) return other_number(object).value_or(HUGE_VAL);
  if (PyUnicode_Check(object)) return text_value(object);
  if (PyTuple_Check(object) || PyList_Check(object)) return list_value(object, depth);
  return special_value(object, depth);
}

py::object to_object(const design::Value& value) {
  switch (value.type()) {
    case design::Type::truth: return py::bool_(value.truth());
    case design::Type::number: return py::float_(value.number());
    case design::Type::text: return to_str(value.text());
    case design::Type::outlines: {
      const design::Outlines& outlines = value.outlines();
      if (outlines.single) return rows_of(outlines.list.front());
      return list_of(outlines.list);
    }
    case design::Type::list: {
      py::list list;
      for (const design::Value& item : value.list()) list.append(to_object(item));
      return py::object(list);
    }
    default: return py::none();
  }
}

py::object moves_of(const Toolpath& path, std::size_t first, Point3 at, int tool) {
  auto* type = reinterpret_cast<PyTypeObject*>(moves_class);
  py::object moves = py::reinterpret_steal<py::object>(type->tp_alloc(type, 0));
  if (!moves) throw py::error_already_set();
  for (std::size_t i = first; i < path.size(); ++i) {
    const Step& step = path[i];
    if (step.kind() == StepKind::tool_change) tool = step.tool_change().tool;
    if (!step.is_motion()) continue;
    Point3 to = step.to();
    for (int axis = 0; axis < 3; ++axis)
      if ((step.unknown_axes() >> axis & 1u) != 0) to[axis] = at[axis];
    // The motion that takes axes without a known position to where the commands are.
    const bool first_of_call = i + 1 < path.size() && path[i + 1].origin() == step.origin();
    if (to == at && step.kind() == StepKind::rapid && first_of_call) continue;
    if (const char* kind = kind_of(step, at))
      if (PyList_Append(moves.ptr(), made_move(kind, at, to, tool, step).ptr()) != 0)
        throw py::error_already_set();
    at = to;
  }
  return moves;
}

Point3 start_of(const Toolpath& path, std::size_t first) {
  PathPosition position;
  if (const auto before = path.motion_before(first)) position.pass(path[*before]);
  return position.at;
}

void set_move_classes(const py::object& move, const py::object& moves) {
  move_class = py::object(move).release().ptr();
  moves_class = py::object(moves).release().ptr();
}

std::string docstring_of(const design::Command& command) {
  std::string text = std::string(command.name) + "($self";
  const auto& all = command.parameters;
  // In Python a parameter with a default does not precede one without.
  std::size_t required = all.size();
  while (required > 0 && !all[required - 1].required) --required;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const design::Parameter& parameter = all[i];
    text += ", " + std::string(parameter.name);
    if (i < required) continue;
    const design::Value& v = parameter.standard;
    text += "=";
    if (v.is(design::Type::truth))
      text += v.truth() ? "True" : "False";
    else if (v.is(design::Type::text))
      text += "'" + v.text() + "'";
    else if (v.is(design::Type::number))
      text += number_text(v.number(), 6);
    else
      text += "None";
  }
  if (command.further == design::Further::taken) text += ", *further";
  text += ")\n--\n\n" + command.text;
  if (command.numbers_without_tool)
    text += "\n\nThe number of the tool may be left out, as in gcodepreview 0.9313: that of the tool in use.";
  return text;
}

}  // namespace kerf::python

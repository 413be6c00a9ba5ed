// Reading and making the list formats.
#include "lists.h"

#include <algorithm>
#include <cmath>

#include "kerf/base/limits.h"

namespace cnc25d {
namespace {

using kerf::Point2;

/// A list or tuple, accessed item by item. Its size is read each time, because converting an item to a number
/// may run Python code that changes the list.
class Items {
 public:
  explicit Items(PyObject* object) : object_(object), is_list_(PyList_Check(object)) {}
  static bool fits(PyObject* object) { return PyList_Check(object) || PyTuple_Check(object); }
  Py_ssize_t size() const { return is_list_ ? PyList_GET_SIZE(object_) : PyTuple_GET_SIZE(object_); }
  PyObject* operator[](Py_ssize_t i) const {
    return is_list_ ? PyList_GET_ITEM(object_, i) : PyTuple_GET_ITEM(object_, i);
  }

 private:
  PyObject* object_;
  bool is_list_;
};

bool is_number(PyObject* object) {
  return PyFloat_Check(object) || PyLong_Check(object) ||
         (PyNumber_Check(object) && !PyComplex_Check(object));
}

/// Reads the numbers of one element.
class Row {
 public:
  Row(PyObject* object, Py_ssize_t element, const std::string& name) : element_(element), name_(name) {
    if (!Items::fits(object))
      refuse(std::string("a list or tuple of numbers is expected, not ") + Py_TYPE(object)->tp_name);
    object_ = py::reinterpret_borrow<py::object>(object);
  }
  Py_ssize_t size() const { return Items(object_.ptr()).size(); }
  double operator()(Py_ssize_t i) const {
    const Items items(object_.ptr());
    if (i >= items.size()) refuse("the list changed while it was read");
    PyObject* item = items[i];
    if (PyFloat_CheckExact(item)) return PyFloat_AS_DOUBLE(item);
    return convert(py::reinterpret_borrow<py::object>(item));
  }

 private:
  [[noreturn]] void refuse(std::string text) const { throw Refusal{7001, name_, element_, std::move(text)}; }
  double convert(const py::object& item) const {
    if (!is_number(item.ptr()))
      refuse(std::string("a number is expected, not ") + Py_TYPE(item.ptr())->tp_name);
    const double value = PyFloat_AsDouble(item.ptr());
    if (value == -1.0 && PyErr_Occurred() != nullptr) {
      PyErr_Clear();
      refuse("a number cannot be read as a float");
    }
    return value;
  }
  py::object object_;
  Py_ssize_t element_;
  const std::string& name_;
};

Items items_of(PyObject* list, const FormatCodes& codes, const std::string& name) {
  if (!Items::fits(list))
    throw Refusal{codes.not_a_list, name, -1,
                  std::string("an outline is a list or a tuple, not ") + Py_TYPE(list)->tp_name};
  const Items items(list);
  if (items.size() == 0) throw Refusal{codes.empty, name, -1, "the outline is empty"};
  return items;
}

[[noreturn]] void refuse_length(int code, const std::string& name, Py_ssize_t element, Py_ssize_t length,
                                const char* expected) {
  throw Refusal{code, name, element,
                std::string(expected) + " numbers are expected, not " + std::to_string(length)};
}

/// A tuple of floats that the garbage collector does not track, as it contains no references to containers.
PyObject* tuple_of(const double* numbers, Py_ssize_t count) {
  PyObject* tuple = PyTuple_New(count);
  if (tuple == nullptr) throw py::error_already_set();
  for (Py_ssize_t i = 0; i < count; ++i) {
    PyObject* number = PyFloat_FromDouble(numbers[i]);
    if (number == nullptr) {
      Py_DECREF(tuple);
      throw py::error_already_set();
    }
    PyTuple_SET_ITEM(tuple, i, number);
  }
  PyObject_GC_UnTrack(tuple);
  return tuple;
}

constexpr const char* kUnusable = "a number is not finite or beyond 1e60";

bool usable(double number) { return std::abs(number) <= kerf::limits::kMaxOutlineCoordinate; }
bool usable(Point2 p) { return usable(p.x) && usable(p.y); }

}  // namespace

Format format_of(PyObject* list, const FormatCodes& codes, const std::string& name) {
  const Items items = items_of(list, codes, name);
  PyObject* first = items[0];
  if (!Items::fits(first) && is_number(first)) return Format::circle;
  if (items.size() == 1) throw Refusal{codes.single, name, 0, "an outline needs at least two elements"};
  const Py_ssize_t length = Row(first, 0, name).size();
  if (length == 2) return Format::b;
  if (length == 3) return Format::a;
  refuse_length(codes.first_length, name, 0, length, "2 (format B) or 3 (format A)");
}

RequestedOutline read_outline(PyObject* list, Format format, const FormatCodes& codes,
                              const std::string& name) {
  const Items items = items_of(list, codes, name);
  const Py_ssize_t extra = format == Format::a ? 1 : 0;
  RequestedOutline made;
  kerf::Outline& outline = made.outline;
  outline.segments.reserve(static_cast<std::size_t>(items.size()));
  if (extra == 1) made.corners.reserve(static_cast<std::size_t>(items.size()));
  for (Py_ssize_t i = 0; i < items.size(); ++i) {
    const Row row(items[i], i, name);
    const Py_ssize_t length = row.size();
    if (i == 0) {
      if (length != 2 + extra) refuse_length(codes.first_length, name, 0, length, extra == 1 ? "3" : "2");
      outline.start = {row(0), row(1)};
      if (extra == 1) made.corners.push_back(kerf::mm(row(2)));
      continue;
    }
    if (length != 2 + extra && length != 4 + extra)
      refuse_length(extra == 1 ? codes.segment_a : codes.segment_b, name, i, length,
                    extra == 1 ? "3 or 5" : "2 or 4");
    kerf::Segment& segment = outline.segments.emplace_back();
    const Py_ssize_t end = length - extra - 2;
    if (end == 2) segment.via = Point2{row(0), row(1)};
    segment.to = {row(end), row(end + 1)};
    if (extra == 1) made.corners.push_back(kerf::mm(row(end + 2)));
  }
  return made;
}

kerf::Circle read_circle(PyObject* list, const FormatCodes& codes, const std::string& name) {
  const Row row(list, -1, name);
  if (row.size() != 3)
    refuse_length(codes.circle_length, name, -1, row.size(), "3 (centre x, centre y, radius)");
  const kerf::Circle circle{{row(0), row(1)}, kerf::mm(row(2))};
  if (!usable(circle.centre) || !usable(circle.radius.mm())) throw Refusal{7002, name, -1, kUnusable};
  return circle;
}

kerf::Curve read_curve(PyObject* list, const FormatCodes& codes, const std::string& name) {
  const Items items = items_of(list, codes, name);
  kerf::Curve curve;
  curve.reserve(static_cast<std::size_t>(items.size()));
  for (Py_ssize_t i = 0; i < items.size(); ++i) {
    const Row row(items[i], i, name);
    if (row.size() != 3)
      refuse_length(i == 0 ? codes.first_length : codes.segment_a, name, i, row.size(), "3");
    const double x = row(0), y = row(1), heading = row(2);
    curve.push_back({{x, y}, kerf::radians(heading)});
  }
  return curve;
}

py::list make_list(const kerf::Outline& outline, const kerf::CornerRequests* corners) {
  const auto request = [&](Py_ssize_t i) { return (*corners)[static_cast<std::size_t>(i)].mm(); };
  py::list list(static_cast<Py_ssize_t>(outline.elements()));
  const double first[] = {outline.start.x, outline.start.y, corners != nullptr ? request(0) : 0.0};
  PyList_SET_ITEM(list.ptr(), 0, tuple_of(first, corners != nullptr ? 3 : 2));
  Py_ssize_t i = 1;
  for (const kerf::Segment& s : outline.segments) {
    double row[5];
    Py_ssize_t n = 0;
    if (s.via) {
      row[n++] = s.via->x;
      row[n++] = s.via->y;
    }
    row[n++] = s.to.x;
    row[n++] = s.to.y;
    if (corners != nullptr) row[n++] = request(i);
    PyList_SET_ITEM(list.ptr(), i++, tuple_of(row, n));
  }
  return list;
}

py::list make_list(const kerf::Curve& curve) {
  py::list list(static_cast<Py_ssize_t>(curve.size()));
  Py_ssize_t i = 0;
  for (const kerf::CurvePoint& p : curve) {
    const double row[] = {p.at.x, p.at.y, p.heading.rad()};
    PyList_SET_ITEM(list.ptr(), i++, tuple_of(row, 3));
  }
  return list;
}

py::list make_list(const kerf::Circle& circle) {
  py::list list;
  for (const double v : {circle.centre.x, circle.centre.y, circle.radius.mm()}) list.append(py::float_(v));
  return list;
}

kerf::Tolerance tolerance_for(const kerf::Outline& outline) {
  constexpr double kOfSize = 1e-11, kRounding = 2e-15;
  double low_x = outline.start.x, high_x = low_x, low_y = outline.start.y, high_y = low_y;
  const auto add = [&](Point2 p) {
    low_x = std::min(low_x, p.x);
    high_x = std::max(high_x, p.x);
    low_y = std::min(low_y, p.y);
    high_y = std::max(high_y, p.y);
  };
  for (const kerf::Segment& s : outline.segments) {
    add(s.to);
    if (s.via) add(*s.via);
  }
  const double size = std::max(high_x - low_x, high_y - low_y);
  const double largest = std::max({-low_x, high_x, -low_y, high_y});
  kerf::Tolerance tolerance;
  tolerance.weld = kerf::mm(kOfSize * size + kRounding * largest);
  return tolerance;
}

void require_finite(const RequestedOutline& shape, const std::string& name) {
  const kerf::Outline& outline = shape.outline;
  for (std::size_t i = 0; i < outline.elements(); ++i) {
    const kerf::Segment* s = i == 0 ? nullptr : &outline.segments[i - 1];
    const double corner = shape.corners.empty() ? 0.0 : shape.corners[i].mm();
    if (!usable(outline.point(i)) || !usable(corner) || (s != nullptr && s->via && !usable(*s->via)))
      throw Refusal{7002, name, static_cast<Py_ssize_t>(i), kUnusable};
  }
}

void require_finite(const kerf::Curve& curve, const std::string& name) {
  for (std::size_t i = 0; i < curve.size(); ++i)
    if (!usable(curve[i].at) || !usable(curve[i].heading.rad()))
      throw Refusal{7002, name, static_cast<Py_ssize_t>(i), kUnusable};
}

}  // namespace cnc25d

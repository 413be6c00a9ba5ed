// Shapes of the plane by name and dimensions, and Bezier surfaces, in Python.
#include "base/names.h"
#include "bind_joints.h"
#include "region_binding.h"

#include "kerf/base/limits.h"
#include "kerf/geom/shapes.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr double kSmallestSide = 1e-3;  // mm, of the rectangle of a surface

py::list table() {
  py::list list;
  for (const PlaneShape& shape : plane_shapes()) {
    py::list arguments;
    for (const ShapeArgument& argument : shape.arguments) {
      py::dict d;
      d["name"] = std::string(argument.name);
      d["default"] = argument.fallback ? py::object(py::float_(*argument.fallback)) : py::none();
      arguments.append(d);
    }
    py::dict d;
    d["name"] = std::string(shape.name);
    d["meaning"] = std::string(shape.meaning);
    d["arguments"] = arguments;
    list.append(d);
  }
  return list;
}

/// A number, not a bool; raises TypeError that names the argument.
double to_number(const py::handle& value, std::string_view argument) {
  const double number = py::isinstance<py::bool_>(value) ? -1.0 : PyFloat_AsDouble(value.ptr());
  if (!py::isinstance<py::bool_>(value) && !(number == -1.0 && PyErr_Occurred() != nullptr)) return number;
  PyErr_Clear();
  throw py::type_error(std::string(argument) + " must be a number, not " + Py_TYPE(value.ptr())->tp_name);
}

py::list outline_of(const std::string& name, const py::args& values) {
  const PlaneShape* shape = plane_shape(name);
  if (shape == nullptr)
    throw py::value_error("there is no shape '" + clipped(name, 60) + "'; kerf.plane_shapes() lists all");
  std::vector<double> numbers;
  for (const py::handle value : values) {
    const std::size_t i = numbers.size();
    numbers.push_back(to_number(
        value, i < shape->arguments.size() ? shape->arguments[i].name : std::string_view("values")));
  }
  Diagnostics diagnostics;
  const auto made = make_plane_shape(*shape, numbers, script_location("plane_shape"), diagnostics);
  raise_value_errors(diagnostics);
  return rows_of(*made);
}

BezierSurface surface_of(const py::object& corner, double width, double height, const py::object& heights) {
  BezierSurface surface;
  surface.corner = to_point2(corner, "corner");
  surface.width = number_within(width, kSmallestSide, limits::kMaxCoordinate, "width", "mm");
  surface.height = number_within(height, kSmallestSide, limits::kMaxCoordinate, "height", "mm");
  const auto four = [](const py::handle& value) {
    if (!py::isinstance<py::sequence>(value) || py::isinstance<py::str>(value) || py::len(value) != 4)
      throw py::value_error("heights must be four rows of four numbers");
    return py::reinterpret_borrow<py::sequence>(value);
  };
  const py::sequence rows = four(heights);
  for (std::size_t i = 0; i < 4; ++i) {
    const py::sequence row = four(rows[i]);
    for (std::size_t k = 0; k < 4; ++k)
      surface.heights[i][k] = number_within(to_number(row[k], "heights"), -limits::kMaxCoordinate,
                                            limits::kMaxCoordinate, "heights", "mm");
  }
  return surface;
}

}  // namespace

void bind_plane_shapes(py::module_& m) {
  m.def("plane_shapes", &table,
        R"(List the shapes of `plane_shape`.

Returns
-------
list of dict
    `name`, `meaning`, and `arguments`, each with `name` and `default` (None: it is required).

Examples
--------
>>> shapes = {shape["name"]: shape for shape in kerf.plane_shapes()}
>>> [argument["name"] for argument in shapes["circle"]["arguments"]]
['x', 'y', 'radius'])");
  m.def("plane_shape", &outline_of, py::arg("name"),
        R"(The outline of a shape of the plane.

Parameters
----------
name : str
    'circle', 'heart', 'salinon' ...; `plane_shapes` lists them.
*values : float
    The arguments of the shape in order, mm and degrees; those at the end that have defaults may be left out.

Returns
-------
list of points and arcs
    The closed outline, counter-clockwise, as in `Region`.

Raises
------
ValueError
    If the shape is unknown, or a value is missing or out of range.

Examples
--------
>>> heart = kerf.Region([kerf.plane_shape("heart", 0, 0, 40)])
>>> heart.bounds[2] - heart.bounds[0]
40.0)");
  py::class_<BezierSurface>(m, "BezierSurface",
                            R"(A Bezier surface of degree 3 in both directions over a rectangle.

Parameters
----------
corner : (float, float)
    The lower left corner of the rectangle, mm.
width, height : float
    Width of the rectangle, mm.
heights : sequence of 4 sequences of 4 float
    Z of the control points, evenly spaced, in rows along X from the corner, mm.

Examples
--------
>>> dome = kerf.BezierSurface((0, 0), 60, 40, [[0] * 4, [0, 9, 9, 0], [0, 9, 9, 0], [0] * 4])
>>> dome(0, 0), round(dome(30, 20), 4)
(0.0, 5.0625))")
      .def(py::init(&surface_of), py::arg("corner"), py::arg("width"), py::arg("height"), py::arg("heights"))
      .def(
          "__call__",
          [](const BezierSurface& s, double x, double y) {
            return s.at({x, y});
          },
          py::arg("x"), py::arg("y"),
          "The height above (x, y), mm; outside, that of the nearest point of the edge.");
}

}  // namespace kerf::python

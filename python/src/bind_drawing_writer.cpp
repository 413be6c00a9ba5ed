// Writing drawings in Python: layers, lines, arcs, circles and polylines as DXF and SVG.
#include <algorithm>

#include "bindings.h"

#include "kerf/base/limits.h"
#include "kerf/drawing/drawing_files.h"
#include "kerf/job/posting.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr const char* kLayer = R"(Add a layer; an existing one stays unchanged.

Parameters
----------
name : str
    Name of the layer.
colour : int
    In the AutoCAD colour index, 1 to 255.)";

constexpr const char* kCircle = R"(Add a circle.

Parameters
----------
layer : str
    Its layer; a new one is added.
x, y : float
    Centre, mm.
radius : float
    mm.)";

constexpr const char* kArc = R"(Add an arc, counter-clockwise.

Parameters
----------
layer : str
    Its layer; a new one is added.
x, y : float
    Centre, mm.
radius : float
    mm.
start, end : float
    Angles from +X, degrees.)";

constexpr const char* kLine = R"(Add a line.

Parameters
----------
layer : str
    Its layer; a new one is added.
x1, y1, x2, y2 : float
    Start and end, mm.)";

constexpr int kMaxColour = 255;  // of the AutoCAD colour index

double coordinate(double value, const char* argument) {
  return number_within(value, -limits::kMaxCoordinate, limits::kMaxCoordinate, argument, "mm");
}

double radius_within(double value) {
  if (!(value > 0.0)) throw py::value_error("radius must be above 0 mm");
  return coordinate(value, "radius");
}

/// The index of a layer, which is added if the drawing does not have it yet.
std::size_t layer_of(Drawing& drawing, const std::string& name, long long colour) {
  if (name.empty() || name.find_first_of("<>/\\\":;?*|=,`\r\n") != std::string::npos)
    throw py::value_error("layer '" + name + "': a name without <>/\\\":;?*|=,` is required");
  const int index = whole_within(colour, 1, kMaxColour, "colour");
  const auto found = std::find_if(drawing.layers.begin(), drawing.layers.end(),
                                  [&](const DrawingLayer& layer) { return layer.name == name; });
  if (found != drawing.layers.end()) return static_cast<std::size_t>(found - drawing.layers.begin());
  DrawingLayer layer;
  layer.name = name;
  layer.colour = index;
  layer.rgb = colour_of_index(index);
  drawing.layers.push_back(layer);
  return drawing.layers.size() - 1;
}

drawing::Polyline polyline_of(const py::sequence& rows, bool closed) {
  drawing::Polyline polyline;
  polyline.closed = closed;
  for (const py::handle row : rows) {
    const Point3 v = to_point3(row, "a vertex (x, y, bulge)");
    polyline.vertices.push_back({v.x, v.y, v.z, 0.0});
  }
  if (polyline.vertices.size() < 2) throw py::value_error("a polyline requires two vertices");
  return polyline;
}

constexpr const char* kWriter =
    R"(A flat drawing to be written as DXF or SVG; coordinates in mm.

Examples
--------
>>> drawing = kerf.DrawingWriter()
>>> drawing.layer("cut", colour=1)
>>> drawing.line("cut", 0, 0, 50, 0)
>>> dxf = drawing.dxf())";

void bind_entities(py::class_<Drawing>& c) {
  c.def(py::init<>())
      .def(
          "layer", [](Drawing& d, const std::string& name, long long colour) { layer_of(d, name, colour); },
          py::arg("name"), py::arg("colour") = 7, kLayer)
      .def(
          "line",
          [](Drawing& d, const std::string& layer, double x1, double y1, double x2, double y2) {
            d.entities.push_back(
                {layer_of(d, layer, 7), drawing::Line{coordinate(x1, "x1"), coordinate(y1, "y1"),
                                                      coordinate(x2, "x2"), coordinate(y2, "y2")}});
          },
          py::arg("layer"), py::arg("x1"), py::arg("y1"), py::arg("x2"), py::arg("y2"), kLine)
      .def(
          "arc",
          [](Drawing& d, const std::string& layer, double x, double y, double radius, double start,
             double end) {
            d.entities.push_back({layer_of(d, layer, 7),
                                  drawing::Arc{coordinate(x, "x"), coordinate(y, "y"), radius_within(radius),
                                               finite_number(start, "start"), finite_number(end, "end")}});
          },
          py::arg("layer"), py::arg("x"), py::arg("y"), py::arg("radius"), py::arg("start"), py::arg("end"),
          kArc)
      .def(
          "circle",
          [](Drawing& d, const std::string& layer, double x, double y, double radius) {
            d.entities.push_back(
                {layer_of(d, layer, 7),
                 drawing::Circle{coordinate(x, "x"), coordinate(y, "y"), radius_within(radius)}});
          },
          py::arg("layer"), py::arg("x"), py::arg("y"), py::arg("radius"), kCircle)
      .def(
          "polyline",
          [](Drawing& d, const std::string& layer, const py::sequence& vertices, bool closed) {
            drawing::Polyline polyline = polyline_of(vertices, closed);
            d.entities.push_back({layer_of(d, layer, 7), std::move(polyline)});
          },
          py::arg("layer"), py::arg("vertices"), py::arg("closed") = false,
          R"(Add a polyline.

Parameters
----------
layer : str
    Its layer; a new one is added.
vertices : sequence of (float, float, float)
    x, y and the bulge of the segment to the next vertex, as in DXF.
closed : bool
    Then the first vertex is not repeated at the end.)");
}

void bind_files(py::class_<Drawing>& c) {
  c.def(
       "__len__", [](const Drawing& d) { return d.entities.size(); }, "Number of entities.")
      .def_property_readonly(
          "bounds",
          [](const Drawing& d) {
            const auto b = drawing_bounds(d);
            return py::make_tuple(b[0], b[1], b[2], b[3]);
          },
          "(float, float, float, float): low x, low y, high x, high y, arcs included.")
      .def(
          "dxf",
          [](const Drawing& d, const std::string& version) {
            const auto wanted = dxf_version_named(version);
            if (!wanted) throw py::value_error("version must be 'r2000' or 'r12', not '" + version + "'");
            return py::bytes(write_dxf(d, *wanted));
          },
          py::arg("version") = "r2000", R"(Write the drawing as DXF.

Parameters
----------
version : {'r2000', 'r12'}
    Version of the format.

Returns
-------
bytes
    The file: UTF-8.)")
      .def(
          "svg",
          [](const Drawing& d, const std::string& title) {
            Drawing titled = d;
            titled.title = title;
            return to_str(write_svg(titled));
          },
          py::arg("title") = "", R"(Write the drawing as SVG 1.1, in its true size.

Parameters
----------
title : str
    Title of the drawing.

Returns
-------
str
    The file.)")
      .def("__repr__", [](const Drawing& d) {
        return "<kerf.DrawingWriter of " + std::to_string(d.entities.size()) + " entities>";
      });
}

}  // namespace

void bind_drawing_writer(py::module_& m) {
  py::class_<Drawing> c(m, "DrawingWriter", kWriter);
  bind_entities(c);
  bind_files(c);
}

}  // namespace kerf::python

// DXF drawings in Python: layers, outlines and regions.
#include "base/names.h"
#include "base/number.h"
#include "bindings.h"
#include "region_binding.h"

#include "kerf/drawing/drawing_outlines.h"
#include "kerf/drawing/svg.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr const char* kDrawing =
    R"(A DXF or SVG drawing: layers, and outlines from them. Made by `load_drawing` and `read_drawing`.

Examples
--------
>>> drawing = kerf.load_drawing("hole.dxf")
>>> drawing.unit, [layer["name"] for layer in drawing.layers]
('mm', ['0', 'CUT'])
>>> round(drawing.region("CUT").area, 2)
201.06)";

constexpr const char* kOutlines =
    R"(Outlines of layers: entities joined end to end, curves as arcs, blocks inserted.

Parameters
----------
layers : str or list of str, optional
    Names of layers. Default: all that are neither off nor frozen.
unit : {'mm', 'inch'}, optional
    The drawing's unit. Default: as specified in the drawing.
tolerance : float
    Maximum deviation of arcs from ellipses and splines, mm.
join : float
    Maximum gap between entities that are joined, mm.
strokes : {'lines', 'areas'}
    Strokes and wide polylines: their centre lines, or the edges of the areas that they cover.
texts : str
    Texts: in the drawing's own fonts ('drawn'), left out ('none'), or all in a built-in font of single
    strokes ('sans') or in a font file.

Returns
-------
DrawingOutlines
    Closed and open ones, mm.

Raises
------
kerf.Error
    If the drawing specifies no unit and none is given, a layer does not exist, or the layers have no outline.
    Open ends are warnings.
)";

constexpr const char* kRegion = R"(The region bounded by the outlines of layers.

Parameters
----------
layers : str or list of str, optional
    As for `outlines`.
unit : {'mm', 'inch'}, optional
    As for `outlines`.
tolerance, join : float
    As for `outlines`, mm.
strokes : {'lines', 'areas'}
    As for `outlines`.
texts : str
    As for `outlines`.
combine : {'drawn', 'nested', 'united'}
    Overlapping shapes: filled ones by their own rules, united, and the others as holes where they lie inside
    of others ('drawn'); all inside of others as holes ('nested'); all united ('united').

Returns
-------
Region
    A new one; mm.

Raises
------
kerf.Error
    As for `outlines`, and if no outline is closed. Open ones are left out with a warning.
)";

struct PyDrawing {
  dxf::Drawing drawing;
};

DrawingOutlineOptions options_for(const py::object& layers, const py::object& unit, double tolerance,
                                  double join, const std::string& strokes, const std::string& texts) {
  DrawingOutlineOptions options;
  const auto shapes = stroke_shapes_of(strokes);
  if (!shapes) throw py::value_error("strokes must be 'lines' or 'areas'");
  options.strokes = *shapes;
  options.texts = texts;
  if (py::isinstance<py::str>(layers))
    options.layers = {py::cast<std::string>(layers)};
  else if (!layers.is_none())
    options.layers = py::cast<std::vector<std::string>>(layers);
  if (!layers.is_none() && options.layers.empty()) throw py::value_error("layers must not be empty");
  if (!unit.is_none()) {
    const auto scale = mm_per_unit(py::cast<std::string>(unit));
    if (!scale) throw py::value_error("unit must be 'mm' or 'inch'");
    options.unit = mm(*scale);
  }
  options.within = mm(number_within(tolerance, 1e-6, 10.0, "tolerance", "mm"));
  options.join = mm(number_within(join, 1e-6, 10.0, "join", "mm"));
  return options;
}

DrawingOutlines outlines_of(const PyDrawing& drawing, const py::object& layers, const py::object& unit,
                            double tolerance, double join, const std::string& strokes,
                            const std::string& texts) {
  const DrawingOutlineOptions options = options_for(layers, unit, tolerance, join, strokes, texts);
  return compute([&](Diagnostics& d) { return drawn_outlines(drawing.drawing, options, d); });
}

PyRegion region_of(const DrawingOutlines& drawn, const std::string& combine, double tolerance) {
  const RegionOptions options = options_of(tolerance, "region");
  const auto combining = combining_of(combine);
  if (!combining) throw py::value_error("combine must be 'drawn', 'nested' or 'united'");
  return PyRegion(compute([&](Diagnostics& d) { return drawn_region(drawn, *combining, options, d); }));
}

py::list shapes_of(const DrawingOutlines& drawn) {
  py::list list;
  for (const DrawnOutline& o : drawn.outlines) {
    if (o.circle)
      list.append(py::make_tuple(o.circle->centre.x, o.circle->centre.y, o.circle->radius.mm()));
    else
      list.append(rows_of(o.outline));
  }
  return list;
}

template <class Field>
py::list names_of(const DrawingOutlines& drawn, Field field) {
  py::list list;
  for (const DrawnOutline& o : drawn.outlines) list.append(o.*field);
  return list;
}

py::list open_ends_of(const DrawingOutlines& drawn) {
  py::list list;
  for (const DrawnOpenEnd& end : drawn.open_ends)
    list.append(py::make_tuple(end.at.x, end.at.y, end.layer, end.entity,
                               end.nearest ? py::object(py::float_(end.distance.mm())) : py::none()));
  return list;
}

py::list layers_of(const PyDrawing& drawing) {
  Diagnostics diagnostics;
  py::list list;
  for (const LayerContent& layer : layer_contents(drawing.drawing, {}, diagnostics)) {
    py::dict types, entry;
    for (const auto& [type, count] : layer.types) types[py::str(type)] = count;
    entry["name"] = layer.name;
    entry["off"] = layer.off;
    entry["frozen"] = layer.frozen;
    entry["colour"] = layer.colour;
    entry["linetype"] = layer.linetype;
    entry["entities"] = types;
    list.append(entry);
  }
  raise_or_warn(diagnostics);
  return list;
}

PyDrawing read(const std::string& data, const std::string& name) {
  return {compute([&](Diagnostics& d) { return read_drawing(data, name, d); })};
}

void bind_drawn(py::module_& m) {
  py::class_<DrawingOutlines>(m, "DrawingOutlines", R"(Outlines from a drawing, in mm.

Examples
--------
>>> found = kerf.load_drawing("hole.dxf").outlines("CUT")
>>> len(found), round(found.region().area, 2)
(1, 201.06))")
      .def_property_readonly(
          "outlines", &shapes_of,
          "list of outlines and circles: points and arcs as for `Region`; circles as (x, y, radius).")
      .def_property_readonly(
          "names", [](const DrawingOutlines& d) { return names_of(d, &DrawnOutline::name); },
          "list of str: layer and number of each outline.")
      .def_property_readonly(
          "handles", [](const DrawingOutlines& d) { return names_of(d, &DrawnOutline::handles); },
          "list of list of str: handles of the entities of each outline.")
      .def_property_readonly(
          "points",
          [](const DrawingOutlines& d) {
            py::list list;
            for (const DrawnPoint& p : d.points) list.append(py::make_tuple(p.at.x, p.at.y));
            return list;
          },
          "list of (x, y): entities of the type POINT.")
      .def_property_readonly("open_ends", &open_ends_of,
                             "list of (float, float, str, str, float or None): x, y, layer, entity, and the "
                             "distance to the nearest other open end.")
      .def_property_readonly(
          "junctions",
          [](const DrawingOutlines& d) {
            py::list list;
            for (const DrawnJunction& j : d.junctions)
              list.append(py::make_tuple(j.at.x, j.at.y, j.layer, j.entities));
            return list;
          },
          "list of (float, float, str, list of str): x, y, layer and entities of points with more than two "
          "ends, or with an end on another entity.")
      .def("region", &region_of, py::kw_only(), py::arg("combine") = "drawn",
           py::arg("tolerance") = kDefaultTolerance,
           R"(The region bounded by the outlines.

Parameters
----------
combine : {'drawn', 'nested', 'united'}
    Overlapping shapes, as of `Drawing.region`.
tolerance : float
    Maximum deviation of the result, mm.

Returns
-------
Region
    A new one; mm.

Raises
------
kerf.Error
    If no outline is closed.)")
      .def("__len__", [](const DrawingOutlines& d) { return d.outlines.size(); })
      .def("__repr__", [](const DrawingOutlines& d) {
        return "<kerf.DrawingOutlines of " + std::to_string(d.outlines.size()) + " outlines>";
      });
}

}  // namespace

void bind_drawing(py::module_& m) {
  bind_drawn(m);
  py::class_<PyDrawing>(m, "Drawing", kDrawing)
      .def_property_readonly(
          "version", [](const PyDrawing& d) { return d.drawing.version; },
          "str: 'AC1015', ...; may be empty.")
      .def_property_readonly(
          "unit",
          [](const PyDrawing& d) -> py::object {
            const int unit = d.drawing.unit.value_or(0);
            return unit == 0 ? py::object(py::none()) : py::object(py::str(dxf::unit_name(unit)));
          },
          "str or None: the unit that the drawing specifies.")
      .def_property_readonly("layers", &layers_of,
                             "list of dict: name, off, frozen, colour, linetype, entities by type.")
      .def("outlines", &outlines_of, py::arg("layers") = py::none(), py::kw_only(),
           py::arg("unit") = py::none(), py::arg("tolerance") = 0.01, py::arg("join") = 0.01,
           py::arg("strokes") = "lines", py::arg("texts") = "drawn", kOutlines)
      .def(
          "region",
          [](const PyDrawing& d, const py::object& layers, const py::object& unit, double tolerance,
             double join, const std::string& strokes, const std::string& texts, const std::string& combine) {
            return region_of(outlines_of(d, layers, unit, tolerance, join, strokes, texts), combine,
                             kDefaultTolerance);
          },
          py::arg("layers") = py::none(), py::kw_only(), py::arg("unit") = py::none(),
          py::arg("tolerance") = 0.01, py::arg("join") = 0.01, py::arg("strokes") = "lines",
          py::arg("texts") = "drawn", py::arg("combine") = "drawn", kRegion)
      .def("__repr__", [](const PyDrawing& d) { return "<kerf.Drawing " + d.drawing.file + ">"; });
  m.def("read_drawing", &read, py::arg("data"), py::arg("name") = "<bytes>",
        R"(Read a drawing from memory: DXF, ASCII or binary, or SVG.

Parameters
----------
data : bytes or str
    The content of the file, as `ezdxf` and others write it; text as UTF-8.
name : str
    File name for messages.

Returns
-------
Drawing
    What it contains, by layers.

Raises
------
kerf.Error
    If it is no drawing. Damaged entities are left out with a warning.

Examples
--------
>>> writer = kerf.DrawingWriter()
>>> writer.circle("CUT", 20, 20, 8)
>>> round(kerf.read_drawing(writer.dxf(), "hole.dxf").region().area, 2)
201.06)");
}

}  // namespace kerf::python

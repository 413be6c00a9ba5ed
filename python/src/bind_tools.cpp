// Tools and stock in Python.
#include <algorithm>

#include "base/number.h"
#include "bindings.h"
#include "formats/tool_libraries.h"
#include "values.h"

#include "kerf/base/limits.h"
#include "kerf/base/units.h"
#include "kerf/formats/workshop_files.h"
#include "kerf/job/program_file.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

/// "square" and {diameter: 3.175} as the text of a --tool option, so that both are checked by one function.
std::string option_text(const std::string& shape_name, const py::kwargs& sizes) {
  std::string text = shape_name;
  for (const auto& [key, value] : sizes) {
    const auto name = py::cast<std::string>(key);
    const double number = PyFloat_AsDouble(value.ptr());
    if (PyErr_Occurred() != nullptr) {
      PyErr_Clear();
      throw py::type_error(name + " must be a number in mm or degrees");
    }
    text += " " + name + "=" + exact_text(finite_number(number, name.c_str()));
  }
  return text;
}

Tool tool_from_text(const std::string& text, long long given_number) {
  const int number = whole_within(given_number, 0, limits::kMaxToolNumber, "number");
  Diagnostics diagnostics;
  std::optional<Tool> tool = read_tool_option(text, script_location("Tool"), diagnostics);
  raise_or_warn(diagnostics);
  if (number != 0) tool->number = number;
  return *tool;
}

/// "square d=3" or a tool's number.
Tool tool_from_spec(const py::object& spec, long long number) {
  if (py::isinstance<py::str>(spec)) return tool_from_text(py::cast<std::string>(spec), number);
  if (!py::isinstance<py::int_>(spec))
    throw py::type_error("spec must be a str such as 'square d=3.175 flute=12' or a tool's number");
  int overflow = 0;
  const long long value = PyLong_AsLongLongAndOverflow(spec.ptr(), &overflow);
  return tool_from_text(
      std::to_string(whole_within(overflow == 0 ? value : -1, 0, limits::kMaxToolNumber, "spec")), number);
}

py::list knots_of(const Profile& profile) {
  py::list list;
  for (const Knot& knot : profile.knots) list.append(py::make_tuple(knot.r, knot.z, knot.bulge));
  return list;
}

py::dict parts_of(const Tool& tool) {
  py::dict parts;
  for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder})
    if (!tool.silhouette.part(part).empty())
      parts[py::str(part == ToolPart::cutting ? "cutting" : std::string(to_string(part)))] =
          knots_of(tool.silhouette.part(part));
  return parts;
}

/// The shapes with their dimensions.
py::list shapes() {
  py::list list;
  for (const std::string& name : shape_names()) {
    py::list dimensions;
    for (const ShapeParameter& parameter : parameters_of(*shape_named(name))) {
      py::dict d;
      d["name"] = std::string(parameter.name);
      d["unit"] = parameter.kind == ShapeParameter::Kind::angle ? "degrees" : "mm";
      d["required"] = parameter.need == ShapeParameter::Need::required;
      dimensions.append(d);
    }
    py::dict shape;
    shape["name"] = name;
    shape["dimensions"] = dimensions;
    list.append(shape);
  }
  return list;
}

double unit_mm(const std::string& unit) {
  if (unit == "mm") return 1.0;
  if (unit == "inch") return kMmPerInch;
  throw py::value_error("unit must be 'mm' or 'inch', not '" + unit + "'");
}

/// Adds the tools of a file to the table: of Kerf's form, or of another program's.
void read_tools(ToolTable& table, const py::bytes& bytes, const std::string& name, const std::string& unit,
                long long first) {
  ToolLibraryOptions options;
  options.unit_mm = unit_mm(unit);
  options.first_number = whole_within(first, 0, limits::kMaxToolNumber, "first");
  options.read_bit = tool_bits_of(name);
  Diagnostics diagnostics;
  read_tool_library(std::string_view(bytes), name, options, table, diagnostics);
  raise_or_warn(diagnostics);
}

py::bytes write_tools(const ToolTable& table, const std::string& format, const std::string& unit) {
  Diagnostics diagnostics;
  const std::string text =
      format == "toml" ? write_tool_file(table) : write_linuxcnc_table(table, unit_mm(unit), diagnostics);
  raise_or_warn(diagnostics);
  return py::bytes(text);
}

Tool drawn_tool(const py::sequence& knots, long long given_number) {
  const int number = whole_within(given_number, 0, limits::kMaxToolNumber, "number");
  shape::Drawn drawn;
  for (const py::handle knot : knots) {
    const Point3 k = to_point3(knot, "a knot (r, z, bulge)");
    drawn.cutting.knots.push_back({k.x, k.y, k.z});
  }
  Diagnostics diagnostics;
  std::optional<Tool> tool = make_tool(number, drawn, {}, script_location("Tool.drawn"), diagnostics);
  raise_or_warn(diagnostics);
  return *tool;
}

Stock block_of(const py::object& size, const std::string& zero, const std::string& zero_height) {
  const Point3 edges = to_point3(size, "size");
  if (edges.x <= 0.0 || edges.y <= 0.0 || edges.z <= 0.0)
    throw py::value_error("size must be above 0 mm in every axis");
  number_within(std::max({edges.x, edges.y, edges.z}), 0.0, limits::kMaxStockSize, "size", "mm");
  const std::optional<ZeroCorner> corner = parse_zero_corner(zero);
  if (!corner)
    throw py::value_error("unknown position of work zero '" + zero +
                          "'; known: lower-left, lower-centre, lower-right, centre-left, centre, "
                          "centre-right, top-left, top-centre, top-right");
  const std::optional<ZeroHeight> height = parse_zero_height(zero_height);
  if (!height) throw py::value_error("unknown height of work zero '" + zero_height + "'; known: top, bottom");
  return make_block(edges, *corner, *height);
}

constexpr const char* kTool =
    R"(A cutting tool: a silhouette of lines and arcs that turns about the spindle axis.

Parameters
----------
spec : str or int
    As on the command line: ``"square d=3.175 flute=12.7"``, ``"V d=12.7 angle=90"``, or the number of a
    built-in tool.
number : int
    Tool number in programs; 0: that of the built-in tool.

Raises
------
kerf.Error
    If the shape or a dimension is invalid, or the tool is unknown.

Examples
--------
>>> kerf.Tool("V d=12.7 angle=90", number=2)
<kerf.Tool 2 V 12.7 mm>
>>> kerf.Tool(102).diameter
3.175)";

constexpr const char* kMake =
    R"(Make a tool of a named shape.

Parameters
----------
shape : str
    'square', 'ball', 'V' ...
number : int
    Tool number in programs.
**sizes : float
    Its dimensions in mm and degrees, named as in tool files: ``diameter=3.175``.

Returns
-------
Tool
    Its sizes in mm.

Raises
------
kerf.Error
    If the shape or a dimension is invalid.)";

constexpr const char* kDrawn =
    R"(Make a tool from its half profile.

Parameters
----------
knots : sequence of (float, float, float)
    Points (r, z, bulge) in mm from the tip upwards; bulge of the segment to the next point, as in DXF.
number : int
    Tool number in programs.

Returns
-------
Tool
    Its sizes in mm.

Raises
------
kerf.Error
    If the profile is invalid.)";

void bind_tool(py::module_& m) {
  py::class_<Tool> c(m, "Tool", kTool);
  bind_copy(c);
  bind_stored(c, write_tool, read_tool, write_tool);
  bind_hash(c, write_tool);
  c.def(py::init(&tool_from_spec), py::arg("spec"), py::arg("number") = 0)
      .def_static(
          "make",
          [](const std::string& shape_name, long long number, const py::kwargs& sizes) {
            return tool_from_text(option_text(shape_name, sizes), number);
          },
          py::arg("shape"), py::arg("number") = 0, kMake)
      .def_static("drawn", &drawn_tool, py::arg("knots"), py::arg("number") = 0, kDrawn)
      .def_readonly("number", &Tool::number, "int: tool number in programs (T word); 0 if not given.")
      .def_readonly("names", &Tool::names, "list of str: vendors' names.")
      .def_readonly("description", &Tool::description, "str: may be empty.")
      .def_property_readonly(
          "shape", [](const Tool& t) { return std::string(name_of(t.shape)); }, "str: 'square', 'V' ...")
      .def_property_readonly(
          "diameter", [](const Tool& t) { return t.diameter.mm(); }, "float: mm.")
      .def_property_readonly(
          "flute", [](const Tool& t) { return t.flute.mm(); }, "float: height of the cutting part, mm.")
      .def_readonly("teeth", &Tool::teeth, "int: number of cutting edges.")
      .def_readonly("teeth_assumed", &Tool::teeth_assumed,
                    "bool: nothing states the number of cutting edges.")
      .def_readonly("plunges", &Tool::plunges, "bool: cuts at its centre, and may plunge.")
      .def_property_readonly(
          "comment",
          [](const Tool& t) -> py::object {
            const auto text = write_tool_comment(t.shape);
            return text ? py::object(to_str(*text)) : py::none();
          },
          "str or None: the comment that describes its shape to CutViewer, such as 'TOOL/MILL, ...'.")
      .def_property_readonly(
          "encoded_number", [](const Tool& t) { return encode_tool_number(t); },
          "int or None: six-digit number of its shape in gcodepreview's scheme.")
      .def_property_readonly(
          "parts", &parts_of,
          "dict: half profiles [(r, z, bulge), ...] of 'cutting', 'neck', 'shank' and 'holder', mm.")
      .def_property_readonly(
          "profile", [](const Tool& t) { return knots_of(t.silhouette.cutting); },
          "list of (r, z, bulge): half profile of the cutting part, mm.")
      .def(
          "diameter_at",
          [](const Tool& t, double depth) {
            return 2.0 * t.silhouette.cutting.radius_at(finite_number(depth, "depth"));
          },
          py::arg("depth"), R"(Look up the diameter at a height above the tip.

Parameters
----------
depth : float
    Height above the tip, mm.

Returns
-------
float
    mm.)")
      .def("__repr__", [](const Tool& t) {
        return "<kerf.Tool " + std::to_string(t.number) + " " + std::string(name_of(t.shape)) + " " +
               number_text(t.diameter.mm(), 4) + " mm>";
      });
}

void bind_table_values(py::class_<ToolTable>& c) {
  const auto numbered = [](const ToolTable& table) {
    py::dict tools;
    for (const auto& [number, tool] : table.tools()) tools[py::int_(number)] = tool;
    return tools;
  };
  c.def(
      "__eq__", [numbered](const ToolTable& a, const ToolTable& b) { return numbered(a).equal(numbered(b)); },
      py::is_operator());
  c.def(py::pickle(numbered, [](const py::dict& tools) {
    ToolTable table;
    for (const auto& [number, tool] : tools) table.set(py::cast<int>(number), py::cast<Tool>(tool));
    return table;
  }));
  c.def(
      "__iter__", [numbered](const ToolTable& table) { return py::iter(numbered(table)); },
      "iterator of int: the numbers, ascending.");
}

constexpr const char* kTable = R"(Tools by tool number: ``table[3] = Tool(...)``.

Examples
--------
>>> table = kerf.ToolTable()
>>> table[3] = kerf.Tool("square d=6")
>>> table.numbers(), 3 in table
([3], True))";

constexpr const char* kShapes = R"(List the shapes of tools.

Returns
-------
list of dict
    `name`, and `dimensions`, each with `name`, `unit` and `required`.

Examples
--------
>>> shapes = {shape["name"]: shape for shape in kerf.tool_shapes()}
>>> [size["name"] for size in shapes["square"]["dimensions"] if size["required"]]
['diameter'])";

constexpr const char* kBuiltIn = R"(Copy the table of built-in tools.

Returns
-------
ToolTable
    A copy: changes to it do not change the built-in tools.

Examples
--------
>>> kerf.built_in_tools()[102]
<kerf.Tool 102 square 3.175 mm>)";

constexpr const char* kFind = R"(Look up the tool with a name of its vendor.

Parameters
----------
name : str
    Such as ``'Amana 46200-K'``.

Returns
-------
Tool or None
    That of the number; None: the table has none.)";

void bind_tool_table(py::module_& m) {
  py::class_<ToolTable> c(m, "ToolTable", kTable);
  bind_copy(c);
  bind_table_values(c);
  c.def(py::init<>())
      .def("__repr__",
           [](const ToolTable& table) {
             return "<kerf.ToolTable of " + std::to_string(table.tools().size()) + " tools>";
           })
      .def("__setitem__",
           [](ToolTable& table, long long number, const Tool& tool) {
             table.set(whole_within(number, 0, limits::kMaxToolNumber, "number"), tool);
           })
      .def("__getitem__",
           [](const ToolTable& table, int number) {
             const Tool* tool = table.find(number);
             if (tool == nullptr) throw py::key_error("no tool " + std::to_string(number));
             return *tool;
           })
      .def("__contains__", [](const ToolTable& table, int number) { return table.find(number) != nullptr; })
      .def("__len__", [](const ToolTable& table) { return table.tools().size(); })
      .def(
          "find",
          [](const ToolTable& table, const std::string& name) -> py::object {
            const Tool* tool = table.find_name(name);
            return tool == nullptr ? py::none() : py::cast(*tool);
          },
          py::arg("name"), kFind)
      .def(
          "numbers",
          [](const ToolTable& table) {
            py::list list;
            for (const auto& [number, tool] : table.tools()) list.append(number);
            return list;
          },
          R"(List the tool numbers of the table, ascending.

Returns
-------
list of int
    In ascending order.)");
  m.def("_read_tools", &read_tools, py::arg("table"), py::arg("data"), py::arg("name"), py::arg("unit"),
        py::arg("first"));
  m.def("_write_tools", &write_tools, py::arg("table"), py::arg("format"), py::arg("unit"));
  m.def("tool_shapes", &shapes, kShapes);
  m.def(
      "built_in_tools", [] { return built_in_tools(); }, kBuiltIn);
}

Stock stock_of_text(const std::string& text) {
  Diagnostics diagnostics;
  std::optional<Stock> stock = read_stock_option(text, script_location("text"), diagnostics);
  raise_or_warn(diagnostics);
  return std::move(*stock);
}

void bind_stock(py::module_& m) {
  py::class_<Stock> c(m, "Stock", R"(The material before the first cut, in mm and work coordinates.

Examples
--------
>>> kerf.Stock.block((100, 60, 12), zero="centre").low
(-50.0, -30.0, -12.0)
>>> kerf.Stock.read("100x60x12 at centre top") == kerf.Stock.block((100, 60, 12), zero="centre")
True)");
  bind_copy(c);
  bind_stored(c, write_stock, read_stock, write_stock);
  bind_hash(c, write_stock);
  c.def("__repr__",
        [](const Stock& s) {
          const Point3 size = s.block.size();
          return "<kerf.Stock " + number_text(size.x, 4) + " x " + number_text(size.y, 4) + " x " +
                 number_text(size.z, 4) + " mm>";
        })
      .def_static("block", &block_of, py::arg("size"), py::arg("zero") = "lower-left",
                  py::arg("zero_height") = "top",
                  R"(Make a block.

Parameters
----------
size : sequence of 3 float
    Edge lengths in X, Y, Z, mm.
zero : str, a position
    Position of work zero in XY: 'lower-left', 'lower-centre', 'lower-right', 'centre-left', 'centre',
    'centre-right', 'top-left', 'top-centre' or 'top-right'; case, spaces and hyphens are ignored.
zero_height : {'top', 'bottom'}
    Height of work zero.

Returns
-------
Stock
    In work coordinates, mm.

Raises
------
ValueError
    If a length is not above 0, or the position is unknown.)")
      .def_static("read", &stock_of_text, py::arg("text"),
                  R"(Read the text of a block, as `--stock` takes it.

Parameters
----------
text : str
    Such as ``'100x60x12 at centre top'`` or ``'0,0,-12 to 100,60,0'``; mm unless it has units.

Returns
-------
Stock
    In work coordinates, mm.

Raises
------
kerf.Error
    For another form, or a length that is not above 0.)")
      .def_property_readonly(
          "low", [](const Stock& s) { return to_tuple(s.block.low); },
          "(float, float, float): lower corner of the bounds, mm.")
      .def_property_readonly(
          "high", [](const Stock& s) { return to_tuple(s.block.high); },
          "(float, float, float): upper corner of the bounds, mm.");
}

}  // namespace

void bind_tools(py::module_& m) {
  bind_tool(m);
  bind_tool_table(m);
  bind_stock(m);
}

}  // namespace kerf::python

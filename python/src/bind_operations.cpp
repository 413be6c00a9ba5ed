// Operations on regions and outlines, and changes of finished programs, in Python. Both take the keys of job
// files and the options of the command by name, with numbers as numbers.
#include <algorithm>
#include <cstring>
#include <fmt/format.h>

#include "base/file_names.h"
#include "base/names.h"
#include "base/quantity.h"
#include "bindings.h"
#include "job/heights.h"
#include "job/probing.h"
#include "job/record/figures.h"
#include "program_arguments.h"
#include "records.h"
#include "region_binding.h"

#include "kerf/base/files.h"
#include "kerf/job/cut_program.h"
#include "kerf/op/rework.h"
#include "kerf/path/report.h"
#include "kerf/program/cut_job.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr int kMaxProbedLines = 200;  // columns or rows of a grid

/// A value of a key. Numbers of numpy are numbers; a path is a text.
CutValue to_value(const std::string& name, const py::handle& value) {
  const auto wrong = [&](const char* what) {
    return py::type_error(name + " must be a number, a str, or a list of either, not " + what);
  };
  if (py::isinstance<py::bool_>(value)) return std::string("yes");
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::hasattr(value, "__fspath__")) return value.attr("__fspath__")().cast<std::string>();
  const bool many = py::hasattr(value, "__len__");  // arrays of numpy have __float__ as well
  if (!many && (py::hasattr(value, "__float__") || py::hasattr(value, "__index__")))
    return py::float_(py::reinterpret_borrow<py::object>(value)).cast<double>();
  if (!py::isinstance<py::sequence>(value)) throw wrong(Py_TYPE(value.ptr())->tp_name);
  std::vector<std::string> texts;
  std::vector<double> numbers;
  for (const py::handle entry : value) {
    const CutValue one = to_value(name, entry);
    const double* number = std::get_if<double>(&one);
    const auto* text = std::get_if<std::string>(&one);
    if (number == nullptr && text == nullptr) throw wrong("a list of lists");
    if (number != nullptr) numbers.push_back(*number);
    texts.push_back(number != nullptr ? fmt::format("{}", *number) : *text);
  }
  return numbers.size() == texts.size() && !texts.empty() ? CutValue(std::move(numbers))
                                                          : CutValue(std::move(texts));
}

/// The number of a text such as "1/4in" in a unit; raises ValueError that names the argument.
double quantity(const std::string& text, const std::string& unit, const std::string& argument) {
  std::string fault;
  const auto value = read_quantity(text, unit, {}, fault);
  if (!value) throw py::value_error(argument + ": " + fault);
  return *value;
}

/// Options with the names of keys, without those that are None or False.
CutValues to_values(const py::dict& options) {
  CutValues values;
  for (const auto& [name, value] : options) {
    std::string key = name.cast<std::string>();
    if (value.is_none() || value.ptr() == Py_False) continue;
    CutValue made = to_value(key, value);
    std::replace(key.begin(), key.end(), '_', '-');
    values.emplace_back(std::move(key), std::move(made));
  }
  return values;
}

/// The outlines of a Region, of one path, or of a list of them.
std::vector<ArtShape> shapes_of(const py::object& value, const py::object& points) {
  std::vector<ArtShape> shapes;
  const auto add = [&](Outline outline) { shapes.push_back({"", "", std::move(outline), {}, {}}); };
  if (!value.is_none())
    for (Outline& path : paths_of(value, "shapes must be a Region or a list of outlines"))
      add(std::move(path));
  if (py::isinstance<PyRegion>(points))  // the centres of its circles
    for (Outline& loop : paths_of(points, "")) add(std::move(loop));
  else if (!points.is_none())
    for (const Point2 p : points_of(points)) shapes.push_back({"", "", {}, {}, p});
  return shapes;
}

/// The mesh of an operation: the name of its file, or the bytes of arrays of points and triangles; with how
/// it is moved and scaled.
std::optional<CutSurface> surface_of(const py::object& value) {
  if (value.is_none()) return std::nullopt;
  const auto parts = value.cast<py::tuple>();
  CutSurface surface;
  surface.move = to_point3(parts[1], "move");
  surface.scale = number_within(parts[2].cast<double>(), 1e-9, 1e9, "scale", "");
  if (py::isinstance<py::str>(parts[0])) {
    surface.file = parts[0].cast<std::string>();
    return surface;
  }
  const auto arrays = parts[0].cast<std::pair<std::string, std::string>>();
  surface.mesh.points.resize(arrays.first.size() / (3 * sizeof(double)));
  for (std::size_t i = 0; i < surface.mesh.points.size(); ++i) {
    double at[3];
    std::memcpy(at, arrays.first.data() + i * sizeof at, sizeof at);
    surface.mesh.points[i] = {at[0], at[1], at[2]};
  }
  surface.mesh.triangles.resize(arrays.second.size() / sizeof surface.mesh.triangles[0]);
  for (std::size_t i = 0; i < surface.mesh.triangles.size(); ++i)
    std::memcpy(surface.mesh.triangles[i].data(), arrays.second.data() + i * sizeof surface.mesh.triangles[0],
                sizeof surface.mesh.triangles[0]);
  return surface;
}

Program cut(const std::string& op, const py::object& shapes, const py::object& points, int number,
            const std::map<int, Tool>& tools, const py::dict& options, const py::object& surface) {
  CutValues values = to_values(options);
  values.emplace_back("op", op);
  const CallLocation where = script_location(op.c_str());
  Diagnostics diagnostics;
  auto job = cut_job_of(values, diagnostics);
  raise_or_warn(diagnostics);
  job->operations.front().tool = number;
  job->operations.front().where = where;
  for (TextShape& text : job->texts) text.options.where = where;
  job->shapes = shapes_of(shapes, points);
  job->surface = surface_of(surface);
  // The area of a raster is that of the outlines that it names.
  if (job->surface && !shapes.is_none()) {
    for (ArtShape& shape : job->shapes) shape.name = "area";
    job->operations.front().outlines = {"area"};
  }
  for (PictureShape& picture : job->pictures)
    if (!picture.file.empty()) picture.file = absolute_path(picture.file);
  for (auto [at, tool] : tools) {
    tool.number = at;
    job->made_tools.emplace(at, std::move(tool));
  }
  SignalProgress progress;
  Diagnostics found;
  std::optional<Program> program;
  {
    const py::gil_scoped_release release;
    program = load_cut_job(*job, "", op, found, &progress);
  }
  progress.rethrow();
  raise_or_warn(found);
  program->source = op;
  program->front_end = "cutting job";
  return std::move(*program);
}

py::list text_outlines(const py::dict& options) {
  TextShape shape;
  const CallLocation where = script_location("text");
  shape.options.where = where;
  Diagnostics diagnostics;
  if (!read_text_keys(to_values(options), shape, diagnostics)) raise_or_warn(diagnostics);
  const auto where_font = font_file_of(shape, diagnostics);
  if (!where_font) raise_or_warn(diagnostics);
  std::optional<InputFile> font;
  if (!where_font->file.empty()) font = InputFile::open(where_font->file, diagnostics);
  raise_os_error_or_warn(diagnostics);
  std::vector<Outline> outlines;
  for (ArtShape& made : compute([&](Diagnostics& d) {
         return shapes_of_text(shape, font ? font->bytes() : "", d, where_font->face);
       }))
    if (made.outline) outlines.push_back(std::move(*made.outline));
  return list_of(outlines);
}

/// `names`: of the arguments that are not called as their options, by option.
Program reworked(const py::object& value, const py::dict& options, const py::object& tools,
                 const std::map<std::string, std::string>& names) {
  Program program = to_program(value);
  ReworkOptions how;
  for (const auto& [name, given] : to_values(options)) {
    const std::string problem = set_rework(how, name, given);
    if (problem.empty()) continue;
    const auto other = names.find(name);
    std::string argument = other == names.end() ? name : other->second;
    std::replace(argument.begin(), argument.end(), '-', '_');
    throw py::value_error(argument + ": " + problem);
  }
  const std::map<int, Tool> known = used_tools(program, to_tool_choices(tools));
  auto changed = compute(
      [&](Diagnostics& diagnostics) { return rework(std::move(program.path), known, how, diagnostics); });
  program.path = std::move(changed.path);
  if (moves_part(how)) program.stock.reset();  // it is not that of the result
  return program;
}

/// One after another; a tool number has one shape in all of them.
Program joined_programs(const py::args& values) {
  std::vector<Program> programs;
  for (const py::handle value : values) programs.push_back(to_program(value));
  if (programs.empty()) throw py::type_error("at least one program is required");
  Program made;
  std::vector<const Toolpath*> paths;
  for (const Program& program : programs) {
    paths.push_back(&program.path);
    if (const std::string problem = add_tools_of(program.tools, made.tools); !problem.empty())
      throw py::value_error(problem);
    if (!made.stock) made.stock = program.stock;
    made.files.insert(made.files.end(), program.files.begin(), program.files.end());
  }
  made.path = compute([&](Diagnostics& diagnostics) { return joined(paths, diagnostics); });
  made.source = "joined";
  made.front_end = "Python";
  made.end = ProgramEnd::seen;
  return made;
}

/// `heights`: the name of a file as bytes, or points (x, y, z).
py::tuple levelled(const py::object& value, const py::object& heights, double max_correction,
                   const std::optional<double>& keep_above, const py::object& work_offset) {
  Program program = to_program(value);
  LevelOptions options;
  options.max_correction = mm(number_within(max_correction, 1e-3, 100.0, "max_correction", "mm"));
  if (keep_above) options.keep_above = finite_number(*keep_above, "keep_above");
  const MeasuredOptions reading = to_measured_options(work_offset);
  std::vector<Point3> points;
  const bool is_file = py::isinstance<py::bytes>(heights);
  if (!is_file && !py::isinstance<py::sequence>(heights))
    throw py::type_error("heights must be a path or a list of points (x, y, z)");
  if (!is_file)
    for (const py::handle point : heights) points.push_back(to_point3(point, "a point of heights"));
  const auto file = is_file ? py::cast<std::string>(heights) : std::string();
  const CallLocation where = script_location("level");
  Diagnostics diagnostics;
  SignalProgress progress;
  std::optional<LevelReport> report;
  {
    const py::gil_scoped_release release;
    if (is_file) {
      report = level_program(program, file, SurfaceReading{reading}, options, diagnostics, &progress);
    } else if (const auto map = HeightMap::make(points, where, diagnostics)) {
      LevelReport made;
      if (auto path = level(program.path, *map, options, made, diagnostics, &progress)) {
        program.path = std::move(*path);
        report = made;
      }
    }
  }
  progress.rethrow();
  raise_os_error_or_warn(diagnostics);
  return py::make_tuple(std::move(program), to_python(record_of(*report)));
}

Program probing(const py::object& over, long long columns, long long rows, double margin, double clearance,
                double depth, double feed) {
  ProbingGrid grid;
  grid.columns = whole_within(columns, 2, kMaxProbedLines, "columns");
  grid.rows = whole_within(rows, 2, kMaxProbedLines, "rows");
  const double around = number_within(margin, -1e4, 1e4, "margin", "mm");
  Box2 area;
  if (py::isinstance<Program>(over) || py::isinstance<Toolpath>(over)) {
    const Box3 cuts = report_on(to_program(over).path, {}).all.cut_bounds;
    if (cuts.empty()) throw py::value_error("the program has no cuts over which heights could be measured");
    area.add(cuts.low.xy());
    area.add(cuts.high.xy());
  } else {
    if (!py::isinstance<py::sequence>(over) || py::isinstance<py::str>(over))
      throw py::type_error("over must be a program, or two opposite corners (x, y) of an area");
    if (py::len(over) != 2) throw py::value_error("over must be a program, or two opposite corners (x, y)");
    for (const py::handle corner : over) area.add(to_point2(corner, "a corner of over"));
  }
  grid.area.add(Point2{area.low.x - around, area.low.y - around});
  grid.area.add(Point2{area.high.x + around, area.high.y + around});
  if (!(grid.area.high.x > grid.area.low.x && grid.area.high.y > grid.area.low.y))
    throw py::value_error("over must be a program, or two opposite corners (x, y) of an area");
  grid.clearance = mm(number_within(clearance, 1e-3, 1e3, "clearance", "mm"));
  grid.depth = mm(number_within(depth, 1e-3, 1e3, "depth", "mm"));
  grid.feed = mm_per_min(number_within(feed, 1e-3, 1e5, "feed", "mm/min"));
  Program program;
  program.source = "probing";
  program.front_end = "Python";
  program.path = probing_program(grid);
  return program;
}

}  // namespace

void bind_operations(py::module_& m) {
  m.def(
      "_tools_of",
      [](const py::object& tools) {
        const ToolChoices choices = to_tool_choices(tools);
        std::map<int, Tool> made = choices.numbered;
        if (choices.any_number) made.insert_or_assign(0, *choices.any_number);
        return made;
      },
      py::arg("tools"));
  m.def("_cut", &cut, py::arg("op"), py::arg("shapes"), py::arg("points"), py::arg("number"),
        py::arg("tools"), py::arg("options"), py::arg("surface") = py::none());
  m.def("_cut_schema", [] { return to_str(cut_job_schema()); });
  m.def(
      "job_example",
      [](std::string op) {
        std::replace(op.begin(), op.end(), '_', '-');
        const auto text = cut_job_example(op);
        if (!text)
          throw py::value_error("unknown operation '" + op +
                                "'; known: " + joined(cut_operation_names(), ", "));
        return to_str(*text);
      },
      py::arg("op"), R"(The text of a job file (.toml) to start from, with all keys of an operation.

Parameters
----------
op : str
    'pocket', 'contour', 'engrave' ... (as of `cut`).

Returns
-------
str
    The text.

Raises
------
ValueError
    If there is no operation of this name.

Examples
--------
>>> with open("plate.toml", "w", encoding="utf-8") as file:
...     length = file.write(kerf.job_example("pocket")))");
  m.def("_quantity", &quantity, py::arg("text"), py::arg("unit"), py::arg("argument"));
  m.def("_text", &text_outlines, py::arg("options"));
  m.def("_rework", &reworked, py::arg("program"), py::arg("options"), py::arg("tools"),
        py::arg("names") = std::map<std::string, std::string>());
  m.def("_joined", &joined_programs);
  m.def("_level", &levelled, py::arg("program"), py::arg("heights"), py::arg("max_correction"),
        py::arg("keep_above"), py::arg("work_offset"));
  m.def("_probing", &probing, py::arg("over"), py::arg("columns"), py::arg("rows"), py::arg("margin"),
        py::arg("clearance"), py::arg("depth"), py::arg("feed"));
}

}  // namespace kerf::python

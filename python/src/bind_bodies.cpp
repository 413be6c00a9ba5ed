// Stock from files, fixtures, comparison, and the fourth axis, in Python.
#include <memory>

#include "bindings.h"
#include "job/record/figures.h"
#include "program_arguments.h"
#include "records.h"
#include "simulation_result.h"

#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"
#include "kerf/sim/compare.h"
#include "kerf/sim/rotary.h"
#include "kerf/sim/simulate.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr double kFullColour = 5.0;  // times the tolerance: the difference with the saturated colour

Stock read_stock(const py::bytes& bytes, const std::string& name) {
  Diagnostics diagnostics;
  const auto stock = read_stock_file(std::string_view(bytes), name, diagnostics);
  raise_or_warn(diagnostics);
  return *stock;
}

Stock moved_stock(const Stock& stock, const std::string& flip, std::optional<double> across,
                  std::optional<double> z, const py::object& shift) {
  StockMove move;
  if (flip == "x") move.flip = StockMove::Flip::about_x;
  if (flip == "y") move.flip = StockMove::Flip::about_y;
  if (move.flip == StockMove::Flip::none && !flip.empty())
    throw py::value_error("flip must be 'x', 'y' or '' (not turned over)");
  if (across) move.across = finite_number(*across, "across");
  if (z) move.z = finite_number(*z, "z");
  move.shift = to_point3(shift, "shift");
  return moved(stock, move);
}

SimulationOptions options_of(double resolution) {
  if (finite_number(resolution, "resolution") < 0.0)
    throw py::value_error("resolution must be 0 (automatic) or above, mm");
  SimulationOptions options;
  options.resolution = mm(resolution);
  return options;
}

py::list contacts_of(const Toolpath& path, const std::vector<std::pair<std::string, Stock>>& fixtures,
                     const std::optional<ToolTable>& tools, double resolution) {
  std::vector<Fixture> solids;
  for (const auto& [name, stock] : fixtures) solids.push_back({name, stock});
  Diagnostics diagnostics;
  SignalProgress progress;
  std::optional<std::vector<FixtureContact>> found;
  {
    const SimulationOptions options = options_of(resolution);
    const py::gil_scoped_release release;
    found = find_fixture_contacts(path, tools ? *tools : built_in_tools(), solids, options, diagnostics,
                                  &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  py::list list;
  for (const FixtureContact& contact : *found) {
    py::dict d;
    d["fixture"] = solids[contact.fixture].name;
    d["step"] = contact.step;
    d["part"] = contact.part ? py::object(py::str(std::string(to_string(*contact.part)))) : py::none();
    d["at"] = to_tuple(contact.at);
    d["depth_mm"] = contact.depth.mm();
    d["met_mm3"] = contact.met.mm3();
    d["origin"] = to_string(path.origin_of(contact.step));
    list.append(d);
  }
  return list;
}

Comparison comparison_of(const MillingResult& result, const Stock& target, double tolerance) {
  if (!target.body) throw py::value_error("target must be a mesh, as load_stock reads it");
  Diagnostics diagnostics;
  SignalProgress progress;
  std::optional<Comparison> c;
  {
    const CompareOptions options{.tolerance = mm(finite_number(tolerance, "tolerance"))};
    const py::gil_scoped_release release;
    c = compare(result.simulation(), *target.body, options, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  return std::move(*c);
}

py::bytes compare_picture(const MillingResult& result, const Stock& target, double tolerance,
                          const std::optional<double>& full, const py::object& view, const py::object& size,
                          const std::optional<std::string>& section) {
  std::optional<View> how;
  if (!view.is_none()) how = to_view(view, size, section);
  const double saturated = full ? *full : kFullColour * tolerance;
  number_within(saturated, 1e-6, limits::kMaxStockSize, "full", "mm");
  const Comparison comparison = comparison_of(result, target, tolerance);
  Diagnostics diagnostics;
  SignalProgress progress;
  std::optional<std::string> bytes;
  {
    const py::gil_scoped_release release;
    bytes = comparison_picture(result.simulation(), comparison, mm(saturated), how, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  return py::bytes(*bytes);
}

py::dict compare_with(const MillingResult& result, const Stock& target, double tolerance) {
  const Comparison made = comparison_of(result, target, tolerance);
  py::dict out = to_python(record_of(made));
  out["map"] = to_array(made.map, "float32", made.nx);
  return out;
}

/// The tools that a program uses, as make_job finds them; of a table, all.
ToolTable tools_of(const Program& program, const py::object& tools) {
  if (py::isinstance<ToolTable>(tools)) return py::cast<const ToolTable&>(tools);
  ToolTable table = built_in_tools();
  for (const auto& [number, tool] : used_tools(program, to_tool_choices(tools))) table.set(number, tool);
  return table;
}

RotaryResult run_rotary(const py::object& path, double diameter, const py::object& x, const py::object& axis,
                        const py::object& tools, double resolution) {
  const Point2 ends = to_point2(x, "x"), yz = to_point2(axis, "axis");
  const RoundBar bar{finite_number(diameter, "diameter"), ends.x, ends.y, yz.x, yz.y};
  const SimulationOptions options = options_of(resolution);
  Diagnostics diagnostics;
  SignalProgress progress;
  Job job;
  job.kind = JobKind::rotary;
  job.program = to_program(path);
  job.tools = tools_of(job.program, tools);
  job.bar = bar;
  std::optional<RotarySimulation> simulation;
  {
    const py::gil_scoped_release release;
    simulation = simulate_rotary(job.program.path, job.tools, bar, options, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  return result_of<RotaryResult>(std::make_shared<const Job>(std::move(job)), std::move(*simulation));
}

py::tuple rotary_mesh(const RotaryResult& result) {
  Mesh mesh;
  Diagnostics diagnostics;
  {
    const py::gil_scoped_release release;
    mesh = extract_mesh(result.simulation().workpiece);
    verify_mesh(mesh, mesh_volume(result.simulation().workpiece), diagnostics);
  }
  raise_or_warn(diagnostics);
  return mesh_tuple(mesh);
}

void bind_rotary(py::module_& m) {
  py::class_<RotaryResult, JobResult>(m, "RotarySimulation",
                                      R"(A bar after the cuts of a toolpath. Made by `simulate_rotary`.

Examples
--------
>>> path = kerf.Toolpath()
>>> path.tool(102); path.spindle(12000); path.rapid((10, 0, 30), rotary=(0, 0, 0))
>>> path.cut((10, 0, 18), feed=300)
>>> bar = kerf.simulate_rotary(path, diameter=40, x=(0, 60))
>>> 0 < bar.removed_mm3 < bar.stock_mm3
True)")
      .def_property_readonly(
          "stock_mm3", [](const RotaryResult& r) { return r.simulation().stock.mm3(); },
          "float: volume before, mm3.")
      .def_property_readonly(
          "removed_mm3", [](const RotaryResult& r) { return r.simulation().removed.mm3(); },
          "float: volume cut away, mm3.")
      .def_property_readonly(
          "hazards", [](const RotaryResult& r) { return hazards_of(r.path(), r.simulation().hazards); },
          "list of dict: hazards as `Simulation.hazards`, in the order of steps.")
      .def("mesh", &rotary_mesh, R"(The surface at A = 0 as a closed mesh.

Returns
-------
(ndarray float32, ndarray uint32, ndarray uint32)
    As `Simulation.mesh`.)");
  m.def("simulate_rotary", &run_rotary, py::arg("path"), py::arg("diameter"), py::arg("x"),
        py::arg("axis") = py::make_tuple(0.0, 0.0), py::arg("tools") = py::none(),
        py::arg("resolution") = 0.0,
        R"(Simulate a toolpath with a fourth axis on a round bar.

Parameters
----------
path : Program or Toolpath
    Its A (degrees) turns the bar about an axis along X, between cuts or during cuts.
diameter : float
    Diameter of the bar, mm.
x : (float, float)
    Both ends of the bar in work coordinates, mm.
axis : (float, float)
    Y and Z of the axis in work coordinates, mm.
tools : Tool, str, ToolTable or list of them, optional
    Default: those of the program's comments and the built-in tools.
resolution : float
    Distance of the rays along the bar and at its surface, mm; 0: automatic.

Returns
-------
RotarySimulation
    The bar after the cuts.

Raises
------
kerf.Error
    If a tool is unknown, the bar has no volume, or a limit is exceeded.

Examples
--------
>>> path = kerf.Toolpath()
>>> path.tool(102); path.spindle(12000); path.rapid((10, 0, 30), rotary=(0, 0, 0))
>>> path.cut((10, 0, 18), feed=300); path.cut((10, 0, 18), feed=2000, rotary=(360, 0, 0))
>>> kerf.simulate_rotary(path, diameter=40, x=(0, 60)).removed_mm3 > 700
True)");
}

void bind_comparison(py::module_& m) {
  m.def("compare", &compare_with, py::arg("simulation"), py::arg("target"), py::arg("tolerance") = 0.05,
        R"(Compare a simulated part with a target mesh.

Parameters
----------
simulation : Simulation
    The part.
target : Stock
    A mesh in work coordinates, read by `load_stock`.
tolerance : float
    Differences up to this depth are not reported, mm.

Returns
-------
dict
    `target_mm3`, `part_mm3`; `gouge` and `rest` with `volume_mm3`, `largest_mm`, `at`; `regions`, a list of
    dict with `kind`, `depth_mm`, `at` and `volume_mm3`, deepest first; `map`, an ndarray (columns in
    Y, columns in X) float32 of distances to the surface of the target in mm, below 0 where material
    is missing.

Raises
------
ValueError
    If the target is a block.
kerf.Error
    If they cannot be compared.

Examples
--------
>>> program = kerf.op.pocket([(30, 20, 12)], "square d=6", depth=4, feed=900)
>>> part = kerf.simulate(program, "60x40x10")
>>> part.save("wanted.stl")
>>> kerf.compare(part, kerf.load_stock("wanted.stl"), 0.1)["regions"]
[])");
  m.def("compare_picture", &compare_picture, py::arg("simulation"), py::arg("target"),
        py::arg("tolerance") = 0.05, py::kw_only(), py::arg("full") = py::none(),
        py::arg("view") = py::none(), py::arg("size") = py::make_tuple(1600, 1000),
        py::arg("section") = py::none(),
        R"(A picture of the differences between a simulated part and a target mesh.

Parameters
----------
simulation : Simulation
    As of `compare`.
target : Stock
    As of `compare`.
tolerance : float
    As of `compare`, mm.
full : float, optional
    The difference with the saturated colour, mm. Default: five times the tolerance.
view : str or (float, float), optional
    The part in the colours of the map, as of `JobResult.picture`. Default: the map from above; gouges are
    red, rests blue.
size : (int, int)
    As of `JobResult.picture`, with a view.
section : str, optional
    As of `JobResult.picture`, with a view.

Returns
-------
bytes
    A PNG.

Examples
--------
>>> part = kerf.simulate(kerf.load("part.nc"), "20x20x5")
>>> part.save("wanted.stl")
>>> png = kerf.compare_picture(part, kerf.load_stock("wanted.stl"), 0.1))");
}

}  // namespace

void bind_bodies(py::module_& m) {
  m.def("_read_stock", &read_stock, py::arg("data"), py::arg("name"));
  m.def("_moved_stock", &moved_stock, py::arg("stock"), py::arg("flip"), py::arg("across"), py::arg("z"),
        py::arg("shift"));
  m.def("_write_left", [](const MillingResult& result) {
    return py::bytes(write_left_file(left_columns(result.simulation().workpiece)));
  });
  m.def("_left_stock", [](const MillingResult& result) {
    return stock_of(make_columns_body(left_columns(result.simulation().workpiece)));
  });
  m.def("fixture_contacts", &contacts_of, py::arg("path"), py::arg("fixtures"), py::arg("tools") = py::none(),
        py::arg("resolution") = 0.0,
        R"(Motions, cuts and rapids, in which any part of the tool touches a fixture.

Parameters
----------
path : Toolpath
    Whose tools are compared with the fixtures.
fixtures : list of (str, Stock)
    Names and bodies: blocks, or meshes read by `load_stock`.
tools : ToolTable, optional
    Default: the built-in tools.
resolution : float
    Maximum distance of the columns of the fixtures, mm; 0: automatic.

Returns
-------
list of dict
    In the order of steps: `fixture` (name), `step` (index), `part` of the tool (None for rapids), `at` (x, y,
    z in mm, work coordinates), `depth_mm`, `met_mm3` (volume of the fixture that is touched), `origin`.

Raises
------
kerf.Error
    If a tool is unknown, or the contacts cannot be computed.

Examples
--------
>>> clamp = kerf.Stock.read("5,5,-5 to 15,15,20")
>>> contacts = kerf.fixture_contacts(kerf.load("part.nc"), [("clamp", clamp)])
>>> contacts[0]["fixture"]
'clamp')");
  bind_comparison(m);
  bind_rotary(m);
}

}  // namespace kerf::python

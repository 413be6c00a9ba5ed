// Stock that is no block, fixtures, comparison, and the fourth axis, in Python.
#include <memory>

#include "bindings.h"
#include "program_arguments.h"
#include "simulation_result.h"

#include "kerf/compare.h"
#include "kerf/fixtures.h"
#include "kerf/rotary.h"
#include "kerf/stock_files.h"
#include "kerf/tool_files.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

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

py::dict compare_with(const MillingResult& result, const Stock& target, double tolerance) {
  if (!target.body) throw py::value_error("target must be a mesh, as load_stock reads it");
  Diagnostics diagnostics;
  SignalProgress progress;
  std::optional<Comparison> c;
  {
    const CompareOptions options{.tolerance = mm(finite_number(tolerance, "tolerance"))};
    const py::gil_scoped_release release;
    c = compare(result.simulation().workpiece, *target.body, options, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  py::dict out;
  out["target_mm3"] = c->target.mm3();
  out["part_mm3"] = c->part.mm3();
  out["gouge_mm3"] = c->gouge.mm3();
  out["rest_mm3"] = c->rest.mm3();
  py::list regions;
  for (const DifferenceRegion& r : c->regions) {
    py::dict d;
    d["kind"] = std::string(to_string(r.kind));
    d["depth_mm"] = r.depth.mm();
    d["at"] = to_tuple(r.at);
    d["volume_mm3"] = r.volume.mm3();
    regions.append(d);
  }
  out["regions"] = regions;
  out["map"] = to_array(c->map, "float32", c->nx);
  return out;
}

RotaryResult run_rotary(const Toolpath& path, double diameter, const py::object& x, const py::object& axis,
                        const std::optional<ToolTable>& tools, double resolution) {
  const Point2 ends = to_point2(x, "x"), yz = to_point2(axis, "axis");
  const RoundBar bar{finite_number(diameter, "diameter"), ends.x, ends.y, yz.x, yz.y};
  const SimulationOptions options = options_of(resolution);
  Diagnostics diagnostics;
  SignalProgress progress;
  Job job;
  job.kind = JobKind::rotary;
  job.program = to_program(py::cast(path));
  job.tools = tools ? *tools : built_in_tools();
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
                                      "What a toolpath left of a bar. Made by `simulate_rotary`.")
      .def_property_readonly(
          "stock_mm3", [](const RotaryResult& r) { return r.simulation().stock.mm3(); },
          "float: volume before, mm3.")
      .def_property_readonly(
          "removed_mm3", [](const RotaryResult& r) { return r.simulation().removed.mm3(); },
          "float: volume cut away, mm3.")
      .def_property_readonly(
          "hazards",
          [](const RotaryResult& r) {
            py::list list;
            for (const Hazard& hazard : r.simulation().hazards) list.append(describe(r.path(), hazard));
            return list;
          },
          "list of dict: moves that would break a tool or a part, in order.")
      .def("mesh", &rotary_mesh, "Surface at A = 0, as `Simulation.mesh`.");
  m.def("simulate_rotary", &run_rotary, py::arg("path"), py::arg("diameter"), py::arg("x"),
        py::arg("axis") = py::make_tuple(0.0, 0.0), py::arg("tools") = py::none(),
        py::arg("resolution") = 0.0,
        R"(Cut a toolpath with a fourth axis out of a round bar.

Parameters
----------
path : Toolpath
    Its A (degrees) turns the bar about X, between cuts or while cutting.
diameter : float
    Of the bar, mm.
x : (float, float)
    Its ends, mm.
axis : (float, float)
    Y and Z of the axis in work coordinates, mm.
tools : ToolTable, optional
    The built-in tools where left out.
resolution : float
    Distance of the rays along the bar and at its surface, mm; 0 chooses one.

Returns
-------
RotarySimulation

Raises
------
kerf.Error
    Unknown tool, bar without volume, more motion than can be cut.)");
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
        R"(Moves that touch fixtures, at feed or at rapid speed, with any part of the tool.

Parameters
----------
path : Toolpath
fixtures : list of (str, Stock)
    Names and solids: blocks, or meshes that `load_stock` has read.
tools : ToolTable, optional
    The built-in tools where left out.
resolution : float
    Largest distance of the fixtures' columns, mm; 0 chooses one.

Returns
-------
list of dict
    `fixture`, `step`, `part` (None in rapid moves), `at`, `depth_mm`, `met_mm3`, `origin`.)");
  m.def("compare", &compare_with, py::arg("simulation"), py::arg("target"), py::arg("tolerance") = 0.05,
        R"(How the part that was cut differs from a target mesh.

Parameters
----------
simulation : Simulation
target : Stock
    A mesh in work coordinates, as `load_stock` reads it.
tolerance : float
    Differences no deeper than this are not told, mm.

Returns
-------
dict
    `target_mm3`, `part_mm3`, `gouge_mm3`, `rest_mm3`; `regions` (`kind`, `depth_mm`, `at`, `volume_mm3`,
    deepest first); `map`, an array (columns in Y, columns in X) of mm, below 0 where material lacks.)");
  bind_rotary(m);
}

}  // namespace kerf::python

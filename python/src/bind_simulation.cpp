// The simulation of milling in Python: volumes, hazards, columns, meshes.
#include <memory>

#include "base/number.h"
#include "bindings.h"
#include "codec/picture/image_files.h"
#include "job/record/figures.h"
#include "program_arguments.h"
#include "records.h"
#include "simulation_result.h"

#include "kerf/base/files.h"
#include "kerf/formats/mesh_files.h"
#include "kerf/formats/workshop_files.h"
#include "kerf/sim/exact_mesh.h"
#include "kerf/sim/render.h"
#include "kerf/sim/simulate.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

using Bodies = std::vector<std::pair<std::string, Stock>>;  // by name

MillingResult simulate_program(const Program& program, const py::object& stock, const py::object& tools,
                               double resolution, long long threads, const Bodies& fixtures,
                               double spoilboard, const py::object& machine);

/// A job of a toolpath with the given tools and stock only.
std::shared_ptr<const Job> plain_job(const Toolpath& path, const py::object& stock, const py::object& tools) {
  Job job;
  job.program = to_program(py::cast(path));
  job.stock = py::cast<const Stock&>(stock);
  job.tools = tools.is_none() ? built_in_tools() : py::cast<const ToolTable&>(tools);
  return std::make_shared<const Job>(std::move(job));
}

MillingResult simulate_toolpath(const Toolpath& path, const py::object& stock, const py::object& tools,
                                double resolution, long long threads, const Bodies& fixtures,
                                double spoilboard, const py::object& machine) {
  if (stock.is_none())
    throw py::type_error(
        "stock must be a Stock: Stock.block(...), load_stock(path), left_stock(simulation); or a str such as "
        "'100x60x12 at centre top'");
  const bool plain = py::isinstance<Stock>(stock) && (tools.is_none() || py::isinstance<ToolTable>(tools)) &&
                     fixtures.empty() && spoilboard == 0.0 && machine.is_none();
  if (!plain)
    return simulate_program(to_program(py::cast(path)), stock, tools, resolution, threads, fixtures,
                            spoilboard, machine);
  std::shared_ptr<const Job> job = plain_job(path, stock, tools);
  SimulationOptions options;
  options.resolution = to_resolution(resolution);
  options.threads = to_threads(threads);
  Diagnostics diagnostics;
  SignalProgress progress;
  std::optional<Simulation> simulation;
  {
    const py::gil_scoped_release release;
    simulation =
        simulate({borrowed(job->program.path), job->tools, *job->stock, options}, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  return result_of<MillingResult>(std::move(job), std::move(*simulation));
}

MillingResult simulate_program(const Program& program, const py::object& stock, const py::object& tools,
                               double resolution, long long threads, const Bodies& fixtures,
                               double spoilboard, const py::object& machine) {
  if (is_print(program.path)) throw py::type_error("the program prints: use simulate_print");
  RunOptions options;
  options.resolution = to_resolution(resolution);
  options.threads = to_threads(threads);
  Diagnostics made, diagnostics;
  MillingResult result;
  JobSettings settings = to_settings(tools, stock, fixtures);
  settings.spoilboard = to_spoilboard(spoilboard);
  if (const auto on = to_machine(machine)) settings.rapid_rates = on->rates_by_axis();
  result.job = std::make_shared<const Job>(make_job(program, settings, UnknownTool::assume, made));
  raise_or_warn(made);
  SignalProgress progress;
  std::optional<JobRun> run;
  {
    const py::gil_scoped_release release;
    run = run_job(*result.job, options, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  result.run = std::make_shared<const JobRun>(std::move(*run));
  return result;
}

/// The mesh of a simulation; nothing if stopped.
std::optional<CheckedMesh> mesh_of(const Simulation& simulation, bool sharp, Diagnostics& diagnostics,
                                   Progress& progress) {
  if (sharp) return extract_exact_mesh(simulation, {}, diagnostics, &progress);
  const MeshColumns columns(simulation.workpiece);
  CheckedMesh made{extract_mesh(columns, {}, &progress), mesh_volume(columns)};
  return progress.stop_requested() ? std::nullopt : std::optional(std::move(made));
}

py::tuple mesh_arrays(const MillingResult& result, bool sharp) {
  std::optional<CheckedMesh> mesh;
  Diagnostics diagnostics;
  SignalProgress progress;
  {
    const py::gil_scoped_release release;
    mesh = mesh_of(result.simulation(), sharp, diagnostics, progress);
    if (mesh) verify_mesh(*mesh, diagnostics);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  return mesh_tuple(mesh ? mesh->mesh : Mesh());
}

py::list column_of(const MillingResult& result, int i, int j) {
  const Workpiece& w = result.simulation().workpiece;
  if (i < 0 || j < 0 || i >= w.columns_x() || j >= w.columns_y()) throw py::index_error("no such column");
  py::list list;
  for (const Interval& run : w.column(i, j))
    list.append(py::make_tuple(w.bounds().low.z + static_cast<double>(run.low),
                               w.bounds().low.z + static_cast<double>(run.high)));
  return list;
}

}  // namespace

py::object hazards_of(const Toolpath& path, const std::vector<Hazard>& hazards) {
  return to_python(record_of(findings_of(hazards, path)));
}

py::tuple mesh_tuple(const Mesh& mesh) {
  return py::make_tuple(to_array(mesh.positions, "float32", 3), to_array(mesh.triangles, "uint32", 3),
                        to_array(mesh.step, "uint32", 1));
}

namespace {

constexpr const char* kColumn =
    R"(The material of a dexel column.

Parameters
----------
i, j : int
    Index in X and in Y, from the lower left corner of the stock.

Returns
-------
list of (float, float)
    Intervals (low, high) in Z, mm, lowest first.

Raises
------
IndexError
    If there is no such column.)";

constexpr const char* kMesh =
    R"(The surface as a closed mesh.

Parameters
----------
sharp : bool
    True: vertices are moved to the surfaces and edges of the tools, most of them to about 2 microns (for
    exceptions see docs/decisions/0019-exact-meshes.md). False: surfaces are interpolated between columns and
    walls lie halfway between them, accurate to half a resolution; several times faster.

Returns
-------
(ndarray float32, ndarray uint32, ndarray uint32)
    Points (n, 3) float32 in mm, triangles (m, 3) uint32, step of each triangle (m,) uint32.
)";

void bind_result(py::module_& m) {
  py::class_<MillingResult, JobResult>(m, "Simulation",
                                       R"(The workpiece after the cuts of a program. Made by `simulate`.

Examples
--------
>>> part = kerf.simulate(kerf.load("part.nc"), "20x20x5")
>>> part.hazards, part.columns[0] > 100
([], True)
>>> part.save("part.stl", "part.png"))")
      .def("__repr__",
           [](const MillingResult& r) {
             return "<kerf.Simulation: " + number_text(r.simulation().removed.mm3(), 3) + " of " +
                    number_text(r.simulation().stock.mm3(), 3) + " mm3 removed, " +
                    std::to_string(r.simulation().hazards.size()) + " hazards>";
           })
      .def_property_readonly(
          "stock_mm3", [](const MillingResult& r) { return r.simulation().stock.mm3(); },
          "float: volume of the stock, mm3.")
      .def_property_readonly(
          "removed_mm3", [](const MillingResult& r) { return r.simulation().removed.mm3(); },
          "float: volume cut away, mm3.")
      .def_property_readonly(
          "left_mm3",
          [](const MillingResult& r) { return (r.simulation().stock - r.simulation().removed).mm3(); },
          "float: volume left, mm3.")
      .def_property_readonly(
          "resolution_mm", [](const MillingResult& r) { return r.simulation().workpiece.pitch().mm(); },
          "float: distance of the columns, mm.")
      .def_property_readonly(
          "columns",
          [](const MillingResult& r) {
            return py::make_tuple(r.simulation().workpiece.columns_x(), r.simulation().workpiece.columns_y());
          },
          "(int, int): columns in X and Y.")
      .def_property_readonly(
          "seconds", [](const MillingResult& r) { return r.simulation().seconds; },
          "float: duration of the simulation.")
      .def_property_readonly(
          "hazards", [](const MillingResult& r) { return hazards_of(r.path(), r.simulation().hazards); },
          "list of dict: hazards in the order of steps: `kind`, `step`, `at`, `depth_mm`, `removed_mm3`, "
          "`origin`.")
      .def_property_readonly(
          "removed_by_step",
          [](const MillingResult& r) { return to_array(r.simulation().removed_by_step, "float32", 1); },
          "ndarray (steps,) float32: volume removed by each step, mm3.")
      .def("column", &column_of, py::arg("i"), py::arg("j"), kColumn)
      .def("mesh", &mesh_arrays, py::kw_only(), py::arg("sharp") = true, kMesh);
}

}  // namespace

void bind_simulation(py::module_& m) {
  bind_result(m);
  m.def("simulate", &simulate_program, py::arg("path"), py::arg("stock") = py::none(),
        py::arg("tools") = py::none(), py::arg("resolution") = 0.0, py::arg("threads") = 0, py::kw_only(),
        py::arg("fixtures") = py::tuple(), py::arg("spoilboard") = 0.0, py::arg("machine") = py::none(),
        R"(Simulate a program or a toolpath on its stock.

Parameters
----------
path : Program or Toolpath
    What is cut.
stock : Stock or str, optional
    For a Toolpath a Stock is required. For a Program also a str such as ``"100x60x12 at centre top"`` (mm);
    default: from the program's comments, else a block around the cuts is assumed.
tools : ToolTable, optional
    Default: the built-in tools. For a Program also a Tool, a str such as ``"2=V d=12.7 angle=90"`` or a list
    of them; other tools are those of the program's comments and the built-in ones.
resolution : float
    Distance of the dexel columns, mm; 0: automatic.
threads : int
    0: as many as the processor has. The result does not depend on it.
fixtures : list of (str, Stock)
    Names and bodies that no part of a tool may touch; contacts are in `Simulation.findings`.
spoilboard : float
    Thickness of the board below the stock that may be cut into, mm.
machine : str or os.PathLike, optional
    A machine file, or the name of a built-in machine: whether its rapids are straight.

Returns
-------
Simulation
    The workpiece after the cuts.

Raises
------
kerf.Error
    If a tool is unknown, the stock has no volume, or the resolution is too fine.

Examples
--------
>>> pocket = kerf.op.pocket([(30, 20, 12)], "square d=6", depth=4, stepdown=2, feed=900)
>>> part = kerf.simulate(pocket, "60x40x10", resolution=0.1)
>>> round(part.removed_mm3, -1)
1810.0)");
  m.def("simulate", &simulate_toolpath, py::arg("path"), py::arg("stock") = py::none(),
        py::arg("tools") = py::none(), py::arg("resolution") = 0.0, py::arg("threads") = 0, py::kw_only(),
        py::arg("fixtures") = py::tuple(), py::arg("spoilboard") = 0.0, py::arg("machine") = py::none());
}

}  // namespace kerf::python

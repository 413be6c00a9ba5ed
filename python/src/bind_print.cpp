// The simulation of prints in Python: volumes, overlap, unsupported beads.
#include <memory>

#include "base/number.h"
#include "bindings.h"
#include "job/filament.h"
#include "job/planned_print.h"
#include "job/record/figures.h"
#include "program_arguments.h"
#include "records.h"
#include "simulation_result.h"

#include "kerf/base/limits.h"
#include "kerf/sim/print.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr double kLightest = 0.1, kHeaviest = 25.0;  // g/cm3, of filament

PrintResult run(const Toolpath& path, double resolution, long long threads,
                const std::optional<double>& layer_height, double bed,
                const std::optional<std::string>& printer) {
  PrintOptions options;
  if (finite_number(resolution, "resolution") < 0.0)
    throw py::value_error("resolution must be 0 (automatic) or above, mm");
  options.resolution = mm(resolution);
  options.threads = static_cast<unsigned>(whole_within(threads, 0, limits::kMaxThreads, "threads"));
  options.layer_height = to_layer_height(layer_height);
  options.bed = mm(number_within(bed, -limits::kMaxStockSize, limits::kMaxStockSize, "bed", "mm"));
  const std::optional<PrinterChoice> on = to_printer(printer);
  Diagnostics diagnostics;
  SignalProgress progress;
  auto job = std::make_shared<const Job>(make_print_job(to_program(py::cast(path))));
  std::optional<PrintSimulation> simulation;
  {
    const py::gil_scoped_release release;
    simulation = simulate_print(job->program.path, options, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  std::vector<Finding> further = on ? printer_findings(job->program.path, &*on) : std::vector<Finding>();
  return result_of<PrintResult>(std::move(job), std::move(*simulation), std::move(further));
}

py::object figures(const py::object& value, std::optional<double> density,
                   const std::optional<std::string>& printer) {
  const Program program = to_program(value);
  if (density) number_within(*density, kLightest, kHeaviest, "density", "g/cm3");
  const std::optional<PrinterChoice> on = to_printer(printer);
  if (!density && !program.filament_density && on && on->filament.density > 0.0)
    density = on->filament.density;
  const PrintFigures found = figures_of_print(program.path, {});
  const Filament filament = filament_of(program, found.extruded, density);
  const PlannedPrint plan = planned_print(program.path, on ? &*on : nullptr, mm(filament.diameter));
  Record out = record_of(found, filament);
  out["flow_mm3_s"] = record_of_flow(plan);
  out["time_s"] = record_of(TimeOfPrint{plan.motion, plan.dwell, std::string(plan.method), plan.printer});
  return to_python(out);
}

py::object totals(const PrintResult& r) { return to_python(record_of_totals(r.simulation().total)); }

py::list layers_of(const PrintResult& r) {
  py::list list;
  for (const PrintLayer& layer : r.simulation().layers) list.append(to_python(record_of(layer)));
  return list;
}

py::object hazards_of(const PrintResult& r) { return to_python(record_of(r.simulation().hazards, r.path())); }

py::tuple mesh_of(const PrintResult& r, bool grooves) {
  Mesh mesh;
  Diagnostics diagnostics;
  {
    const py::gil_scoped_release release;
    Length layer;
    for (const PrintLayer& l : r.simulation().layers) layer = std::max(layer, l.height);
    const ColumnGrid closed = grooves ? ColumnGrid{} : without_grooves(r.simulation().columns, layer);
    const ColumnGrid& columns = grooves ? r.simulation().columns : closed;
    mesh = extract_print_mesh(columns, {});
    verify_mesh(mesh, mesh_volume(columns), diagnostics);
  }
  raise_or_warn(diagnostics);
  return mesh_tuple(mesh);
}

void bind_result(py::module_& m) {
  py::class_<PrintResult, JobResult>(m, "PrintSimulation", R"(A simulated print. Made by `simulate_print`.

Examples
--------
>>> part = kerf.simulate_print(kerf.load("print.gcode"))
>>> part.roads, part.hazards
(4, []))")
      .def("__repr__",
           [](const PrintResult& r) {
             return "<kerf.PrintSimulation: " + number_text(r.simulation().total.laid.mm3(), 3) + " mm3 in " +
                    std::to_string(r.simulation().layers.size()) + " layers, " +
                    std::to_string(r.simulation().hazards.size()) + " hazards>";
           })
      .def_property_readonly("total", &totals, R"(dict: figures of the whole print, mm3 and mm.

`extruded_mm3` is the volume by E, `laid_mm3` that of the material, `overlap_mm3` the part extruded into
existing material, `ends_mm3` that of round free ends, `blobs_mm3` extruded without a motion, `hollow_mm3`
empty space below material, `enclosed_mm3` the part of it without an opening; `road_mm` is the length of all
beads, `unsupported_mm` the part of it without material below.)")
      .def_property_readonly("layers", &layers_of,
                             "list of dict: `z_mm`, `height_mm`, `roads` (number of beads) and figures as "
                             "`total`, lowest first.")
      .def_property_readonly(
          "hazards", &hazards_of,
          "list of dict: contacts of the nozzle, unsupported beads, blobs; in the order of steps.")
      .def_property_readonly(
          "roads", [](const PrintResult& r) { return r.simulation().beads; }, "int: number of beads.")
      .def_property_readonly(
          "resolution_mm", [](const PrintResult& r) { return r.simulation().columns.pitch; },
          "float: distance of the columns, mm.")
      .def_property_readonly(
          "seconds", [](const PrintResult& r) { return r.simulation().seconds; },
          "float: duration of the simulation.")
      .def("mesh", &mesh_of, py::arg("grooves") = false,
           R"(The surface as a closed mesh.

Parameters
----------
grooves : bool
    Keep the grooves between beads, which require many more triangles.

Returns
-------
(ndarray float32, ndarray uint32, ndarray uint32)
    Points (n, 3) float32 in mm, triangles (m, 3) uint32, step of each triangle (m,) uint32.)");
}

}  // namespace

constexpr const char* kFigures = R"(What a program prints, without simulating it.

Parameters
----------
program : Program or Toolpath
    That prints.
density : float, optional
    Density of the filament, g/cm3. Default: from the program's comments, else that of PLA.
printer : str, optional
    Printer with the limits of motions and flow. A name, or a file (.toml), with a filament:
    ``'ender_3:PLA'``; see `printers`.

Returns
-------
dict
    `filament_mm`, `filament_mm3`, `filament_diameter_mm`, `mass_g`, `density_g_cm3`, `density_assumed`;
    `layers` (their number), `layers_mm`, a list of (z, height), lowest first; `layer_height_mm` (`min` and
    `max`), `beads` (their number), `bead_mm` (their length), `bounds_mm` (low corner, high corner; None
    without beads). `time_s`, as the firmware plans it, without heating: `total`, `motion`, `dwell`, `method`
    (by which rule), `machine` (whose limits; None: those of the program). `flow_mm3_s`: the `highest` with
    its `step`, and the `limit` of the hot end, None if it is unknown.

Raises
------
kerf.Error
    If the printer is unknown or its file invalid.

Examples
--------
>>> figures = kerf.print_figures(kerf.load("print.gcode"))
>>> figures["layers"], figures["bead_mm"]
(1, 80.0))";

constexpr const char* kSimulatePrint = R"(Simulate a print.

Parameters
----------
path : Toolpath
    Each extruding motion lays a bead; its section is a rectangle with round sides.
resolution : float
    Distance of the dexel columns, mm; 0: automatic.
threads : int
    0: as many as the processor has. The result does not depend on it.
layer_height : float, optional
    Height of beads for which neither the program's comments nor `Toolpath.extrude` give one, mm. Default: the
    step in Z from the layer below.
bed : float
    Z of the surface of the bed, mm.
printer : str, optional
    What this printer cannot do is among the `findings`: motions outside of its space, too much flow, cold
    extrusion. A name, or a file (.toml), with a filament: ``'ender_3:PLA'``; see `printers`.

Returns
-------
PrintSimulation
    The beads.

Raises
------
kerf.Error
    If there is no bead, a limit is exceeded, or the printer is unknown.

Examples
--------
>>> part = kerf.simulate_print(kerf.load("print.gcode"), layer_height=0.2)
>>> part.save("print.png"))";

void bind_print(py::module_& m) {
  bind_result(m);
  m.def("print_figures", &figures, py::arg("program"), py::kw_only(), py::arg("density") = py::none(),
        py::arg("printer") = py::none(), kFigures);
  m.def("simulate_print", &run, py::arg("path"), py::arg("resolution") = 0.0, py::arg("threads") = 0,
        py::arg("layer_height") = py::none(), py::arg("bed") = 0.0, py::arg("printer") = py::none(),
        kSimulatePrint);
}

}  // namespace kerf::python

// The simulator in Python: what is left of the stock, what was touched that should not be, meshes and
// pictures.
#include <memory>

#include "bindings.h"
#include "simulation_result.h"

#include "kerf/exact_mesh.h"
#include "kerf/files.h"
#include "kerf/image_files.h"
#include "kerf/mesh_files.h"
#include "kerf/number.h"
#include "kerf/render.h"
#include "kerf/simulate.h"
#include "kerf/tool_files.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

Result run(const Toolpath& path, const Stock* stock, const std::optional<ToolTable>& tools, double resolution,
           long long threads) {
  if (stock == nullptr)
    throw py::type_error("stock must be a Stock: Stock.block(...), load_stock(path), left_stock(simulation)");
  if (finite_number(resolution, "resolution") < 0.0)
    throw py::value_error("resolution must be 0 (automatic) or above, mm");
  SimulationOptions options;
  options.resolution = mm(resolution);
  options.threads = static_cast<unsigned>(whole_within(threads, 0, limits::kMaxThreads, "threads"));
  Diagnostics diagnostics;
  SignalProgress progress;
  auto kept = std::make_shared<const Toolpath>(path);
  auto used = std::make_shared<const ToolTable>(tools ? *tools : built_in_tools());
  std::optional<Simulation> simulation;
  {
    const py::gil_scoped_release release;
    simulation = simulate(*kept, *used, *stock, options, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  return {std::move(*simulation), std::move(kept), std::move(used), *stock};
}

py::tuple mesh_arrays(const Result& result, bool sharp) {
  Mesh mesh;
  Diagnostics diagnostics;
  SignalProgress progress;
  {
    const py::gil_scoped_release release;
    const MeshColumns columns(result.simulation.workpiece);
    if (sharp) {
      mesh = extract_exact_mesh(columns, {}, result.simulation.workpiece, *result.path, *result.tools,
                                result.stock, diagnostics, &progress)
                 .value_or(Mesh());
    } else {
      mesh = extract_mesh(columns, {}, &progress);
    }
    if (!progress.stop_requested())
      verify_mesh(mesh, mesh_volume(columns, {.tolerance = SharpenOptions().tolerance}), diagnostics);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  return mesh_tuple(mesh);
}

py::list column_of(const Result& result, int i, int j) {
  const Workpiece& w = result.simulation.workpiece;
  if (i < 0 || j < 0 || i >= w.columns_x() || j >= w.columns_y()) throw py::index_error("no such column");
  py::list list;
  for (const Interval& run : w.column(i, j))
    list.append(py::make_tuple(w.bounds().low.z + static_cast<double>(run.low),
                               w.bounds().low.z + static_cast<double>(run.high)));
  return list;
}

}  // namespace

py::dict describe(const Toolpath& path, const Hazard& hazard) {
  const Origin origin = path.origin_of(hazard.step);
  py::dict d;
  d["kind"] = std::string(to_string(hazard.kind));
  d["step"] = hazard.step;
  d["at"] = to_tuple(hazard.at);
  d["depth_mm"] = hazard.depth.mm();
  d["removed_mm3"] = hazard.removed.mm3();
  d["origin"] = to_string(origin);
  return d;
}

py::tuple mesh_tuple(const Mesh& mesh) {
  return py::make_tuple(to_array(mesh.positions, "float32", 3), to_array(mesh.triangles, "uint32", 3),
                        to_array(mesh.step, "uint32", 1));
}

namespace {

void bind_result(py::module_& m) {
  py::class_<Result>(m, "Simulation", "What a toolpath left of the stock. Made by `simulate`.")
      .def("__repr__",
           [](const Result& r) {
             return "<kerf.Simulation: " + number_text(r.simulation.removed.mm3(), 3) + " of " +
                    number_text(r.simulation.stock.mm3(), 3) + " mm3 removed, " +
                    std::to_string(r.simulation.hazards.size()) + " hazards>";
           })
      .def_property_readonly(
          "stock_mm3", [](const Result& r) { return r.simulation.stock.mm3(); }, "float: volume before, mm3.")
      .def_property_readonly(
          "removed_mm3", [](const Result& r) { return r.simulation.removed.mm3(); },
          "float: volume cut away, mm3.")
      .def_property_readonly(
          "left_mm3", [](const Result& r) { return (r.simulation.stock - r.simulation.removed).mm3(); },
          "float: volume left, mm3.")
      .def_property_readonly(
          "resolution_mm", [](const Result& r) { return r.simulation.workpiece.pitch().mm(); },
          "float: distance of the columns, mm.")
      .def_property_readonly(
          "columns",
          [](const Result& r) {
            return py::make_tuple(r.simulation.workpiece.columns_x(), r.simulation.workpiece.columns_y());
          },
          "(int, int): columns in X and Y.")
      .def_property_readonly(
          "seconds", [](const Result& r) { return r.simulation.seconds; }, "float: time the simulation took.")
      .def_property_readonly(
          "hazards",
          [](const Result& r) {
            py::list list;
            for (const Hazard& hazard : r.simulation.hazards) list.append(describe(*r.path, hazard));
            return list;
          },
          "list of dict: moves that would break a tool or a part, in order; see `kerf simulate --json`.")
      .def_property_readonly(
          "removed_by_step",
          [](const Result& r) { return to_array(r.simulation.removed_by_step, "float32", 1); },
          "ndarray (steps,): volume removed by each step, mm3.")
      .def("column", &column_of, py::arg("i"), py::arg("j"),
           "Material of a column: list of (low, high) Z in mm, lowest first.")
      .def("mesh", &mesh_arrays, py::kw_only(), py::arg("sharp") = true,
           R"(The surface as a closed mesh.

Parameters
----------
sharp : bool
    Whether vertices go where the tools really ended, most of them to about 2 microns (see
    docs/decisions/0006-mesh.md for where not); else surfaces run through the columns and walls stand
    between them, right to half a resolution, which is several times faster.

Returns
-------
tuple of ndarray
    Points (n, 3) float32 in mm, triangles (m, 3) uint32, step of each triangle (m,) uint32.
)");
}

}  // namespace

void bind_simulation(py::module_& m) {
  bind_result(m);
  m.def("simulate", &run, py::arg("path"), py::arg("stock"), py::arg("tools") = py::none(),
        py::arg("resolution") = 0.0, py::arg("threads") = 0,
        R"(Cut a toolpath out of a stock.

Parameters
----------
path : Toolpath
stock : Stock
tools : ToolTable, optional
    The built-in tools where left out.
resolution : float
    Distance of the material columns in mm; 0 chooses one.
threads : int
    0: as many as the machine has. The result does not depend on it.

Returns
-------
Simulation

Raises
------
kerf.Error
    Unknown tool, stock without volume, resolution too fine.)");
}

}  // namespace kerf::python

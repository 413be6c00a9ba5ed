// Printing programs in Python: what is laid, what is laid twice, what hangs in the air.
#include <memory>

#include "bindings.h"
#include "program_arguments.h"
#include "simulation_result.h"

#include "kerf/limits.h"
#include "kerf/number.h"
#include "kerf/print.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

PrintResult run(const Toolpath& path, double resolution, long long threads,
                const std::optional<double>& layer_height, double bed) {
  PrintOptions options;
  if (finite_number(resolution, "resolution") < 0.0)
    throw py::value_error("resolution must be 0 (automatic) or above, mm");
  options.resolution = mm(resolution);
  options.threads = static_cast<unsigned>(whole_within(threads, 0, limits::kMaxThreads, "threads"));
  if (layer_height)
    options.layer_height =
        mm(number_within(*layer_height, 0.02, limits::kMaxBeadWidth, "layer_height", "mm"));
  options.bed = mm(number_within(bed, -limits::kMaxStockSize, limits::kMaxStockSize, "bed", "mm"));
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
  return result_of<PrintResult>(std::move(job), std::move(*simulation));
}

void put_volumes(py::dict& d, const PrintVolumes& v) {
  d["extruded_mm3"] = v.extruded.mm3();
  d["laid_mm3"] = v.laid.mm3();
  d["overlap_mm3"] = v.overlap.mm3();
  d["ends_mm3"] = v.ends.mm3();
  d["hollow_mm3"] = v.hollow.mm3();
  d["enclosed_mm3"] = v.enclosed.mm3();
  d["road_mm"] = v.bead_length.mm();
  d["unsupported_mm"] = v.unsupported.mm();
}

py::dict totals(const PrintResult& r) {
  py::dict d;
  put_volumes(d, r.simulation().total);
  d["blobs_mm3"] = r.simulation().total.blobs.mm3();
  return d;
}

py::list layers_of(const PrintResult& r) {
  py::list list;
  for (const PrintLayer& layer : r.simulation().layers) {
    py::dict d;
    d["z_mm"] = layer.z.mm();
    d["height_mm"] = layer.height.mm();
    d["roads"] = layer.beads;
    put_volumes(d, layer.volumes);
    list.append(d);
  }
  return list;
}

py::list hazards_of(const PrintResult& r) {
  py::list list;
  for (const PrintHazard& hazard : r.simulation().hazards) {
    py::dict d;
    d["kind"] = std::string(to_string(hazard.kind));
    d["step"] = hazard.step;
    d["steps"] = hazard.steps;
    d["at"] = to_tuple(hazard.at);
    d["depth_mm"] = hazard.depth.mm();
    d["length_mm"] = hazard.length.mm();
    d["volume_mm3"] = hazard.volume.mm3();
    d["origin"] = to_string(r.path().origin_of(hazard.step));
    list.append(d);
  }
  return list;
}

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
  py::class_<PrintResult, JobResult>(m, "PrintSimulation",
                                     "What a printing program builds. Made by `simulate_print`.")
      .def("__repr__",
           [](const PrintResult& r) {
             return "<kerf.PrintSimulation: " + number_text(r.simulation().total.laid.mm3(), 3) + " mm3 in " +
                    std::to_string(r.simulation().layers.size()) + " layers, " +
                    std::to_string(r.simulation().hazards.size()) + " hazards>";
           })
      .def_property_readonly("total", &totals, R"(dict: figures of the whole print, mm3 and mm.

`extruded_mm3` as E says; `laid_mm3` material; `overlap_mm3` extruded where material is already; `ends_mm3`
the round free ends; `blobs_mm3` pushed on the spot; `hollow_mm3` empty height below material, of it
`enclosed_mm3` that no way leads out from; `road_mm`, and `unsupported_mm` of it with nothing below.)")
      .def_property_readonly(
          "layers", &layers_of,
          "list of dict: `z_mm`, `height_mm`, `roads` and figures as `total`, lowest first.")
      .def_property_readonly(
          "hazards", &hazards_of,
          "list of dict: moves that hit material, roads that nothing holds, blobs; in order.")
      .def_property_readonly(
          "roads", [](const PrintResult& r) { return r.simulation().beads; }, "int: extruding moves.")
      .def_property_readonly(
          "resolution_mm", [](const PrintResult& r) { return r.simulation().columns.pitch; },
          "float: distance of the columns, mm.")
      .def_property_readonly(
          "seconds", [](const PrintResult& r) { return r.simulation().seconds; },
          "float: time the simulation took.")
      .def("mesh", &mesh_of, py::arg("grooves") = false,
           R"(Surface as `Simulation.mesh` gives it.

Parameters
----------
grooves : bool
    Keep the grooves between roads, which make many more triangles.

Returns
-------
tuple
    points (n, 3) float32 mm, triangles (m, 3) uint32, step of each triangle (m,) uint32.)");
}

}  // namespace

void bind_print(py::module_& m) {
  bind_result(m);
  m.def("simulate_print", &run, py::arg("path"), py::arg("resolution") = 0.0, py::arg("threads") = 0,
        py::arg("layer_height") = py::none(), py::arg("bed") = 0.0,
        R"(Lay the roads of a printing program.

Parameters
----------
path : Toolpath
    Its extruding moves lay roads whose section is a rectangle with round sides.
resolution : float
    Distance of the material columns in mm; 0 chooses one.
threads : int
    0: as many as the machine has. The result does not depend on it.
layer_height : float, optional
    Of roads whose height neither the program's remarks nor `Toolpath.extrude` tell, mm; the step in Z from
    the layer below where left out.
bed : float
    Z of the bed's face, mm.

Returns
-------
PrintSimulation

Raises
------
kerf.Error
    No road, or more columns than can be held.)");
}

}  // namespace kerf::python

// The burn of a laser in Python: its energy per area as an array and as a picture.
#include <algorithm>

#include "base/number.h"
#include "bindings.h"
#include "program_arguments.h"
#include "simulation_result.h"

#include "kerf/base/limits.h"
#include "kerf/job/outputs.h"
#include "kerf/sim/burn.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr double kMaxPower = 1e5;   // W
constexpr double kMaxEnergy = 1e9;  // J/mm2

BurnMap burn(const py::object& value, double beam, double power, double max_s, double cell) {
  const Program program = to_program(value);
  BurnOptions options;
  options.beam = mm(number_within(beam, limits::kThinnestBeam, limits::kWidestBeam, "beam", "mm"));
  options.full_power = number_within(power, 1e-6, kMaxPower, "power", "W");
  options.full_s = number_within(max_s, 1e-6, limits::kMaxSpeed, "max_s", "");
  options.cell = mm(number_within(cell, 0.0, limits::kWidestBeam, "cell", "mm"));
  Diagnostics diagnostics;
  SignalProgress progress;
  std::optional<BurnMap> map;
  {
    const py::gil_scoped_release release;
    map = map_burn(program.path, options, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  return std::move(*map);
}

py::bytes picture(const BurnMap& map, double black, const py::object& size) {
  number_within(black, 0.0, kMaxEnergy, "black", "J/mm2");
  const View view = to_view(py::str("top"), size, std::nullopt);
  std::string bytes;
  {
    const py::gil_scoped_release release;
    bytes = burn_picture(map, black, view.width, view.height);
  }
  return py::bytes(bytes);
}

void bind_map(py::module_& m) {
  const py::tuple size = py::make_tuple(1600, 1000);
  py::class_<BurnMap>(m, "Burn", R"(The energy per area that a laser leaves on a board. Made by `burn`.

Examples
--------
>>> line = kerf.op.laser([[(0, 0), (50, 0)]], power=50, feed=1500)
>>> burnt = kerf.burn(line, power=10)
>>> round(burnt.energy_j, 6), burnt.at((25, 0)) > 1
(10.0, True))")
      .def("__repr__",
           [](const BurnMap& map) {
             return "<kerf.Burn: " + number_text(map.joules, 2) + " J on " + number_text(map.burnt_mm2, 1) +
                    " mm2>";
           })
      .def_property_readonly(
          "energy_j", [](const BurnMap& map) { return map.joules; }, "float: of the whole program, J.")
      .def_property_readonly(
          "beam_s", [](const BurnMap& map) { return map.on.seconds(); }, "float: time of the beam, s.")
      .def_property_readonly(
          "burnt_mm2", [](const BurnMap& map) { return map.burnt_mm2; }, "float: area with energy, mm2.")
      .def_property_readonly(
          "highest_j_mm2", [](const BurnMap& map) { return map.highest; }, "float: J/mm2.")
      .def_property_readonly(
          "highest_at", [](const BurnMap& map) { return py::make_tuple(map.highest_at.x, map.highest_at.y); },
          "(float, float): its position, mm.")
      .def_property_readonly(
          "usual_highest_j_mm2", [](const BurnMap& map) { return map.usual_highest; },
          "float: what 99% of the burnt area do not exceed, J/mm2.")
      .def_property_readonly(
          "low", [](const BurnMap& map) { return py::make_tuple(map.low.x, map.low.y); },
          "(float, float): lower left corner of the map, mm.")
      .def_property_readonly(
          "cell_mm", [](const BurnMap& map) { return map.cell; }, "float: side of a cell, mm.")
      .def_property_readonly(
          "map", [](const BurnMap& map) { return to_array(map.joules_per_mm2, "float32", map.nx); },
          "ndarray (cells in Y, cells in X) float32: J/mm2, rows from low Y.")
      .def(
          "at", [](const BurnMap& map, const py::object& point) { return map.at(to_point2(point, "point")); },
          py::arg("point"), R"(Look up the energy at a point.

Parameters
----------
point : (float, float)
    x and y, mm.

Returns
-------
float
    J/mm2; 0 outside of the map.)")
      .def("picture", &picture, py::kw_only(), py::arg("black") = 0.0, py::arg("size") = size,
           R"(The board from above, darker with more energy.

Parameters
----------
black : float
    The energy that is black, J/mm2; 0: `usual_highest_j_mm2`.
size : (int, int)
    Width and height in pixels, 16 to 8192.

Returns
-------
bytes
    A PNG.)");
}

}  // namespace

void bind_burn(py::module_& m) {
  bind_map(m);
  m.def("burn", &burn, py::arg("program"), py::kw_only(), py::arg("beam") = 0.1, py::arg("power") = 5.0,
        py::arg("max_s") = 1000.0, py::arg("cell") = 0.0,
        R"(Map the energy per area that a laser leaves on a flat board.

Feeds are those of the program, without acceleration; rapids leave nothing.

Parameters
----------
program : Program or Toolpath
    The program of a laser.
beam : float
    Diameter on the board, mm.
power : float
    Power of light at full S, W.
max_s : float
    The S of full power ($30 in GRBL).
cell : float
    Side of the cells of the map, mm; 0: a fifth of the beam, more on large boards.

Returns
-------
Burn
    The energy per area.

Raises
------
kerf.Error
    If the program has no laser power, or its beam is never on.

Examples
--------
>>> disc = kerf.op.laser_fill([(20, 20, 8)], power=40, feed=3000)
>>> png = kerf.burn(disc, beam=0.1, power=10).picture())");
}

}  // namespace kerf::python

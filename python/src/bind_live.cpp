// Simulations that follow the edits of a program, in Python.
#include <cmath>
#include <memory>

#include "bindings.h"
#include "job/record/figures.h"
#include "program_arguments.h"
#include "records.h"
#include "simulation_result.h"
#include "values.h"

#include "kerf/job/live_job.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

using Bodies = std::vector<std::pair<std::string, Stock>>;  // by name

/// A live job with the settings of all its runs.
struct PyLive {
  JobSettings settings;
  RunOptions options;
  std::optional<Machine> machine;
  LiveJob live{};
};

PyLive make_live(const py::object& stock, const py::object& tools, const Bodies& fixtures, double resolution,
                 long long threads, const py::object& machine, double spoilboard, const py::object& rotary) {
  PyLive made;
  made.settings = to_settings(tools, stock, fixtures);
  made.settings.spoilboard = to_spoilboard(spoilboard);
  made.settings.bar = to_bar(rotary);
  made.options.resolution = to_resolution(resolution);
  made.options.threads = to_threads(threads);
  made.machine = to_machine(machine);
  if (made.machine) made.settings.rapid_rates = made.machine->rates_by_axis();
  return made;
}

py::dict dict_of(const LiveJobChange& change) {
  py::dict d;
  d["is_new"] = change.is_new;
  py::list columns, shifts;
  for (const ColumnBlock& block : change.columns)
    columns.append(py::make_tuple(block.i, block.j, block.nx, block.ny));
  for (const StepShift& shift : change.shifts) shifts.append(py::make_tuple(shift.first, shift.by));
  d["columns"] = columns;
  d["shifts"] = shifts;
  return d;
}

py::dict update(PyLive& self, const py::object& program) {
  Diagnostics diagnostics;
  auto job = std::make_shared<const Job>(
      make_job_or_print(to_program(program), self.settings, UnknownTool::assume, diagnostics));
  JobCheckOptions check;
  check.machine = self.machine ? &*self.machine : nullptr;
  SignalProgress progress;
  std::optional<LiveJobChange> change;
  {
    const py::gil_scoped_release release;
    if (!diagnostics.has_errors())
      change = self.live.update(std::move(job), self.options, check, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  return dict_of(*change);
}

const LiveSimulation& cut_of(const PyLive& self) {
  const LiveSimulation* cut = self.live.cut();
  if (cut == nullptr || cut->workpiece() == nullptr)
    throw py::value_error("there is no workpiece: update() has not been called, or the program cuts nothing");
  return *cut;
}

/// Z of the highest material of each column, mm in work coordinates; NaN where there is none.
py::object heights_of(const Workpiece& workpiece) {
  const ColumnGrid grid = workpiece.grid();
  std::vector<float> heights(static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny), NAN);
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (grid.first[i + 1] > grid.first[i])
      heights[i] = static_cast<float>(grid.bounds.low.z) + grid.intervals[grid.first[i + 1] - 1].high;
  return to_array(heights, "float32", grid.nx);
}

py::object heights(const PyLive& self, const std::optional<long long>& steps) {
  const LiveSimulation& cut = cut_of(self);
  if (!steps) return heights_of(*cut.workpiece());
  const auto count =
      static_cast<std::size_t>(whole_within(*steps, 0, static_cast<long long>(cut.path().size()), "steps"));
  SignalProgress progress;
  std::optional<Workpiece> workpiece;
  {
    const py::gil_scoped_release release;
    workpiece = cut.at(count, &progress);
  }
  progress.rethrow();
  return heights_of(*workpiece);
}

constexpr const char* kLive = R"(A simulation that follows the edits of a program.

After an edit only the columns that it touches are cut again; hazards are those of `check`. Prints and jobs on
a fourth axis are run as a whole each time.

Parameters
----------
stock : Stock or str, optional
    As of `check`.
tools : Tool, str, ToolTable or list of them, optional
    As of `check`.
fixtures : list of (str, Stock)
    As of `check`.
resolution : float
    Distance of the dexel columns, mm; 0: by the size of the stock.
threads : int
    0: as many as the processor has.
machine : str or os.PathLike, optional
    As of `check`.
spoilboard : float
    As of `check`.
rotary : str, optional
    As of `check`.

Examples
--------
>>> live = kerf.LiveSimulation(stock="100x60x12")
>>> live.update(kerf.load("part.nc"))["is_new"]
True)";

}  // namespace

void bind_live(py::module_& m) {
  py::class_<PyLive> c(m, "LiveSimulation", kLive);
  refuse_copies(c, "a live simulation cannot be copied or pickled: make one in each process");
  c.def(py::init(&make_live), py::kw_only(), py::arg("stock") = py::none(), py::arg("tools") = py::none(),
        py::arg("fixtures") = py::tuple(), py::arg("resolution") = 0.0, py::arg("threads") = 0,
        py::arg("machine") = py::none(), py::arg("spoilboard") = 0.0, py::arg("rotary") = py::none())
      .def("update", &update, py::arg("program"),
           R"(Make this the simulation of a program.

Parameters
----------
program : Program or Toolpath
    What is shown from now on.

Returns
-------
dict
    `is_new`: nothing of the previous part remains (other stock, tools or kind); `columns`: blocks (i, j,
    number in X, number in Y) of all columns that may differ from before; `shifts`: (first, by), the steps
    from `first` on have numbers higher by `by`.

Raises
------
kerf.Error
    If the program cannot be run; the previous part stays.)")
      .def_property_readonly(
          "kind",
          [](const PyLive& self) {
            static constexpr const char* kKinds[] = {"path_only", "milling", "rotary", "print"};
            return kKinds[static_cast<int>(self.live.kind())];
          },
          "str: 'milling', 'rotary', 'print', or 'path_only': nothing is removed or added.")
      .def_property_readonly(
          "findings", [](const PyLive& self) { return to_python(record_of(self.live.findings())); },
          "list of dict: as of `check`, in the order of steps.")
      .def_property_readonly(
          "removed_mm3", [](const PyLive& self) { return cut_of(self).removed().mm3(); },
          "float: volume cut away, mm3.")
      .def_property_readonly(
          "stock_mm3", [](const PyLive& self) { return cut_of(self).stock().mm3(); },
          "float: volume of the stock, mm3.")
      .def_property_readonly(
          "low",
          [](const PyLive& self) {
            const Box3& box = cut_of(self).workpiece()->bounds();
            return to_tuple(box.low);
          },
          "(float, float, float): lower corner of the workpiece, mm.")
      .def_property_readonly(
          "resolution_mm", [](const PyLive& self) { return cut_of(self).workpiece()->pitch().mm(); },
          "float: distance of the columns, mm.")
      .def("heights", &heights, py::arg("steps") = py::none(),
           R"(The surface from above.

Parameters
----------
steps : int, optional
    After this number of steps of the program. Default: after all.

Returns
-------
ndarray (columns in Y, columns in X) float32
    Z of the highest material of each column, mm; NaN where there is none.)");
}

}  // namespace kerf::python

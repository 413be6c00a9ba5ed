// Checking programs and estimating their time, in Python.
#include "bindings.h"
#include "job/filament.h"
#include "job/load_material.h"
#include "job/planned_print.h"
#include "job/record/figures.h"
#include "program_arguments.h"
#include "records.h"
#include "simulation_result.h"

#include "kerf/formats/workshop_files.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

py::object check(const py::object& program, const py::object& tools, const py::object& stock,
                 const std::vector<std::pair<std::string, Stock>>& fixtures, const py::object& machine,
                 const std::optional<std::string>& material, double resolution, long long threads,
                 double spoilboard, const py::object& rotary, const std::optional<double>& layer_height,
                 const std::optional<std::string>& printer) {
  JobSettings settings = to_settings(tools, stock, fixtures);
  settings.spoilboard = to_spoilboard(spoilboard);
  settings.bar = to_bar(rotary);
  const std::optional<Machine> on = to_machine(machine);
  if (on) settings.rapid_rates = on->rates_by_axis();
  const std::optional<PrinterChoice> prints_on = to_printer(printer);
  Diagnostics diagnostics;
  std::optional<Material> of;
  if (material) of = load_material(*material, diagnostics);
  raise_or_warn(diagnostics);
  JobCheckOptions options;
  options.layer_height = to_layer_height(layer_height);
  options.resolution = to_resolution(resolution);
  options.threads = to_threads(threads);
  options.machine = on ? &*on : nullptr;
  options.printer = prints_on ? &*prints_on : nullptr;
  options.material = of ? &*of : nullptr;
  const Job job = make_job_or_print(to_program(program), settings, UnknownTool::assume, diagnostics);
  SignalProgress progress;
  std::vector<Finding> findings;
  {
    const py::gil_scoped_release release;
    findings = check_job(job, options, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  return to_python(record_of(findings));
}

/// The times of a print as the firmware of a printer plans it.
py::object estimate_print(const Program& program, const PrinterChoice& printer) {
  if (!is_print(program.path)) throw py::value_error("printer is for programs that print");
  const double filament = filament_of(program, {}, std::nullopt).diameter;
  const PlannedPrint plan = planned_print(program.path, &printer, mm(filament));
  return to_python(record_of(TimeOfPrint{plan.motion, plan.dwell, std::string(plan.method), plan.printer}));
}

py::object estimate(const py::object& program, const py::object& machine,
                    const std::optional<std::string>& printer) {
  if (const auto prints_on = to_printer(printer)) {
    if (!machine.is_none()) throw py::value_error("only one of machine and printer may be given");
    return estimate_print(to_program(program), *prints_on);
  }
  const std::optional<Machine> on = to_machine(machine);
  Diagnostics ignored;  // tools and stock do not change the time
  const Job job = make_job(to_program(program), {}, UnknownTool::assume, ignored);
  const JobTimes times = times_of(job, on ? &*on : nullptr);
  return to_python(record_of(times));
}

void bind_check(py::module_& m) {
  m.def("check", &check, py::arg("program"), py::kw_only(), py::arg("tools") = py::none(),
        py::arg("stock") = py::none(), py::arg("fixtures") = py::tuple(), py::arg("machine") = py::none(),
        py::arg("material") = py::none(), py::arg("resolution") = 0.0, py::arg("threads") = 0,
        py::arg("spoilboard") = 0.0, py::arg("rotary") = py::none(), py::arg("layer_height") = py::none(),
        py::arg("printer") = py::none(),
        R"(Check a program for hazards to tool, part and machine.

Parameters
----------
program : Program or Toolpath
    What is checked.
tools : Tool, str, ToolTable or list of them, optional
    A Tool with a number, or ``"2=V d=12.7 angle=90"``, is for that number, without a number for all. Other
    tools are those of the program's comments and the built-in ones.
stock : Stock or str, optional
    Such as ``"100x60x12 at centre top"``, mm. Default: from the program's comments, else a block around the
    cuts is assumed.
fixtures : list of (str, Stock)
    Names and bodies that no part of a tool may touch.
machine : str or os.PathLike, optional
    A profile (TOML), or GRBL's ``$$`` settings, for travel and spindle speeds.
material : str, optional
    Material of the stock, for the chip load: ``'plywood'``, ``'aluminium'`` ...
resolution : float
    Distance of the dexel columns, mm; 0: coarse, by the size of the stock.
threads : int
    0: as many as the processor has.
spoilboard : float
    Thickness of the board below the stock that may be cut into, mm.
rotary : str, optional
    A round bar that A turns, instead of the stock: ``'d=40 length=100 x=0 y=0 z=0'``, mm.
layer_height : float, optional
    Layer height of a print, mm. Default: from the program's comments, else its steps in Z.
printer : str, optional
    Printer whose bed, flow and temperatures are checked. A name, or a file (.toml), with a filament:
    ``'ender_3:PLA'``; see `printers`.

Returns
-------
list of dict
    In the order of steps: `kind`, `step` (index), `steps` (number of motions), `at` (x, y, z in mm, work
    coordinates), `depth_mm`, `removed_mm3`, `message`, `hint`, `origin`, `callers`. Warnings are issued by
    the module `warnings`.

Raises
------
kerf.Error
    If a tool, stock, machine, material or printer is invalid.
OSError
    If the machine file cannot be read.

Examples
--------
>>> found = kerf.check(kerf.load("part.nc"), tools="102=square d=3", stock="20x20x5")
>>> [finding["kind"] for finding in found]
['stop_low'])");
}

}  // namespace

void bind_job(py::module_& m) {
  bind_check(m);
  m.def("estimate", &estimate, py::arg("program"), py::kw_only(), py::arg("machine") = py::none(),
        py::arg("printer") = py::none(),
        R"(Estimate the machining time of a program.

Parameters
----------
program : Program or Toolpath
    What is timed.
machine : str or os.PathLike, optional
    A profile (TOML), or GRBL's ``$$`` settings: times are planned with its accelerations. Default: programmed
    feeds and rapid rates, without acceleration.
printer : str, optional
    For prints, instead of `machine`: times are planned as its firmware does, without heating. A name, or a
    file (.toml): ``'ender_3'``; see `printers`.

Returns
-------
dict
    `total`, `motion`, `cutting`, `rapid`, `dwell`, `halts` in seconds; `stops` (their number); `machine`
    (name or None); `tools` and `operations`, lists of dict with the same times. With `printer` only `total`,
    `motion`, `dwell` and `machine`.

Raises
------
ValueError
    If `printer` is given for a program that does not print, or with `machine`.
kerf.Error
    If the machine file is invalid, or the printer is unknown.
OSError
    If it cannot be read.

Examples
--------
>>> times = kerf.estimate(kerf.load("part.nc"))
>>> times["total"] > times["cutting"] > 0
True)");
}

}  // namespace kerf::python

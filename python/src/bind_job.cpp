// Checking programs and estimating their time, in Python.
#include "bindings.h"
#include "job/filament.h"
#include "job/planned_print.h"
#include "program_arguments.h"
#include "simulation_result.h"

#include "kerf/formats/machine_files.h"

namespace kerf::python {
namespace py = pybind11;

py::dict finding_dict(const Finding& f) {
  py::dict d;
  d["kind"] = f.kind;
  d["step"] = f.step;
  d["steps"] = f.steps;
  d["at"] = to_tuple(f.at);
  d["depth_mm"] = f.depth_mm;
  d["removed_mm3"] = f.removed_mm3;
  d["message"] = to_str(f.message);
  d["hint"] = to_str(f.hint);
  d["origin"] = to_str(to_string(f.origin));
  py::list callers;
  for (const Origin& caller : f.callers) callers.append(to_str(to_string(caller)));
  d["callers"] = callers;
  return d;
}

py::list finding_dicts(const std::vector<Finding>& findings) {
  py::list list;
  for (const Finding& finding : findings) list.append(finding_dict(finding));
  return list;
}

namespace {

py::list check(const py::object& program, const py::object& tools, const py::object& stock,
               const std::vector<std::pair<std::string, Stock>>& fixtures, const py::object& machine,
               const std::optional<std::string>& material, double resolution, long long threads,
               double spoilboard, const py::object& rotary, const std::optional<double>& layer_height,
               const std::optional<std::string>& printer) {
  JobSettings settings = to_settings(tools, stock, fixtures);
  settings.spoilboard = to_spoilboard(spoilboard);
  settings.bar = to_bar(rotary);
  const std::optional<Machine> on = to_machine(machine);
  const std::optional<PrinterChoice> prints_on = to_printer(printer);
  Diagnostics diagnostics;
  std::optional<Material> of;
  if (material) of = material_named(*material, diagnostics);
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
  return finding_dicts(findings);
}

void put_times(py::dict& d, const TimeFigures& time) {
  d["total"] = time.total().seconds();
  d["motion"] = time.motion.seconds();
  d["cutting"] = time.cutting().seconds();
  d["rapid"] = time.rapid.seconds();
  d["dwell"] = time.dwell.seconds();
  d["halts"] = time.halts.seconds();
  d["stops"] = time.stops;
}

/// The times of a print as the firmware of a printer plans it.
py::dict estimate_print(const Program& program, const PrinterChoice& printer) {
  if (!is_print(program.path)) throw py::value_error("printer is for programs that print");
  const double filament = filament_of(program, {}, std::nullopt).diameter;
  const PlannedPrint plan = planned_print(program.path, &printer, mm(filament));
  py::dict out;
  out["total"] = plan.total().seconds();
  out["motion"] = plan.motion.seconds();
  out["dwell"] = plan.dwell.seconds();
  out["machine"] = plan.printer.empty() ? py::object(py::none()) : py::object(to_str(plan.printer));
  return out;
}

py::dict estimate(const py::object& program, const py::object& machine,
                  const std::optional<std::string>& printer) {
  if (const auto prints_on = to_printer(printer)) {
    if (!machine.is_none()) throw py::value_error("only one of machine and printer may be given");
    return estimate_print(to_program(program), *prints_on);
  }
  const std::optional<Machine> on = to_machine(machine);
  Diagnostics ignored;  // tools and stock do not change the time
  const Job job = make_job(to_program(program), {}, UnknownTool::assume, ignored);
  const JobTimes times = times_of(job, on ? &*on : nullptr);
  py::dict out;
  put_times(out, times.estimate.all);
  out["machine"] = times.planned() ? py::object(to_str(times.machine)) : py::none();
  py::list tools, operations;
  for (const ToolTime& t : times.estimate.tools) {
    py::dict d;
    d["number"] = t.tool;
    put_times(d, t.time);
    tools.append(d);
  }
  for (const OperationTime& o : times.estimate.operations) {
    py::dict d;
    d["name"] = to_str(o.name);
    d["tool"] = o.tool;
    d["step"] = o.first_step;
    put_times(d, o.time);
    operations.append(d);
  }
  out["tools"] = tools;
  out["operations"] = operations;
  return out;
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
    Of the stock, for the chip load: ``'plywood'``, ``'aluminium'`` ...
resolution : float
    Distance of the dexel columns, mm; 0: coarse, by the size of the stock.
threads : int
    0: as many as the processor has.
spoilboard : float
    Thickness of the board below the stock that may be cut into, mm.
rotary : str, optional
    A round bar that A turns, instead of the stock: ``'d=40 length=100 x=0 y=0 z=0'``, mm.
layer_height : float, optional
    Of a print, mm. Default: from the program's comments, else its steps in Z.
printer : str, optional
    Of a print: its bed, flow and temperatures are checked. A name, or a file (.toml), with a filament:
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
    If the machine file cannot be read.)");
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
    If it cannot be read.)");
}

}  // namespace kerf::python

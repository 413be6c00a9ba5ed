// Steps of a toolpath in Python other than plain motions: coolant, path mode, probes, printers, lasers,
// layers, texts.
#include "bind_steps.h"

#include <map>

#include "program_arguments.h"

#include "kerf/base/limits.h"
#include "kerf/op/printer.h"
#include "kerf/op/rework.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr double kHottest = 1000.0;  // °C
constexpr double kMaxPower = 1e6;    // of a laser, in the units of the S word
constexpr int kMaxColour = 256;      // of the AutoCAD colour index

PathModeKind to_path_mode(const std::string& name) {
  if (name == "exact_path") return PathModeKind::exact_path;
  if (name == "exact_stop") return PathModeKind::exact_stop;
  if (name == "blend") return PathModeKind::blend;
  throw py::value_error("mode must be 'exact_path', 'exact_stop' or 'blend', not '" + name + "'");
}

ProbeKind to_probe(const std::string& name) {
  if (name == "contact_or_error") return ProbeKind::contact_or_error;
  if (name == "contact") return ProbeKind::contact;
  if (name == "release_or_error") return ProbeKind::release_or_error;
  if (name == "release") return ProbeKind::release;
  throw py::value_error(
      "until must be 'contact_or_error', 'contact', 'release_or_error' or 'release', not '" + name + "'");
}

Heater to_heater(const std::string& name) {
  if (name == "nozzle") return Heater::nozzle;
  if (name == "bed") return Heater::bed;
  if (name == "chamber") return Heater::chamber;
  throw py::value_error("heater must be 'nozzle', 'bed' or 'chamber', not '" + name + "'");
}

LaserMode to_laser_mode(const std::string& name) {
  if (name == "off") return LaserMode::off;
  if (name == "constant") return LaserMode::constant;
  if (name == "dynamic") return LaserMode::dynamic;
  throw py::value_error("mode must be 'off', 'constant' or 'dynamic', not '" + name + "'");
}

PauseKind to_pause(const std::string& name) {
  if (name == "always") return PauseKind::always;
  if (name == "optional") return PauseKind::optional;
  if (name == "pallet_change") return PauseKind::pallet_change;
  throw py::value_error("when must be 'always', 'optional' or 'pallet_change', not '" + name + "'");
}

/// Text of one line: a line break would become a line of G-code.
const std::string& one_line(const std::string& text, const char* argument) {
  if (text.find_first_of("\r\n") != std::string::npos)
    throw py::value_error(std::string(argument) + " must be a single line");
  return text;
}

template <class Added>
void add(Toolpath& path, const Added& step, const char* call) {
  path.add(step, path.origins().add(script_location(call)));
}

void bind_machine_steps(ToolpathClass& c) {
  c.def(
      "coolant",
      [](Toolpath& path, bool flood, bool mist) {
        add(path, step::Coolant{mist, flood}, "coolant");
      },
      py::kw_only(), py::arg("flood") = false, py::arg("mist") = false,
      R"(Switch the coolants on or off (M8, M7, M9): ``coolant()`` switches both off.

Parameters
----------
flood, mist : bool
    Which of them are on.)");
  c.def(
      "path_mode",
      [](Toolpath& path, const std::string& mode, double tolerance) {
        const PathModeKind kind = to_path_mode(mode);
        number_within(tolerance, 0.0, limits::kMaxCoordinate, "tolerance", "mm");
        if (tolerance > 0.0 && kind != PathModeKind::blend)
          throw py::value_error("a tolerance requires the mode 'blend'");
        add(path, step::PathMode{kind, mm(tolerance)}, "path_mode");
      },
      py::arg("mode"), py::kw_only(), py::arg("tolerance") = 0.0,
      R"(Set how corners are run (G61, G61.1, G64).

Parameters
----------
mode : {'exact_path', 'exact_stop', 'blend'}
tolerance : float
    Permitted distance from the path when blending, mm; 0: none specified.)");
  c.def(
      "probe",
      [](Toolpath& path, const py::object& to, double feed, const std::string& until) {
        step::Probe probe;
        probe.to = to_point3(to, "to");
        probe.feed = positive_feed(feed);
        probe.kind = to_probe(until);
        add(path, probe, "probe");
      },
      py::arg("to"), py::arg("feed"), py::kw_only(), py::arg("until") = "contact_or_error",
      R"(Append a probing motion (G38.2 to G38.5).

Parameters
----------
to : sequence of 3 float
    End point if the probe does not trip, mm, work coordinates.
feed : float
    mm/min, above 0.
until : {'contact_or_error', 'contact', 'release_or_error', 'release'}
    The event that ends the motion; '..._or_error': its absence stops the program.)");
  c.def(
      "pause",
      [](Toolpath& path, const std::string& when) { add(path, step::Pause{to_pause(when)}, "pause"); },
      py::arg("when") = "always",
      R"(Wait for the operator.

Parameters
----------
when : {'always', 'optional', 'pallet_change'}
    M0, M1 or M60.)");
  c.def(
      "end", [](Toolpath& path, bool rewind) { add(path, step::End{rewind}, "end"); }, py::kw_only(),
      py::arg("rewind") = false, R"(End the program.

Parameters
----------
rewind : bool
    Ready to run again: M30 instead of M2.)");
}

void bind_printer_steps(ToolpathClass& c) {
  c.def(
      "temperature",
      [](Toolpath& path, const std::string& heater, double celsius, bool wait,
         const std::optional<long long>& extruder) {
        step::Temperature t{to_heater(heater), number_within(celsius, 0.0, kHottest, "celsius", "°C"), wait};
        if (extruder) t.extruder = whole_within(*extruder, 0, limits::kMaxExtruders - 1, "extruder");
        if (extruder && t.heater != Heater::nozzle)
          throw py::value_error("extruder is for the heater 'nozzle' only");
        add(path, t, "temperature");
      },
      py::arg("heater"), py::arg("celsius"), py::kw_only(), py::arg("wait") = false,
      py::arg("extruder") = py::none(),
      R"(Set the temperature of a printer's heater.

Parameters
----------
heater : {'nozzle', 'bed', 'chamber'}
celsius : float
    °C; 0: off.
wait : bool
    Wait until it is reached.
extruder : int, optional
    Whose nozzle it is. Default: that of the extruder in use.)");
  c.def(
      "extruder",
      [](Toolpath& path, long long number) {
        add(path, step::Extruder{whole_within(number, 0, limits::kMaxExtruders - 1, "number")}, "extruder");
      },
      py::arg("number"), R"(Lay the beads that follow with another extruder of the printer.

Parameters
----------
number : int
    From 0.)");
  c.def(
      "home",
      [](Toolpath& path, const std::string& axes) {
        const unsigned bits = axes_named(axes, "axes");
        if (bits == 0) throw py::value_error("axes must name X, Y or Z");
        add_home(path, bits, path.origins().add(script_location("home")));
      },
      py::arg("axes") = "XYZ",
      R"(Run axes of a printer to their end switches; their positions are unknown then.

Parameters
----------
axes : str
    Such as ``'XY'``.)");
  c.def(
      "switch_off",
      [](Toolpath& path) { switch_off(path, path.origins().add(script_location("switch_off"))); },
      "Switch off the fans and heaters of a printer that are on.");
  c.def(
      "fan",
      [](Toolpath& path, double fraction, long long number) {
        add(path,
            step::Fan{whole_within(number, 0, limits::kMaxFans, "number"),
                      number_within(fraction, 0.0, 1.0, "fraction", "")},
            "fan");
      },
      py::arg("fraction"), py::arg("number") = 0, R"(Set the speed of a printer's fan.

Parameters
----------
fraction : float
    0 to 1.
number : int
    Which of the fans.)");
}

void bind_laser_steps(ToolpathClass& c) {
  c.def(
      "laser",
      [](Toolpath& path, double power, const std::string& mode) {
        add(path, step::LaserPower{to_laser_mode(mode), number_within(power, 0.0, kMaxPower, "power", "")},
            "laser");
      },
      py::arg("power") = 0.0, py::arg("mode") = "constant",
      R"(Set a laser's power.

Parameters
----------
power : float
    In the units of the controller's S word.
mode : {'constant', 'dynamic', 'off'}
    'dynamic': proportional to the speed (M4); 'off': M5.)");
}

std::map<int, Tool> tools_in(const py::object& path) {
  if (py::isinstance<Program>(path)) return py::cast<const Program&>(path).tools;
  if (!py::isinstance<Toolpath>(path) || !py::hasattr(path, kToolsOfPath)) return {};
  return py::cast<std::map<int, Tool>>(path.attr(kToolsOfPath));
}

void bind_texts(ToolpathClass& c) {
  c.def(
      "layer",
      [](Toolpath& path, const std::string& name, long long colour) {
        add(path, step::Layer{one_line(name, "name"), whole_within(colour, 0, kMaxColour, "colour")},
            "layer");
      },
      py::arg("name"), py::arg("colour") = kMaxColour,
      R"(Start a layer of drawings, or of a print.

Parameters
----------
name : str
    The layer of the following motions.
colour : int
    AutoCAD colour index; 256: that of the layer.)");
  c.def(
      "verbatim",
      [](Toolpath& path, const std::string& text) {
        add(path, step::Verbatim{one_line(text, "text")}, "verbatim");
      },
      py::arg("text"),
      R"(Pass a line to the controller unchanged.

The line must neither move the machine nor change how other lines are read; posts report lines with words
that do.

Parameters
----------
text : str
    The line.)");
  c.def(
      "append",
      [](const py::object& path, const py::object& program) {
        const Toolpath copy = to_program(program).path;  // it may be `path` itself
        std::map<int, Tool> tools = tools_in(path);
        if (const std::string problem = add_tools_of(tools_in(program), tools); !problem.empty())
          throw py::value_error(problem);
        Diagnostics diagnostics;
        append_program(py::cast<Toolpath&>(path), copy, diagnostics);
        raise_or_warn(diagnostics);
        remember_tools(path, tools);
      },
      py::arg("program"),
      R"(Append the steps of another program.

The ends of both (M2, M30) are left out; spindle, coolants and laser that are on are switched off first. From
a known position the tool rises to the first known height of the program, or stays higher, and moves across
before it goes down.

Parameters
----------
program : Toolpath or Program
    Its toolpath is in work coordinates, mm.

Raises
------
ValueError
    If a tool number has different shapes in the programs that were appended.
kerf.Error
    If the program starts with a cut, or either of them sets a work zero.)");
  c.def(
      "close_path", [](Toolpath& path) { add(path, step::ClosePath{}, "close_path"); },
      "Close the contour in drawings; the tool does not move.");
}

}  // namespace

void remember_tools(const py::handle& path, const std::map<int, Tool>& tools) {
  if (!tools.empty()) path.attr(kToolsOfPath) = tools;
}

Feed positive_feed(double value) {
  if (finite_number(value, "feed") <= 0.0) throw py::value_error("feed must be above 0 mm/min");
  return mm_per_min(number_within(value, 0.0, limits::kMaxSpeed, "feed", "mm/min"));
}

void set_rotary(Toolpath& path, std::size_t motion, const py::object& rotary) {
  if (rotary.is_none()) return;
  const Point3 angles = to_point3(rotary, "rotary");
  MotionExtra extra;
  extra.abc = {angles.x, angles.y, angles.z};
  path.set_extra(motion, std::move(extra));
}

unsigned axes_named(const std::string& letters, const char* argument) {
  unsigned bits = 0;
  for (const char letter : letters) {
    if (letter != 'X' && letter != 'Y' && letter != 'Z')
      throw py::value_error(std::string(argument) + " must name axes, e.g. 'XY', not '" + letters + "'");
    bits |= 1u << static_cast<unsigned>(letter - 'X');
  }
  return bits;
}

void bind_steps(ToolpathClass& c) {
  bind_machine_steps(c);
  bind_printer_steps(c);
  bind_laser_steps(c);
  bind_texts(c);
}

}  // namespace kerf::python

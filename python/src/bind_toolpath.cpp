// The toolpath in Python: adding steps, reading G-code, accessing steps.
#include <algorithm>
#include <array>
#include <cstdio>

#include "base/names.h"
#include "base/number.h"
#include "bind_steps.h"
#include "bindings.h"
#include "job/record/figures.h"
#include "path/bead.h"
#include "path/motion_limits.h"
#include "records.h"
#include "values.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/base/tolerance.h"
#include "kerf/job/program.h"
#include "kerf/job/program_file.h"
#include "kerf/path/check.h"
#include "kerf/path/report.h"
#include "kerf/path/toolpath.h"
#include "kerf/program/gcode.h"
#include "kerf/sim/print.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr double kMaxMotionLimit = 1e9;  // mm/s, mm/s2

Turn to_turn(const std::string& name) {
  if (name == "cw") return Turn::cw;
  if (name == "ccw") return Turn::ccw;
  throw py::value_error("turn must be 'cw' or 'ccw', not '" + name + "'");
}

BeadKind to_bead_kind(const std::string& name) {
  if (const auto kind = bead_kind_named(name)) return *kind;
  throw py::value_error("there is no kind of bead '" + clipped(name, 60) + "'");
}

LimitKind to_limit_kind(const std::string& name) {
  if (const auto kind = limit_named(name)) return *kind;
  throw py::value_error("there is no limit '" + clipped(name, 60) + "'");
}

Plane to_plane(const std::string& name) {
  if (name == "XY") return Plane::xy;
  if (name == "XZ") return Plane::xz;
  if (name == "YZ") return Plane::yz;
  throw py::value_error("plane must be 'XY', 'XZ' or 'YZ', not '" + name + "'");
}

/// Step `i` as its line of `kerf steps`.
py::object step_at(const Toolpath& path, std::size_t i) {
  return to_python(record_of_step(path, i, MotionReader(path, i + 1).context().tool));
}

std::size_t checked_index(const Toolpath& path, py::ssize_t i) {
  const auto size = static_cast<py::ssize_t>(path.size());
  if (i < 0) i += size;
  if (i < 0 || i >= size) throw py::index_error("step index out of range");
  return static_cast<std::size_t>(i);
}

SpindleTurn to_spindle_turn(const std::string& name) {
  if (name == "off") return SpindleTurn::off;
  if (name != "cw" && name != "ccw")
    throw py::value_error("turn must be 'cw', 'ccw' or 'off', not '" + name + "'");
  return to_turn(name) == Turn::cw ? SpindleTurn::cw : SpindleTurn::ccw;
}

/// Raises ValueError for an arc with different radii at its start and end point. Before the first motion the
/// start point is unknown.
void check_radii(const Toolpath& path, const step::Arc& arc) {
  std::size_t i = path.size();
  while (i > 0 && !path[i - 1].is_motion()) --i;
  if (i == 0) return;
  const ArcWalk walk = walk_arc(path[i - 1].to(), arc.to, arc.centre, arc.plane, arc.turn, 0);
  if (ArcMismatch().permits(walk.start_radius, walk.end_radius)) return;
  throw py::value_error("the arc starts " + number_text(walk.start_radius, 4) +
                        " mm from its centre and ends " + number_text(walk.end_radius, 4) + " mm from it");
}

void bind_motions(ToolpathClass& c) {
  c.def(
      "rapid",
      [](Toolpath& path, const py::object& to, const py::object& rotary, const std::string& unknown) {
        const Point3 end = to_point3(to, "to");
        const unsigned axes = axes_named(unknown, "unknown");
        const std::size_t i = path.add(step::Rapid{end}, path.origins().add(script_location("rapid")));
        set_rotary(path, i, rotary);
        if (axes != 0) path.set_unknown_axes(i, axes);
      },
      py::arg("to"), py::kw_only(), py::arg("rotary") = py::none(), py::arg("unknown") = "",
      R"(Append a rapid.

Parameters
----------
to : sequence of 3 float
    End point, mm, work coordinates.
rotary : sequence of 3 float, optional
    Positions of the axes A, B and C at the end, degrees. Default: they do not move.
unknown : str
    Axes that have not been commanded yet: ``'XY'`` for a first motion in Z alone. Their positions in `to` are
    those of a controller without offsets.)");
  c.def(
      "cut",
      [](Toolpath& path, const py::object& to, double feed, const py::object& rotary) {
        const Point3 end = to_point3(to, "to");
        const step::Cut cut{end, positive_feed(feed)};
        set_rotary(path, path.add(cut, path.origins().add(script_location("cut"))), rotary);
      },
      py::arg("to"), py::arg("feed"), py::kw_only(), py::arg("rotary") = py::none(),
      R"(Append a straight cut.

Parameters
----------
to : sequence of 3 float
    End point, mm, work coordinates.
feed : float
    mm/min, above 0.
rotary : sequence of 3 float, optional
    Positions of the axes A, B and C at the end, degrees. Default: they do not move.)");
}

void bind_arc(ToolpathClass& c) {
  c.def(
      "arc",
      [](Toolpath& path, const py::object& to, const py::object& centre, const std::string& turn, double feed,
         const std::string& plane, long long extra_turns) {
        step::Arc arc;
        arc.to = to_point3(to, "to");
        arc.centre = to_point2(centre, "centre");
        arc.turn = to_turn(turn);
        arc.plane = to_plane(plane);
        arc.feed = positive_feed(feed);
        arc.extra_turns = whole_within(extra_turns, 0, limits::kMaxTurns, "extra_turns");
        check_radii(path, arc);
        path.add(arc, path.origins().add(script_location("arc")));
      },
      py::arg("to"), py::arg("centre"), py::arg("turn"), py::arg("feed"), py::arg("plane") = "XY",
      py::arg("extra_turns") = 0,
      R"(Append an arc, or a helix if the third axis moves.

Parameters
----------
to : sequence of 3 float
    End point, mm, work coordinates. Equal to the start point in the plane: a full circle.
centre : sequence of 2 float
    Centre, mm, work coordinates, in the order of the plane's name.
turn : {'cw', 'ccw'}
    Direction seen from the positive third axis (G2 is 'cw').
feed : float
    mm/min, above 0.
plane : {'XY', 'XZ', 'YZ'}
extra_turns : int
    Full turns in addition to the arc.

Raises
------
ValueError
    If the radii at start and end point differ.)");
}

/// The volume of a bead of the given width and height from the last position of the path, mm3.
double volume_of_bead(const Toolpath& path, Point3 to, double width, double height) {
  std::size_t i = path.size();
  while (i > 0 && !path[i - 1].is_motion()) --i;
  if (i == 0) throw py::value_error("without a volume, a motion to the start point of the bead is required");
  if (!(height > 0.0 && width >= height))
    throw py::value_error("without a volume, width and height are required, and width >= height");
  return bead_volume(mm(distance(path[i - 1].to().xy(), to.xy())), mm(width), mm(height)).mm3();
}

void bind_extrude(ToolpathClass& c) {
  c.def(
      "extrude",
      [](Toolpath& path, const py::object& to, double feed, const std::optional<double>& volume, double width,
         double height, const std::string& kind) {
        step::Extrude bead;
        bead.kind = to_bead_kind(kind);
        bead.to = to_point3(to, "to");
        bead.feed = positive_feed(feed);
        bead.width = mm(number_within(width, 0.0, limits::kMaxBeadWidth, "width", "mm"));
        bead.height = mm(number_within(height, 0.0, limits::kMaxBeadWidth, "height", "mm"));
        bead.volume = mm3(volume ? number_within(*volume, -limits::kMaxExtrudedVolume,
                                                 limits::kMaxExtrudedVolume, "volume", "mm3")
                                 : volume_of_bead(path, bead.to, width, height));
        path.add(bead, path.origins().add(script_location("extrude")));
      },
      py::arg("to"), py::arg("feed"), py::arg("volume") = py::none(), py::arg("width") = 0.0,
      py::arg("height") = 0.0, py::arg("kind") = "",
      R"(Append an extruding motion, which lays a bead whose top is at the height of the nozzle.

Parameters
----------
to : sequence of 3 float
    End point, mm, work coordinates.
feed : float
    mm/min, above 0.
volume : float, optional
    Volume of the whole bead, mm3; below 0 retracts filament. Default: from `width` and `height`.
width, height : float
    Width of the bead, mm; 0: from the volume and the step in Z, see `simulate_print`.
kind : str
    What the bead is part of: 'skirt', 'outer_wall', 'wall', 'overhang', 'infill', 'solid_infill', 'top',
    'bridge', 'gap_fill', 'ironing', 'support', 'support_interface', 'purge', 'custom'.

Raises
------
ValueError
    If neither a volume nor a valid width and height are given, or the kind is unknown.)");
}

void bind_motion_limits(ToolpathClass& c) {
  c.def(
      "motion_limits",
      [](Toolpath& path, const std::string& limit, const py::kwargs& values) {
        step::MotionLimits limits;
        limits.kind = to_limit_kind(limit);
        const auto& names = value_names(limits.kind);
        for (const auto& [key, value] : values) {
          const auto it = std::find(names.begin(), names.end(), py::cast<std::string>(key));
          if (it == names.end() || it->empty())
            throw py::value_error(limit + " has no value \"" + py::cast<std::string>(key) + "\"");
          const auto k = static_cast<std::size_t>(it - names.begin());
          limits.values[k] = number_within(py::cast<double>(value), 0.0, kMaxMotionLimit,
                                           py::cast<std::string>(key).c_str(), "mm");
          limits.given |= 1u << k;
        }
        if (limits.given == 0) throw py::value_error("no value is given");
        path.add(limits, path.origins().add(script_location("motion_limits")));
      },
      py::arg("limit"),
      R"(Set limits with which a printer's firmware plans the motions that follow.

Parameters
----------
limit : str
    'axis_acceleration' (x, y, z, e, mm/s2), 'axis_speed' (x, y, z, e, mm/s), 'acceleration' (beads,
    retractions, travel, mm/s2), 'jerk' (x, y, z, e, mm/s), 'junction_deviation' (value, mm) or
    'corner_speed' (value, mm/s).
**values : float
    The values by these names, from 0; those that are not given stay.

Raises
------
ValueError
    For an unknown limit, an unknown or missing value, or one that is negative or not finite.)");
}

void bind_other_steps(ToolpathClass& c) {
  c.def(
      "tool",
      [](Toolpath& path, long long number) {
        path.add(step::ToolChange{whole_within(number, 0, limits::kMaxToolNumber, "number")},
                 path.origins().add(script_location("tool")));
      },
      py::arg("number"), R"(Append a change to the tool with a number.

Parameters
----------
number : int
    Tool number.)");
  c.def(
      "spindle",
      [](Toolpath& path, double rpm_value, const std::string& turn) {
        number_within(rpm_value, 0.0, limits::kMaxSpeed, "rpm", "rpm");
        const SpindleTurn sense = to_spindle_turn(turn);
        path.add(step::Spindle{rpm(rpm_value), sense}, path.origins().add(script_location("spindle")));
      },
      py::arg("rpm"), py::arg("turn") = "cw", R"(Start or stop the spindle.

Parameters
----------
rpm : float
    Speed.
turn : {'cw', 'ccw', 'off'}
    Direction; 'off' stops it.)");
  c.def(
      "dwell",
      [](Toolpath& path, double value) {
        number_within(value, 0.0, limits::kMaxDwellSeconds, "seconds", "s");
        path.add(step::Dwell{seconds(value)}, path.origins().add(script_location("dwell")));
      },
      py::arg("seconds"), R"(Append a dwell.

Parameters
----------
seconds : float
    Duration, s.)");
  c.def(
      "note",
      [](Toolpath& path, const std::string& text) {
        path.add(step::Note{text}, path.origins().add(script_location("note")));
      },
      py::arg("text"), R"(Append a note, which posts write as a comment.

Parameters
----------
text : str
    One line.)");
}

Toolpath read(const std::string& text, const std::string& name, const std::optional<double>& filament) {
  Diagnostics diagnostics;
  GcodeReadOptions options;
  options.file_name = name;
  if (filament)
    options.filament_diameter =
        number_within(*filament, limits::kThinnestFilament, limits::kThickestFilament, "filament", "mm");
  SignalProgress progress;
  GcodeProgram program;
  {
    const py::gil_scoped_release release;
    program = read_gcode(text, options, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  return std::move(program.path);
}

Toolpath slice_of(const Toolpath& path, const py::slice& range) {
  py::ssize_t start = 0, stop = 0, stride = 0, count = 0;
  if (!range.compute(static_cast<py::ssize_t>(path.size()), &start, &stop, &stride, &count))
    throw py::error_already_set();
  if (stride != 1)
    throw py::value_error("a slice of a toolpath has no stride: its motions would start elsewhere");
  Toolpath part;
  for (py::ssize_t i = start; i < start + count; ++i) part.add_copy(path, static_cast<std::size_t>(i));
  return part;
}

Toolpath joined_steps(const Toolpath& first, const Toolpath& second) {
  Toolpath both = first;
  for (std::size_t i = 0; i < second.size(); ++i) both.add_copy(second, i);
  return both;
}

/// Steps by index, slices, sums, and the columns.
void bind_sequence(ToolpathClass& c) {
  c.def(
      "__getitem__",
      [](const Toolpath& path, py::ssize_t i) { return step_at(path, checked_index(path, i)); },
      py::arg("index"), "dict: one step, with the fields of `kerf steps`; a slice is a Toolpath.");
  c.def("__getitem__", &slice_of, py::arg("index"));
  c.def("__add__", &joined_steps, py::arg("other"), py::is_operator(),
        "The steps of both as they are. `append` adds a safe way across.");
  c.def("columns", &columns_of, R"(The steps as columns, for NumPy and pandas.

Returns
-------
structured ndarray
    A row per step: `step` (its name), `x`, `y`, `z` (the end of a motion, mm; nan where there is
    none or it is unknown), `feed` (mm/min; nan without one), `tool` (-1 before the first change), `line` (of
    the script or the file; 0 without one). A copy: changes of it do not change the toolpath.)");
  c.def(
      "__array__",
      [](const Toolpath& path, const py::object& dtype, const py::object&) -> py::object {
        const py::object columns = columns_of(path);
        return dtype.is_none() ? columns : py::object(columns.attr("astype")(dtype));
      },
      py::arg("dtype") = py::none(), py::arg("copy") = py::none());
}

py::object report_of(const Toolpath& path) { return to_python(record_of(report_on(path, {}).all)); }

}  // namespace

constexpr const char* kToolpath = R"(A list of steps: motions, tool changes, spindle commands and others.

Positions are complete and absolute, in mm and work coordinates (Z up). Nothing is modal. Every step stores
the line of the script that added it; hazards of `simulate` and `check` refer to it.

Parameters
----------
program : Program, optional
    Whose toolpath is copied. Default: no steps.

Examples
--------
>>> path = kerf.Toolpath()
>>> path.tool(102); path.spindle(16000)
>>> path.rapid((0, 0, 5)); path.cut((0, 0, -1), feed=100); path.cut((50, 0, -1), feed=400))";

constexpr const char* kReadGcode = R"(Read G-code.

Parameters
----------
text : str
    A complete program (RS274).
name : str
    File name for messages.
filament : float, optional
    Diameter of a printer's filament, mm. Default: from the program's comments, else 1.75.

Returns
-------
Toolpath
    The toolpath itself.

Raises
------
kerf.Error
    If the text has errors; all of them are in its `diagnostics`. Warnings are issued by the module
    `warnings`.

Examples
--------
>>> path = kerf.read_gcode("G21 G90 T102 M6 M3 S9000\nG0 X0 Y0 Z5\nG1 Z-1 F100\nM2\n")
>>> len(path), path[3]["step"]
(6, 'cut'))";

void bind_toolpath(py::module_& m) {
  ToolpathClass c(m, "Toolpath", py::dynamic_attr(), kToolpath);
  c.def(py::init<>());
  c.def(
      "__init__",
      [](py::detail::value_and_holder& made, const Program& program) {
        made.value_ptr() = new Toolpath(program.path);
        remember_tools(reinterpret_cast<PyObject*>(made.inst), program.tools);
      },
      py::detail::is_new_style_constructor(), py::arg("program"), "The toolpath of a program.");
  py::implicitly_convertible<Program, Toolpath>();
  bind_motions(c);
  bind_arc(c);
  bind_extrude(c);
  bind_motion_limits(c);
  bind_other_steps(c);
  bind_steps(c);
  bind_copy(c);
  bind_stored(c, write_toolpath, read_toolpath, &steps_as_bytes);
  c.def("__repr__",
        [](const Toolpath& path) { return "<kerf.Toolpath of " + std::to_string(path.size()) + " steps>"; });
  c.def("__len__", &Toolpath::size, "Number of steps.");
  bind_sequence(c);
  c.def("report", &report_of, R"(Figures of the motions.

Returns
-------
dict
    `lines`, `arcs`, `rapids` (numbers); `cut_mm`, `rapid_mm` (lengths); `cut_bounds_mm` (low corner, high
    corner, of the ends of feed moves and of arcs), `cut_extent_mm` (their starts included), None without
    cuts.)");
  m.def("read_gcode", &read, py::arg("text"), py::arg("name") = "<text>", py::arg("filament") = py::none(),
        kReadGcode);
}

}  // namespace kerf::python

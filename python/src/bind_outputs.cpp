// The results of a simulation in Python: meshes, pictures and left-over stock as bytes and as files.
#include <algorithm>
#include <cmath>

#include "bindings.h"
#include "codec/drawing/colour_names.h"
#include "job/record/figures.h"
#include "program_arguments.h"
#include "records.h"
#include "simulation_result.h"
#include "values.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/job/program_file.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr const char* kSave = R"(Write the part to files: all of them, or none if one fails.

Parameters
----------
*paths : str or os.PathLike
    Meshes (.stl .3mf .glb .obj), pictures (.png), left-over stock (.kstock).
view : str or (float, float)
    As in `picture`.
size : (int, int)
    As in `picture`.
section : str, optional
    As in `picture`.
detail : {'exact', 'columns'}, optional
    As in `mesh_file`. Default: exact for meshes, and for pictures whose pixels are smaller than the columns.
grooves : bool
    As in `picture`.
colour : {'tool', 'kind', 'layer', 'speed', 'flow', 'temperature'}
    As in `picture`.
motion_colours : list of (int, str, str, str)
    Rows (first step, cut, rapid, shaft): the colours, as in CSS, of what the steps from a number on cut, of
    what their rapids cut, and of what is touched above the flute. Steps before the first row have the colour
    of their tool.
mesh_tolerance : float, optional
    Distance of the triangles from the part's surfaces, mm; None: 0.002, more if a coarse resolution was asked
    for. Edges between cuts that lie closer than the columns may be farther off.
marks : sequence of {'axes', 'size', 'legend'}
    As in `picture`.

Raises
------
ValueError
    If a path has another ending.
OSError
    If a file cannot be written.
kerf.Error
    If a mesh is invalid, or the section does not intersect the part.)";

constexpr int kMinPixels = 16;  // width and height of a picture

}  // namespace

View to_view(const py::object& view, const py::object& size, const std::optional<std::string>& section) {
  View out;
  if (py::isinstance<py::str>(view)) {
    const auto named = named_view(py::cast<std::string>(view));
    if (!named)
      throw py::value_error(
          "view must be 'top', 'bottom', 'front', 'back', 'left', 'right', 'iso' or (azimuth, "
          "elevation) in degrees");
    out = *named;
  } else {
    const Point2 angles = to_point2(view, "view");
    out.azimuth = degrees(number_within(angles.x, -360.0, 360.0, "the azimuth of view", "degrees"));
    out.elevation = degrees(number_within(angles.y, -90.0, 90.0, "the elevation of view", "degrees"));
  }
  const Point2 pixels = to_point2(size, "size");
  out.width = static_cast<int>(
      number_within(pixels.x, kMinPixels, limits::kMaxPictureSide, "the width of size", "pixels"));
  out.height = static_cast<int>(
      number_within(pixels.y, kMinPixels, limits::kMaxPictureSide, "the height of size", "pixels"));
  if (section) {
    out.section = parse_section(*section);
    if (!out.section) throw py::value_error("section must be a plane such as 'x=25', 'y=-3.5' or 'z=1in'");
    if (!faces(out, *out.section)) throw py::value_error("the view is parallel to the section");
  }
  return out;
}

namespace {

PictureMarks to_marks(const py::object& names) {
  PictureMarks marks;
  if (py::isinstance<py::str>(names))
    throw py::type_error("marks must be a sequence such as ('axes', 'size')");
  for (const py::handle item : names) {
    const auto name = py::cast<std::string>(item);
    const auto mark = std::find_if(kPictureMarks.begin(), kPictureMarks.end(),
                                   [&](const auto& m) { return m.name == name; });
    if (mark == kPictureMarks.end())
      throw py::value_error("marks must be 'axes', 'size' or 'legend', not '" + name + "'");
    marks.*mark->member = true;
  }
  return marks;
}

SurfaceDetail to_detail(const std::string& name) {
  if (name == "exact") return SurfaceDetail::exact;
  if (name == "columns") return SurfaceDetail::columns;
  throw py::value_error("detail must be 'exact' or 'columns', not '" + name + "'");
}

BeadColours to_colour(const std::string& name) {
  if (const auto colours = bead_colours_named(name)) return *colours;
  throw py::value_error("colour must be 'tool', 'kind', 'layer', 'speed', 'flow' or 'temperature', not '" +
                        name + "'");
}

std::optional<Length> to_tolerance(std::optional<double> given) {
  if (!given) return std::nullopt;
  if (!(*given > 0.0) || !std::isfinite(*given))
    throw py::value_error("mesh_tolerance must be a length above 0 mm");
  return mm(*given);
}

SurfaceOptions surface_options(SurfaceDetail detail, bool grooves, const std::string& colour) {
  SurfaceOptions options;
  options.detail = detail;
  options.grooves = grooves ? Grooves::kept : Grooves::closed;
  options.beads = to_colour(colour);
  return options;
}

MeshFormat to_format(const std::string& name) {
  const auto format = mesh_format_of("." + name);
  if (!format) throw py::value_error("format must be 'stl', '3mf', 'glb' or 'obj', not '" + name + "'");
  return *format;
}

std::array<std::uint8_t, 3> to_rgb(const py::handle& colour) {
  const auto text = py::cast<std::string>(colour);
  if (const auto read = svg::read_colour(text)) return read->rgb;
  throw py::value_error("'" + text + "' is no colour: a CSS name or #rrggbb is expected");
}

/// (first step, cut, rapid, shaft) of each change.
std::vector<MotionColours> to_motion_colours(const py::object& rows) {
  std::vector<MotionColours> made;
  for (const py::handle row : rows) {
    const auto parts = py::cast<py::tuple>(row);
    made.push_back({py::cast<std::size_t>(parts[0]), to_rgb(parts[1]), to_rgb(parts[2]), to_rgb(parts[3])});
  }
  return made;
}

/// Makes the surface and passes it to `write`, without the GIL.
template <class Write>
std::string bytes_of(const JobResult& result, const SurfaceOptions& options, Write write) {
  Diagnostics diagnostics;
  SignalProgress progress;
  std::optional<std::string> bytes;
  {
    const py::gil_scoped_release release;
    const auto surface = make_surface(*result.job, *result.run, options, diagnostics, &progress);
    if (surface) bytes = write(*surface, diagnostics);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  return std::move(*bytes);
}

py::bytes mesh_file_of(const JobResult& result, const std::string& format, const std::string& name,
                       const std::string& detail, bool grooves, const std::string& colour,
                       std::optional<double> mesh_tolerance) {
  const MeshFormat kind = to_format(format);
  SurfaceOptions options = surface_options(to_detail(detail), grooves, colour);
  if (const auto asked = to_tolerance(mesh_tolerance)) options.tolerance = fitted_tolerance(*asked);
  return bytes_of(result, options, [&](const PartSurface& surface, Diagnostics& diagnostics) {
    return mesh_file(surface, kind, name, diagnostics);
  });
}

py::bytes picture_of(const JobResult& result, const py::object& view, const py::object& size,
                     const std::optional<std::string>& section, bool grooves, const std::string& colour,
                     const py::object& marks) {
  View how = to_view(view, size, section);
  how.marks = to_marks(marks);
  const SurfaceOptions options = surface_options(SurfaceDetail::exact, grooves, colour);
  return bytes_of(result, options, [&](const PartSurface& surface, Diagnostics& diagnostics) {
    return picture_file(surface, how, diagnostics);
  });
}

void save(const JobResult& result, const py::args& paths, const py::object& view, const py::object& size,
          const std::optional<std::string>& section, const std::optional<std::string>& detail, bool grooves,
          const std::string& colour, const py::object& motion_colours, std::optional<double> mesh_tolerance,
          const py::object& marks) {
  std::vector<PartFile> files;
  for (const py::handle item : paths) {
    const auto path = to_file_name(item);
    const auto file = part_file(path);
    if (!file)
      throw py::value_error("'" + path + "' must end in .stl, .3mf, .glb, .obj, .png, .kstock or .kerf");
    files.push_back(*file);
  }
  PartFileOptions options{.view = to_view(view, size, section),
                          .grooves = grooves ? Grooves::kept : Grooves::closed,
                          .tolerance = to_tolerance(mesh_tolerance),
                          .beads = to_colour(colour),
                          .motions = to_motion_colours(motion_colours)};
  options.view.marks = to_marks(marks);
  if (detail) options.detail = to_detail(*detail);
  Diagnostics diagnostics;
  SignalProgress progress;
  {
    const py::gil_scoped_release release;
    OutputSet set(result.job->program.files);
    if (write_part(files, *result.job, *result.run, options, set, diagnostics, &progress))
      set.commit(diagnostics);
  }
  progress.rethrow();
  raise_os_error_or_warn(diagnostics);
}

constexpr const char* kMeshFile =
    R"(The surface of the part as a mesh file, coloured by tool if the format has colours.

Parameters
----------
format : {'stl', '3mf', 'glb', 'obj'}
name : str
    Name of the mesh, for formats that store one.
detail : {'exact', 'columns'}
    'exact': the surfaces of the tools, to a few microns. 'columns': interpolated between the columns, in a
    fraction of the time, for viewers.
grooves : bool
    Keep the grooves between beads of a print.
colour : {'tool', 'kind', 'layer', 'speed', 'flow', 'temperature'}
    What colours the beads of a print; 'tool' is one colour.
mesh_tolerance : float, optional
    Distance of the triangles from the part's surfaces, mm; None: 0.002, more if a coarse resolution was asked
    for. Edges between cuts that lie closer than the columns may be farther off.

Returns
-------
bytes
    In mm, work coordinates.

Raises
------
kerf.Error
    If the mesh is invalid: not closed, or of a wrong volume.)";

/// The toolpath over its stock, without cutting.
py::bytes path_picture_of(const py::object& program, const py::object& tools, const py::object& stock,
                          const py::object& view, const py::object& size, const py::object& marks) {
  View how = to_view(view, size, std::nullopt);
  how.marks = to_marks(marks);
  const JobSettings settings = to_settings(tools, stock, {});
  Diagnostics diagnostics;
  const Job job = make_job_or_print(to_program(program), settings, UnknownTool::assume, diagnostics);
  raise_or_warn(diagnostics);
  std::string bytes;
  {
    const py::gil_scoped_release release;
    bytes = path_picture(job, how);
  }
  return py::bytes(bytes);
}

void bind_result(py::module_& m, const py::tuple& view, const py::tuple& size) {
  py::class_<JobResult> c(m, "JobResult", R"(The base of all kinds of simulation: meshes, pictures and files.

Examples
--------
>>> part = kerf.simulate(kerf.load("part.nc"), "20x20x5")
>>> isinstance(part, kerf.JobResult), part.picture(view="front")[1:4]
(True, b'PNG'))");
  refuse_copies(c,
                "a simulation cannot be copied or pickled: it holds the whole workpiece; save it by "
                "kerf.save_left_stock, or copy its program and stock and simulate them again");
  c.def("_program_file", [](const JobResult& r) { return py::bytes(write_program(program_of(*r.job))); });
  c.def_property_readonly(
       "findings", [](const JobResult& r) { return to_python(record_of(r.run->findings)); },
       "list of dict: hazards and contacts with fixtures, in the order of steps, with `message` and "
       "`hint`; "
       "other fields as of `check`.")
      .def("mesh_file", &mesh_file_of, py::arg("format"), py::kw_only(), py::arg("name") = "part",
           py::arg("detail") = "exact", py::arg("grooves") = false, py::arg("colour") = "tool",
           py::arg("mesh_tolerance") = py::none(), kMeshFile)
      .def("picture", &picture_of, py::kw_only(), py::arg("view") = view, py::arg("size") = size,
           py::arg("section") = py::none(), py::arg("grooves") = false, py::arg("colour") = "tool",
           py::arg("marks") = py::tuple(),
           R"(A picture of the part, coloured by tool; surfaces made by hazards are red.

Parameters
----------
view : str or (float, float)
    'top', 'bottom', 'front', 'back', 'left', 'right', 'iso', or azimuth and elevation in degrees.
size : (int, int)
    Width and height in pixels, 16 to 8192.
section : str, optional
    A plane such as ``'x=25'`` (mm); the viewer's side of it is removed.
grooves : bool
    Keep the grooves between beads of a print.
colour : {'tool', 'kind', 'layer', 'speed', 'flow', 'temperature'}
    What colours the beads of a print; 'tool' is one colour.
marks : sequence of {'axes', 'size', 'legend'}
    Drawn over the picture: the axes from the work zero, lengths in mm, the meaning of the colours.

Returns
-------
bytes
    A PNG.

Raises
------
kerf.Error
    If the section does not intersect the part.)")
      .def("save", &save, py::kw_only(), py::arg("view") = view, py::arg("size") = size,
           py::arg("section") = py::none(), py::arg("detail") = py::none(), py::arg("grooves") = false,
           py::arg("colour") = "tool", py::arg("motion_colours") = py::tuple(),
           py::arg("mesh_tolerance") = py::none(), py::arg("marks") = py::tuple(), kSave);
}

}  // namespace

void bind_outputs(py::module_& m) {
  const py::tuple view = py::make_tuple(-35.0, 50.0), size = py::make_tuple(1600, 1000);
  bind_result(m, view, size);
  m.def("path_picture", &path_picture_of, py::arg("program"), py::kw_only(), py::arg("tools") = py::none(),
        py::arg("stock") = py::none(), py::arg("view") = view, py::arg("size") = size,
        py::arg("marks") = py::tuple(),
        R"(A picture of a toolpath over its stock as it was before the first cut.

Cuts have the colours of the tools, rapids are thin lines; a laser's cuts are shaded by their power. Motions
at unknown positions are omitted.

Parameters
----------
program : Program or Toolpath
    Whose motions are drawn.
tools : Tool, str, ToolTable or list of them, optional
    As of `check`.
stock : Stock, str or sequence of 3 float, optional
    As of `check`.
view : str or (float, float)
    As of `JobResult.picture`.
size : (int, int)
    As of `JobResult.picture`.
marks : sequence of {'axes', 'size', 'legend'}
    As of `JobResult.picture`.

Returns
-------
bytes
    A PNG.

Examples
--------
>>> png = kerf.path_picture(kerf.load("part.nc"), stock="20x20x5", view="top", size=(400, 300)))");
}

}  // namespace kerf::python

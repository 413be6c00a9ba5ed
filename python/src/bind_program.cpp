// Programs in Python: reading them from files, and writing them for controllers or as drawings.
#include <algorithm>

#include "base/names.h"
#include "bind_steps.h"
#include "bindings.h"
#include "front/gcmc/gcmc.h"
#include "program_arguments.h"
#include "values.h"

#include "kerf/base/limits.h"
#include "kerf/job/posting.h"
#include "kerf/job/program.h"
#include "kerf/job/program_file.h"
#include "kerf/path/passes.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr double kSmallestFit = 1e-6, kLargestFit = 1.0;  // mm, tolerances of the passes

std::optional<GcodeDialect> to_dialect(const std::optional<std::string>& name) {
  if (!name) return std::nullopt;
  const auto dialect = dialect_named(*name);
  if (!dialect)
    throw py::value_error("unknown dialect '" + *name + "'; known: " + joined(dialect_names(), ", "));
  return dialect;
}

ArcCentres to_arc_centres(const std::optional<std::string>& name) {
  if (!name) return ArcCentres::detect;
  if (const auto named = arc_centres_named(*name)) return *named;
  throw py::value_error("arc_centres must be 'offsets' or 'absolute', not '" + *name + "'");
}

Program load(const std::string& path, const std::optional<std::string>& dialect,
             const std::optional<std::string>& arc_centres, std::map<int, double> comp, bool read_on,
             bool strict, const std::optional<double>& filament, std::vector<std::string> defines,
             std::vector<std::string> include_paths, const std::string& compat, const py::object& tools,
             const py::object& machine, const std::string& measured, double max_correction,
             const py::object& work_offset, const py::object& drawing) {
  ProgramOptions options;
  options.dialect = to_dialect(dialect);
  options.arc_centres = to_arc_centres(arc_centres);
  options.compensation_radii = std::move(comp);
  options.read_on = read_on;
  options.strict = strict;
  if (filament)
    options.filament_diameter =
        number_within(*filament, limits::kThinnestFilament, limits::kThickestFilament, "filament", "mm");
  options.defines = std::move(defines);
  options.include_paths = std::move(include_paths);
  check_compat(compat);
  options.gcmc_version = compat;
  options.tool_diameter = diameters_of(to_tool_choices(tools));
  options.machine = to_machine(machine);
  options.measured = {measured, to_max_correction(max_correction), to_measured_options(work_offset)};
  if (!drawing.is_none()) {
    options.drawing = to_drawing_options(py::cast<py::dict>(drawing));
    options.drawing.given = {"drawing"};
  }
  Diagnostics diagnostics;
  SignalProgress progress;
  std::optional<Program> program;
  {
    const py::gil_scoped_release release;
    program = load_program(path, options, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  return std::move(*program);
}

PostTarget to_target(const std::string& name) {
  if (name.find('.') != std::string::npos) {
    Diagnostics diagnostics;
    const auto target = load_post_target(name, diagnostics);
    raise_or_warn(diagnostics);
    return *target;
  }
  const auto target = find_post_target(name);
  if (!target)
    throw py::value_error("unknown post '" + name + "'; known: " + joined(post_target_names(), ", ") +
                          ", or the path of a post file (.toml)");
  return *target;
}

PostTarget to_printer_target(const std::string& name) {
  const auto printer = to_printer(name);
  Diagnostics diagnostics;
  const auto target = printer_post_target(*printer, diagnostics);
  raise_or_warn(diagnostics);
  return *target;
}

std::optional<LengthUnit> to_unit(const std::optional<std::string>& name) {
  if (!name) return std::nullopt;
  if (*name == "mm") return LengthUnit::mm;
  if (*name == "inch") return LengthUnit::inch;
  throw py::value_error("unit must be 'mm' or 'inch', not '" + *name + "'");
}

Length to_tolerance(double value, const char* argument) {
  return value == 0.0 ? Length() : mm(number_within(value, kSmallestFit, kLargestFit, argument, "mm"));
}

/// The texts of a program for a target, each with the name of its file.
py::list post_texts(const py::object& value, const std::string& to, const std::string& file_name,
                    const std::optional<std::string>& unit, const std::optional<std::string>& tool_change,
                    double feed, bool allow_left_out, const py::object& tools, double fit_arcs, double join,
                    bool shorten_rapids, bool rapids, const std::string& dxf_version,
                    const std::map<std::string, std::string>& variables,
                    const std::vector<std::pair<int, int>>& thumbnails,
                    const std::optional<std::string>& printer) {
  Program program = to_program(value);
  const PostTarget target = printer ? to_printer_target(*printer) : to_target(to);
  PostingOptions options;
  options.unit = to_unit(unit);
  if (tool_change) {
    options.tool_change = tool_change_policy_named(*tool_change);
    if (!options.tool_change)
      throw py::value_error("tool_change must be 'command', 'pause', 'files' or 'ignore'");
  }
  options.missing_feed = mm_per_min(number_within(feed, 0.0, limits::kMaxSpeed, "feed", "mm/min"));
  if (allow_left_out) options.left_out = LeftOutCodes::skipped;
  options.rapids = rapids ? RapidLines::drawn : RapidLines::left_out;
  const auto version = dxf_version_named(dxf_version);
  if (!version) throw py::value_error("dxf_version must be 'r2000' or 'r12', not '" + dxf_version + "'");
  options.dxf_version = *version;
  options.variables = variables;
  for (const auto& [width, height] : thumbnails)
    options.thumbnails.push_back({whole_within(width, 1, kMaxThumbnailSide, "width"),
                                  whole_within(height, 1, kMaxThumbnailSide, "height")});
  options.tools = used_tools(program, to_tool_choices(tools));
  options.start_tool = start_tool(program, to_tool_choices(tools));
  if (target.is_program) keep_tools(program, to_tool_choices(tools));
  const PassChoices passes{to_tolerance(fit_arcs, "fit_arcs"), to_tolerance(join, "join"), shorten_rapids};
  Diagnostics diagnostics;
  SignalProgress progress;
  std::vector<PostedFile> files;
  {
    const py::gil_scoped_release release;
    improve(program.path, passes);
    files = post_program(program, target, options, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  const std::vector<std::string> names = posted_file_names(file_name, files);
  py::list texts;
  for (std::size_t i = 0; i < files.size(); ++i)
    texts.append(py::make_tuple(py::reinterpret_steal<py::object>(PyUnicode_DecodeFSDefaultAndSize(
                                    names[i].data(), static_cast<py::ssize_t>(names[i].size()))),
                                py::bytes(files[i].text)));
  return texts;
}

/// A copy of the toolpath with lines passed on unchanged before some of its steps: (step, lines) in the order
/// of the steps; the number of steps is the end of the toolpath.
Program with_lines(const py::object& value,
                   const std::vector<std::pair<std::size_t, std::vector<std::string>>>& added) {
  Program program = to_program(value);
  const Toolpath& path = program.path;
  Toolpath out;
  auto next = added.begin();
  for (std::size_t i = 0; i <= path.size(); ++i) {
    for (; next != added.end() && next->first == i; ++next) {
      for (const std::string& line : next->second) {
        if (line.find_first_of("\r\n") != std::string::npos)
          throw py::value_error("a hook must return a list of lines, each without a line break");
        out.add(step::Verbatim{line}, out.origins().add(script_location("post")));
      }
    }
    if (i < path.size()) out.add_copy(path, i);
  }
  program.path = std::move(out);
  return program;
}

/// A program with the arguments of its simulation. `bar`: diameter, both ends, Y and Z of the axis.
Program program_with(const py::object& value, const py::object& stock, const py::object& tools,
                     const std::vector<std::pair<std::string, Stock>>& fixtures, double spoilboard,
                     const std::optional<std::vector<double>>& bar) {
  Program program = to_program(value);
  const JobSettings settings = to_settings(tools, stock, fixtures);
  keep_tools(program, settings.tools);
  if (settings.stock) program.stock = settings.stock;
  if (bar) program.bar = RoundBar{bar->at(0), bar->at(1), bar->at(2), bar->at(3), bar->at(4)};
  if (!settings.fixtures.empty()) program.fixtures = settings.fixtures;
  if (spoilboard > 0.0) program.spoilboard = to_spoilboard(spoilboard);
  return program;
}

/// Writes it as a .kerf file.
void write_program_file(const std::string& file, const py::object& value, const py::object& stock,
                        const py::object& tools, const std::vector<std::pair<std::string, Stock>>& fixtures,
                        double spoilboard, const std::optional<std::vector<double>>& bar) {
  const Program program = program_with(value, stock, tools, fixtures, spoilboard, bar);
  OutputSet set;
  Diagnostics diagnostics;
  if (set.write(file, write_program(program), diagnostics)) set.commit(diagnostics);
  raise_os_error_or_warn(diagnostics);
}

/// Programs are equal if all but the origins of their steps is.
std::string as_compared(const Program& program) {
  Program bare = program;
  bare.path = without_origins(program.path);
  return write_program(bare);
}

py::object path_of(const py::object& program) {
  auto& made = py::cast<Program&>(program);
  py::object path = py::cast(&made.path, py::return_value_policy::reference_internal, program);
  if (!py::hasattr(path, kToolsOfPath)) remember_tools(path, made.tools);
  return path;
}

void bind_program_class(py::module_& m) {
  py::class_<Program> c(m, "Program", R"(A toolpath with the units, tools and stock specified in its file.

Made by `load`. Functions with a Toolpath argument accept a Program.

Examples
--------
>>> program = kerf.load("part.nc")
>>> program.front_end, program.units, len(program)
('G-code', 'mm', 7))");
  bind_copy(c);
  bind_stored(c, write_program, read_program, &as_compared);
  c.def("__repr__",
        [](const Program& p) {
          return to_str("<kerf.Program " + p.source + ": " + p.front_end + ", " +
                        std::to_string(p.path.size()) + " steps>");
        })
      .def(
          "__len__", [](const Program& p) { return p.path.size(); }, "Number of steps.")
      .def_property_readonly("toolpath", &path_of, "Toolpath: its steps.")
      .def_property_readonly(
          "source", [](const Program& p) { return to_str(p.source); }, "str: the file's name as given.")
      .def_readonly("front_end", &Program::front_end,
                    "str: the front end that has read it, 'G-code' or 'gcmc'.")
      .def_property_readonly(
          "units", [](const Program& p) { return p.units == ProgramUnits::inch ? "inch" : "mm"; },
          "str: 'mm' or 'inch', of the file; the toolpath is in mm.")
      .def_readonly("tools", &Program::tools, "dict of int to Tool: tools described in the program.")
      .def_readonly("stock", &Program::stock, "Stock or None: if described in the program.")
      .def_property_readonly(
          "files",
          [](const Program& p) {
            py::list files;
            for (const std::string& file : p.files) files.append(to_str(file));
            return files;
          },
          "list of str: all files read; first the program, then included and called files.");
}

}  // namespace

void check_compat(const std::string& compat) {
  if (!compat.empty() && !gcmc_version_named(compat))
    throw py::value_error("compat must be '1.8' or '1.9', not '" + compat + "'");
}

void bind_program(py::module_& m) {
  bind_program_class(m);
  m.def("_load", &load, py::arg("path"), py::kw_only(), py::arg("dialect"), py::arg("arc_centres"),
        py::arg("comp"), py::arg("read_on"), py::arg("strict"), py::arg("filament"), py::arg("defines"),
        py::arg("include_paths"), py::arg("compat"), py::arg("tools"), py::arg("machine"),
        py::arg("measured"), py::arg("max_correction"), py::arg("work_offset"), py::arg("drawing"));
  m.def("_post", &post_texts, py::arg("program"), py::arg("to"), py::arg("name"), py::kw_only(),
        py::arg("unit"), py::arg("tool_change"), py::arg("feed"), py::arg("allow_left_out"), py::arg("tools"),
        py::arg("fit_arcs"), py::arg("join"), py::arg("shorten_rapids"), py::arg("rapids"),
        py::arg("dxf_version"), py::arg("variables"), py::arg("thumbnails"), py::arg("printer") = py::none());
  m.def("_program_with", &program_with, py::arg("program"), py::arg("stock") = py::none(),
        py::arg("tools") = py::none(), py::arg("fixtures") = py::tuple(), py::arg("spoilboard") = 0.0,
        py::arg("bar") = py::none());
  m.def("_write_program_file", &write_program_file, py::arg("file"), py::arg("program"),
        py::arg("stock") = py::none(), py::arg("tools") = py::none(), py::arg("fixtures") = py::tuple(),
        py::arg("spoilboard") = 0.0, py::arg("bar") = py::none());
  m.def(
      "_stock_of_text",
      [](const std::string& text) { return *to_settings(py::none(), py::str(text), {}).stock; },
      py::arg("text"));
  m.def("_without_unused_first_tool", &without_unused_first_tool, py::arg("path"));
  m.def("_with_lines", &with_lines, py::arg("program"), py::arg("added"));
  m.def(
      "_write_files",
      [](const py::object& program, const std::vector<std::pair<std::string, py::bytes>>& files) {
        const bool has_inputs = py::isinstance<Program>(program);  // a Toolpath has none
        OutputSet set(has_inputs ? py::cast<const Program&>(program).files : std::vector<std::string>());
        Diagnostics diagnostics;
        bool written = true;
        for (const auto& [name, bytes] : files)
          written = written && set.write(name, std::string_view(bytes), diagnostics);
        if (written) set.commit(diagnostics);
        raise_os_error_or_warn(diagnostics);
      },
      py::arg("program"), py::arg("files"));
  m.def(
      "posts", [] { return post_target_names(); },
      R"(List the targets of `post`.

They are controllers, and the drawing formats 'dxf' and 'svg'.

Returns
-------
list of str
    Their names.

Examples
--------
>>> "grbl" in kerf.posts()
True)");
}

}  // namespace kerf::python

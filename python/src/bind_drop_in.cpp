// The texts that the compilers of gcmc and of path drawings write, as of `kerf gcmc`, `kerf pathdxf` and
// `kerf adjustz`, in Python.
#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

#include "back/drawing/gcmc_drawing.h"
#include "back/pathdxf/adjust_z.h"
#include "base/codes/gcmc.h"
#include "bindings.h"
#include "front/gcmc/gcmc.h"
#include "job/gcmc_workshop.h"
#include "job/path_programs.h"
#include "program_arguments.h"

#include "kerf/base/limits.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr int kMaxDecimals = 15;
constexpr double kLargestOffset = 1e6;   // mm, inches or degrees
constexpr double kWidestStroke = 1e4;    // mm or inches
constexpr double kSmallestLimit = 1e-6;  // MB, millions of steps
constexpr double kMaxOutput = 1e9;       // MB; their number of bytes fits 64 bits
constexpr double kMaxSteps = 1e6;        // millions
constexpr double kBytesPerMegabyte = 1 << 20;

/// The value of a keyword that Python passes on in a dict; raises TypeError that names it.
template <class T>
T keyword(const py::dict& options, const char* name, const char* type) {
  const py::object value = options[name];
  try {
    return py::cast<T>(value);
  } catch (const py::cast_error&) {
    throw py::type_error(std::string(name) + " must be " + type + ", not " + Py_TYPE(value.ptr())->tp_name);
  }
}
bool flag(const py::dict& options, const char* name) { return keyword<bool>(options, name, "a bool"); }
std::string text_of(const py::dict& options, const char* name) {
  return keyword<std::string>(options, name, "a str");
}
double number(const py::dict& options, const char* name, double low, double high, const char* unit) {
  return number_within(keyword<double>(options, name, "a number"), low, high, name, unit);
}

/// Collects the text and the messages of message().
class Collected final : public GcmcOutput {
 public:
  void message(const Diagnostic& m) override {
    if (m.code == codes::gcmc_script && m.severity == Severity::note) messages.push_back(m.message);
  }
  void text(std::string_view piece) override { written += piece; }

  std::string written;
  std::vector<std::string> messages;
};

GcmcVersion to_gcmc_version(const std::string& compat) {
  check_compat(compat);
  return gcmc_version_named(compat).value_or(GcmcVersion::unstated);
}

GcmcTarget to_gcmc_target(const std::string& name) {
  if (name == "gcode") return GcmcTarget::gcode;
  if (name == "svg") return GcmcTarget::svg;
  if (name == "dxf") return GcmcTarget::dxf;
  throw py::value_error("to must be 'gcode', 'svg' or 'dxf', not '" + name + "'");
}

Plane to_plane(const std::string& name) {
  constexpr std::string_view kNames[] = {"XY", "XZ", "YZ"};
  for (std::size_t i = 0; i < std::size(kNames); ++i)
    if (name == kNames[i]) return static_cast<Plane>(i);
  throw py::value_error("plane must be 'XY', 'XZ' or 'YZ', not '" + name + "'");
}

/// Added to the axes of a dict such as {"X": 10, "A": 90}.
std::array<double, 9> to_offsets(const py::dict& values, bool relative) {
  constexpr std::string_view kAxes = "XYZABCUVW";
  std::array<double, 9> offsets{};
  for (const auto& [key, value] : values) {
    const std::string name = py::isinstance<py::str>(key) ? py::cast<std::string>(key) : "";
    const std::size_t axis = name.size() == 1 ? kAxes.find(name[0]) : std::string_view::npos;
    if (axis == std::string_view::npos)
      throw py::value_error(
          "the keys of offsets must be 'X', 'Y', 'Z', 'A', 'B', 'C', 'U', 'V' or 'W', not " +
          py::cast<std::string>(py::repr(key)));
    if (!PyNumber_Check(value.ptr()))
      throw py::type_error("the value of " + name + " in offsets must be a number");
    offsets[axis] =
        number_within(py::cast<double>(value), -kLargestOffset, kLargestOffset,
                      ("the value of " + name + " in offsets").c_str(), "native units or degrees");
    if (relative && offsets[axis] != 0.0) throw py::value_error("offsets must be 0 with relative");
  }
  return offsets;
}

/// Prologue, epilogue or subroutine of the G-code.
void set_frame(const py::dict& given, GcmcOptions& options) {
  options.prologue = text_of(given, "prologue");
  options.epilogue = text_of(given, "epilogue");
  options.subroutine = text_of(given, "subroutine");
  options.subroutine_ends_program = flag(given, "m2");
  const bool bare = flag(given, "bare");
  if (bare) options.frame = GcmcFrame::bare;
  if (!options.subroutine.empty()) options.frame = GcmcFrame::subroutine;
  const bool good = std::all_of(options.subroutine.begin(), options.subroutine.end(), [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (!good) throw py::value_error("subroutine may only have the characters a to z, 0 to 9, _ and -");
  if (options.target != GcmcTarget::gcode && (bare || !options.prologue.empty() || !options.epilogue.empty()))
    throw py::value_error("prologue, epilogue and bare are for to='gcode' only");
}

GcmcOptions to_gcmc_options(const std::string& name, const std::string& to, const py::dict& given) {
  GcmcOptions options;
  options.file_name = name;
  options.target = to_gcmc_target(to);
  options.defines = keyword<std::vector<std::string>>(given, "defines", "a list of str");
  options.include_paths = keyword<std::vector<std::string>>(given, "include_paths", "a list of paths");
  options.version = to_gcmc_version(text_of(given, "compat"));
  options.degrees = flag(given, "degrees");
  options.imperial = flag(given, "imperial");
  options.relative = flag(given, "relative");
  options.precision =
      whole_within(keyword<long long>(given, "precision", "an int"), 1, kMaxDecimals, "precision");
  options.brief = flag(given, "brief");
  options.plane = to_plane(text_of(given, "plane"));
  options.offsets = to_offsets(keyword<py::dict>(given, "offsets", "a dict"), options.relative);
  options.uvw = flag(given, "uvw");
  options.date = text_of(given, "date");
  options.max_output = static_cast<std::uint64_t>(
      number(given, "max_output", kSmallestLimit, kMaxOutput, "MB") * kBytesPerMegabyte);
  options.max_quiet_steps = static_cast<std::uint64_t>(
      number(given, "max_steps", kSmallestLimit, kMaxSteps, "million steps") * 1e6);
  set_frame(given, options);
  options.workshop = &gcmc_workshop();
  options.want_text = options.target == GcmcTarget::gcode;
  options.want_path = !options.want_text;
  return options;
}

GcmcDrawingOptions to_gcmc_drawing(const py::dict& given) {
  GcmcDrawingOptions options;
  options.imperial = flag(given, "imperial");
  options.flip = flag(given, "flip");
  options.show_moves = flag(given, "rapids");
  options.show_grid = flag(given, "grid");
  options.tool_width = number(given, "stroke", 0.0, kWidestStroke, "mm or inches");
  options.opacity = number(given, "opacity", 0.0, 1.0, "");
  options.hex_handles = flag(given, "hex_handles");
  return options;
}

/// The text, and the messages of the program.
py::tuple gcmc_text(const std::string& text, const std::string& name, const std::string& to,
                    const py::dict& given) {
  const GcmcOptions options = to_gcmc_options(name, to, given);
  GcmcDrawingOptions drawing = to_gcmc_drawing(given);
  Collected output;
  Diagnostics diagnostics;
  SignalProgress progress;
  {
    const py::gil_scoped_release release;
    const GcmcRun run = run_gcmc(text, options, output, diagnostics, &progress);
    drawing.layers = run.layers;
    if (options.target == GcmcTarget::svg) output.written = gcmc_svg(run.path, drawing);
    if (options.target == GcmcTarget::dxf) output.written = gcmc_dxf(run.path, drawing);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  py::list messages;
  for (const std::string& message : output.messages) messages.append(to_str(message));
  return py::make_tuple(to_str(output.written), messages);
}

/// The faults of a program that is not run.
py::list gcmc_faults(const std::string& text, const std::string& name, const std::string& to,
                     const py::dict& given) {
  const GcmcOptions options = to_gcmc_options(name, to, given);
  Collected output;
  Diagnostics diagnostics;
  {
    const py::gil_scoped_release release;
    check_gcmc(text, options, output, diagnostics);
  }
  return to_list(diagnostics);
}

PathdxfOptions to_pathdxf_options(const py::dict& given) {
  PathdxfOptions options;
  static_cast<PathDrawingOptions&>(options) = to_drawing_options(given);
  options.folders = keyword<std::vector<std::string>>(given, "folders", "a list of paths");
  if (!given["show_texts"].is_none()) options.shown_texts = text_of(given, "show_texts");
  const std::string probe = text_of(given, "probe");
  if (probe != "g38.2" && probe != "g38.3") throw py::value_error("probe must be 'g38.2' or 'g38.3'");
  options.probe = probe == "g38.2" ? ProbeKind::contact_or_error : ProbeKind::contact;
  options.comments = PathdxfComments::trace;
  return options;
}

/// A compiled drawing, and the lines that it reports.
struct CompiledDrawing {
  PathdxfRun run;
  Diagnostics diagnostics;
  std::vector<std::string> lines;
};
CompiledDrawing compile_drawing(const std::string& file, PathdxfOptions options) {
  CompiledDrawing out;
  options.report = [&](std::string_view line) { out.lines.emplace_back(line); };
  SignalProgress progress;
  {
    const py::gil_scoped_release release;
    out.run = compile_pathdxf(file, options, out.diagnostics, &progress);
  }
  progress.rethrow();
  return out;
}

py::list str_list(const std::vector<std::string>& lines) {
  py::list list;
  for (const std::string& line : lines) list.append(to_str(line));
  return list;
}

/// The texts by the ending of their file names, and the lines reported.
py::tuple pathdxf_texts(const std::string& file, const py::dict& given) {
  CompiledDrawing compiled = compile_drawing(file, to_pathdxf_options(given));
  raise_or_warn(compiled.diagnostics);
  Diagnostics diagnostics;
  py::dict texts;
  for (const PathFile& made : path_files(compiled.run.programs.front(), file, diagnostics))
    texts[py::str(made.ending)] = to_str(made.text);
  raise_or_warn(diagnostics);
  return py::make_tuple(texts, str_list(compiled.lines));
}

/// The statistics of each path, the faults, and the lines reported.
py::tuple pathdxf_faults(const std::string& file, const py::dict& given) {
  PathdxfOptions options = to_pathdxf_options(given);
  options.selection = PathdxfSelection::check_all;
  const CompiledDrawing compiled = compile_drawing(file, std::move(options));
  py::dict statistics;
  for (const PathdxfProgram& program : compiled.run.programs)
    statistics[to_str(program.path)] = str_list(program.statistics);
  return py::make_tuple(statistics, to_list(compiled.diagnostics), str_list(compiled.lines));
}

/// The sheet, also of a drawing with errors, which it shows.
py::str pathdxf_sheet(const std::string& file, const py::dict& given) {
  const CompiledDrawing compiled = compile_drawing(file, to_pathdxf_options(given));
  return to_str(path_sheet_svg(file, compiled.run, compiled.diagnostics));
}

py::str adjusted(const std::string& program, const std::map<int, double>& values) {
  for (const auto& [number, value] : values)
    finite_number(value, ("the value of " + std::to_string(number)).c_str());
  Diagnostics diagnostics;
  const auto text = adjust_z(program, "program", values, Language::english, diagnostics);
  raise_or_warn(diagnostics);
  return to_str(*text);
}

/// The corrected program of the files of a drawing.
py::str adjusted_files(const std::string& name, double max_correction, const std::string& measured,
                       const py::object& work_offset) {
  AdjustOptions options;
  options.max_correction = to_max_correction(max_correction);
  options.measured = measured;
  options.reading = to_measured_options(work_offset);
  Diagnostics diagnostics;
  SignalProgress progress;
  std::optional<AdjustedProgram> program;
  {
    const py::gil_scoped_release release;
    program = adjust_path_program(name, options, diagnostics, &progress);
  }
  progress.rethrow();
  raise_os_error_or_warn(diagnostics);
  return to_str(program->text);
}

}  // namespace

PathDrawingOptions to_drawing_options(const py::dict& given) {
  PathDrawingOptions options;
  const auto feed = [&](const char* name) -> std::optional<Feed> {
    const double value = number(given, name, 0.0, limits::kMaxSpeed, "mm/min");
    return value > 0.0 ? std::optional(mm_per_min(value)) : std::nullopt;
  };
  options.feed = feed("feed");
  options.probe_feed = feed("probe_feed");
  options.rapid_speed = feed("rapid_speed");
  const double height = number(given, "rapid_height", 0.0, limits::kMaxCoordinate, "mm");
  if (height > 0.0) options.rapid_height = mm(height);
  if (!given["path_names"].is_none()) options.path_names = text_of(given, "path_names");
  if (!given["file_patterns"].is_none()) options.file_patterns = text_of(given, "file_patterns");
  options.restrictions = keyword<std::vector<std::string>>(given, "restrictions", "a list of str");
  options.variables = keyword<std::vector<std::string>>(given, "defines", "a list of str");
  return options;
}

void bind_drop_in(py::module_& m) {
  m.def("_gcmc", &gcmc_text, py::arg("text"), py::arg("name"), py::arg("to"), py::arg("options"));
  m.def("_check_gcmc", &gcmc_faults, py::arg("text"), py::arg("name"), py::arg("to"), py::arg("options"));
  m.def("_pathdxf", &pathdxf_texts, py::arg("file"), py::arg("options"));
  m.def("_check_pathdxf", &pathdxf_faults, py::arg("file"), py::arg("options"));
  m.def("_path_sheet", &pathdxf_sheet, py::arg("file"), py::arg("options"));
  m.def("_adjusted", &adjusted_files, py::arg("name"), py::arg("max_correction"), py::arg("measured"),
        py::arg("work_offset"));
  m.def("adjust_heights", &adjusted, py::arg("program"), py::arg("values"),
        R"(Replace the heights with formulas in a program of a path drawing by their measured values.

Parameters
----------
program : str
    The text that `pathdxf` returns as '_Clean.gcode'.
values : dict of int to float
    Measured heights by the number of their variable: 51 for #51, mm.

Returns
-------
str
    The text.

Raises
------
kerf.Error
    If a formula is malformed, or uses a variable without a value.

Examples
--------
>>> line = "G01 Z0.800(=0.800+1.000*[#51-2.000]) F100\n"
>>> "Z0.849(" in kerf.adjust_heights(line, {51: 2.049})
True)");
}

}  // namespace kerf::python

// The texts that the compilers of gcmc and of path drawings write, as of `kerf gcmc`, `kerf pathdxf` and
// `kerf adjustz`, in Python.
#include <algorithm>

#include "bindings.h"

#include "kerf/adjust_z.h"
#include "kerf/files.h"
#include "kerf/gcmc.h"
#include "kerf/gcmc_drawing.h"
#include "kerf/names.h"
#include "kerf/pathdxf.h"
#include "kerf/pathdxf_gcode.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr int kMaxDecimals = 15;

/// Collects the text and the messages of message().
class Collected final : public GcmcOutput {
 public:
  void message(const Diagnostic& m) override {
    if (m.code == Code::gcmc_script && m.severity == Severity::note) messages.push_back(m.message);
  }
  void text(std::string_view piece) override { written += piece; }

  std::string written;
  std::vector<std::string> messages;
};

GcmcTarget to_gcmc_target(const std::string& name) {
  if (name == "gcode") return GcmcTarget::gcode;
  if (name == "svg") return GcmcTarget::svg;
  if (name == "dxf") return GcmcTarget::dxf;
  throw py::value_error("to must be 'gcode', 'svg' or 'dxf', not '" + name + "'");
}

/// The text, and the messages of the program.
py::tuple gcmc_text(const std::string& text, const std::string& name, const std::string& to,
                    std::vector<std::string> defines, std::vector<std::string> include_paths, bool imperial,
                    bool relative, long long precision, bool brief) {
  GcmcOptions options;
  options.file_name = name;
  options.target = to_gcmc_target(to);
  options.defines = std::move(defines);
  options.include_paths = std::move(include_paths);
  options.imperial = imperial;
  options.relative = relative;
  options.precision = whole_within(precision, 1, kMaxDecimals, "precision");
  options.brief = brief;
  options.want_text = options.target == GcmcTarget::gcode;
  options.want_path = !options.want_text;
  Collected output;
  Diagnostics diagnostics;
  SignalProgress progress;
  {
    const py::gil_scoped_release release;
    const GcmcRun run = run_gcmc(text, options, output, diagnostics, &progress);
    const GcmcDrawingOptions drawing{.imperial = imperial, .layers = run.layers};
    if (options.target == GcmcTarget::svg) output.written = gcmc_svg(run.path, drawing);
    if (options.target == GcmcTarget::dxf) output.written = gcmc_dxf(run.path, drawing);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  py::list messages;
  for (const std::string& message : output.messages) messages.append(to_str(message));
  return py::make_tuple(to_str(output.written), messages);
}

/// Texts by the ending of their file names.
py::dict texts_of(const PathdxfProgram& program, const std::string& file, Diagnostics& diagnostics) {
  PathdxfGcodeOptions options;
  options.program_line = "PathDxf2GCode - Kerf " KERF_VERSION;
  options.file_name = file.substr(file.find_last_of("/\\") + 1);
  py::dict texts;
  const auto add = [&](const char* ending, const std::string& text) {
    texts[py::str(program.suffix + ending)] = to_str(text);
  };
  const std::string milling =
      program.is_empty ? std::string() : pathdxf_gcode(program.milling, options, diagnostics);
  if (program.probing) {
    add("_Probing.gcode", pathdxf_gcode(*program.probing, options, diagnostics));
    add("_Z.txt", pathdxf_probe_list(program));
  }
  add(program.probing ? "_Clean.gcode" : "_Milling.gcode", milling);
  return texts;
}

py::dict pathdxf_texts(const std::string& file, double feed, double rapid_height,
                       std::vector<std::string> folders) {
  PathdxfOptions options;
  number_within(feed, 0.0, limits::kMaxSpeed, "feed", "mm/min");
  number_within(rapid_height, 0.0, limits::kMaxCoordinate, "rapid_height", "mm");
  if (feed > 0.0) options.feed = mm_per_min(feed);
  if (rapid_height > 0.0) options.rapid_height = mm(rapid_height);
  options.folders = std::move(folders);
  options.comments = PathdxfComments::trace;
  Diagnostics diagnostics;
  SignalProgress progress;
  PathdxfRun run;
  {
    const py::gil_scoped_release release;
    run = compile_pathdxf(file, options, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  py::dict texts = texts_of(run.programs.front(), file, diagnostics);
  raise_or_warn(diagnostics);
  return texts;
}

py::str adjusted(const std::string& program, const std::map<int, double>& values) {
  for (const auto& [number, value] : values)
    finite_number(value, ("the value of " + std::to_string(number)).c_str());
  Diagnostics diagnostics;
  const auto text = adjust_z(program, "program", values, Language::english, diagnostics);
  raise_or_warn(diagnostics);
  return to_str(*text);
}

}  // namespace

void bind_drop_in(py::module_& m) {
  m.def("_gcmc", &gcmc_text, py::arg("text"), py::arg("name"), py::arg("to"), py::arg("defines"),
        py::arg("include_paths"), py::arg("imperial"), py::arg("relative"), py::arg("precision"),
        py::arg("brief"));
  m.def("_pathdxf", &pathdxf_texts, py::arg("file"), py::arg("feed"), py::arg("rapid_height"),
        py::arg("folders"));
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

Raises
------
kerf.Error
    If a formula is malformed, or uses a variable without a value.)");
}

}  // namespace kerf::python

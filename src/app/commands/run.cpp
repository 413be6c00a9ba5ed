// kerf run: runs a Python script or an OpenSCAD program that makes a part with kerf or gcodepreview.
#include <memory>

#include "app/commands/commands.h"
#include "app/commands/run_scad.h"
#include "app/options/common.h"
#include "app/options/output_options.h"
#include "app/report/terminal_progress.h"

#include "kerf/files.h"
#include "kerf/names.h"
#include "kerf/python_script.h"

namespace kerf::app {
namespace {

/// Names of the paths of -o, one per line, for gcodepreview.show().
constexpr const char* kOutputsVariable = "KERF_RUN_OUTPUTS";

struct Options {
  OutputOptions output;
  std::string script;
  std::vector<std::string> outputs, arguments;
  std::vector<std::string> defines, include_paths;
  ScadParameterSet parameters;
  bool list_parameters = false;
  std::vector<Option> scad_options;  // without effect on a Python script
};

/// An OpenSCAD program with the options for it.
Status run_scad_with(Console& console, const Options& options) {
  Diagnostics usage;
  for (const std::string& argument : options.arguments)
    usage.error(Code::usage, {}, "an OpenSCAD program has no arguments: " + clipped(argument, 60));
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  ScadCommand command{options.script, options.outputs, {}, options.parameters, options.list_parameters};
  command.program.defines = options.defines;
  command.program.include_paths = options.include_paths;
  return run_scad(console, command);
}

Status run(Console& console, const Options& options) {
  if (is_scad_name(options.script)) return run_scad_with(console, options);
  Diagnostics usage, diagnostics;
  warn_unused(options.scad_options, "the script is not an OpenSCAD program", "", diagnostics);
  read_outputs(options.outputs, {options.script}, usage, diagnostics);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  if (!InputFile::open(options.script, diagnostics) || diagnostics.has_errors())
    return fail(console, diagnostics, Status::input_errors);
  console.show(diagnostics);
  ScriptOptions script;
  script.arguments = options.arguments;
  script.environment = {{kOutputsVariable, joined(options.outputs, "\n")}};
  script.output = ScriptOutput::to_stdout;
  const int status = run_python(options.script, script, diagnostics);
  if (interrupted()) return Status::interrupted;
  if (status < 0) return fail(console, diagnostics, Status::input_errors);
  return static_cast<Status>(status);
}

void add_scad_options(CommandParser& parser, Options& options) {
  options.scad_options = {
      add_repeated(parser, "-D,--define", options.defines, "NAME=VALUE",
                   "Give a variable of an OpenSCAD program this value"),
      add_repeated(parser, "-I,--include", options.include_paths, "FOLDER",
                   "Search the files that an OpenSCAD program includes here, too"),
      parser
          .add_text("-p,--parameters", options.parameters.file,
                    "Sets of values of OpenSCAD's customizer, JSON")
          .value_name("FILE"),
      parser.add_text("-P,--parameter-set", options.parameters.name, "The set of that file")
          .value_name("NAME"),
      parser.add_flag("--list-parameters", options.list_parameters,
                      "Print the parameters of an OpenSCAD program, and write nothing")};
}

const char* const kExamples = R"(  kerf run part.py                          the files that the script writes
  kerf run part.py -o part.png -o part.stl  and the part that it shows
  kerf run part.py --width 40               arguments after the script's name are the script's
  kerf run -D depth=5 part.scad -o part.png an OpenSCAD program, with another value of a variable

Kerf's Python modules are on the script's path: kerf, gcodepreview, and a stand-in for PythonSCAD's openscad.
The part that the script shows with stockandtoolpaths() or show() is written to the paths of -o, else beside
the script as .glb. The exit status is that of the script.
)";

}  // namespace

Command add_run(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(root, "run", "Run a Python script or an OpenSCAD program that makes a part", kExamples,
                  options->output);
  add_repeated(parser, "-o,--output", options->outputs, "PATH",
               "Write the part that the script shows; its ending selects the format");
  add_scad_options(parser, *options);
  parser.add_text("SCRIPT", options->script, "The Python script, or the OpenSCAD program (.scad)")
      .required()
      .value_name("");
  parser.add_texts("ARGUMENTS", options->arguments, "Arguments of the script").value_name("");
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app

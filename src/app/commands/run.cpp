// kerf run: runs a Python script that makes a part with kerf or gcodepreview.
#include <memory>

#include "app/commands/commands.h"
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
};

Status run(Console& console, const Options& options) {
  Diagnostics usage, diagnostics;
  read_outputs(options.outputs, {options.script}, usage, diagnostics);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  if (!InputFile::open(options.script, diagnostics) || diagnostics.has_errors())
    return fail(console, diagnostics, Status::input_errors);
  ScriptOptions script;
  script.arguments = options.arguments;
  script.environment = {{kOutputsVariable, joined(options.outputs, "\n")}};
  script.output = ScriptOutput::to_stdout;
  const int status = run_python(options.script, script, diagnostics);
  if (interrupted()) return Status::interrupted;
  if (status < 0) return fail(console, diagnostics, Status::input_errors);
  return static_cast<Status>(status);
}

const char* const kExamples = R"(  kerf run part.py                          the files that the script writes
  kerf run part.py -o part.png -o part.stl  and the part that it shows
  kerf run part.py --width 40               arguments after the script's name are the script's

Kerf's Python modules are on the script's path: kerf, gcodepreview, and a stand-in for PythonSCAD's openscad.
The part that the script shows with stockandtoolpaths() or show() is written to the paths of -o, else beside
the script as .glb. The exit status is that of the script.
)";

}  // namespace

Command add_run(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser = new_command(root, "run", "Run a Python script that makes a part with Kerf's modules",
                                     kExamples, options->output);
  add_repeated(parser, "-o,--output", options->outputs, "PATH",
               "Write the part that the script shows; its ending selects the format");
  parser.add_text("SCRIPT", options->script, "The Python script").required().value_name("");
  parser.add_texts("ARGUMENTS", options->arguments, "Arguments of the script").value_name("");
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app

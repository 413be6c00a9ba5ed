// kerf run: runs a Python script or an OpenSCAD program that makes a part with kerf or gcodepreview.
#include <algorithm>
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/commands/run_scad.h"
#include "app/options/common.h"
#include "app/options/output_options.h"
#include "app/report/findings.h"
#include "app/report/terminal_progress.h"
#include "base/codes/files.h"
#include "base/file_names.h"
#include "base/names.h"
#include "base/number.h"
#include "base/split.h"
#include "base/system.h"
#include "job/python_script.h"
#include "job/record/figures.h"
#include "job/record/record.h"

#include "kerf/base/files.h"

namespace kerf::app {
namespace {

/// Names of the paths of -o, one per line, for gcodepreview.show().
constexpr const char* kOutputsVariable = "KERF_RUN_OUTPUTS";
/// The number of --mesh-tolerance, empty without it.
constexpr const char* kToleranceVariable = "KERF_RUN_MESH_TOLERANCE";

/// In the private folder of a run: the program that the script has made, and the names of its files.
constexpr const char *kProgramName = "program.kerf", *kWrittenName = "written.txt";

struct Options {
  OutputOptions output;
  std::string script;
  std::vector<std::string> outputs, arguments;
  std::vector<std::string> defines, include_paths;
  ScadParameterSet parameters;
  bool list_parameters = false;
  double mesh_tolerance = 0.0;       // mm; 0: not given
  std::vector<Option> mesh_options;  // without effect where no mesh is written
  std::vector<Option> scad_options;  // without effect on a Python script
};

/// An OpenSCAD program with the options for it.
Status run_scad_with(Console& console, const Options& options) {
  Diagnostics usage;
  for (const std::string& argument : options.arguments)
    usage.error(codes::usage, {}, "an OpenSCAD program has no arguments: " + clipped(argument, 60));
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  ScadCommand command{.file = options.script,
                      .outputs = options.outputs,
                      .program = {},
                      .parameters = options.parameters,
                      .mesh_tolerance = {},
                      .mesh_options = options.mesh_options,
                      .list_parameters = options.list_parameters};
  if (options.mesh_tolerance > 0.0) command.mesh_tolerance = mm(options.mesh_tolerance);
  command.program.defines = options.defines;
  command.program.include_paths = options.include_paths;
  return run_scad(console, command);
}

std::vector<FileStamp> stamps_of(const std::vector<std::string>& paths) {
  std::vector<FileStamp> stamps;
  for (const std::string& path : paths) stamps.push_back(file_stamp(path));
  return stamps;
}

/// Where the part that a script shows may be written: the paths of -o, else beside the script.
std::vector<std::string> possible_outputs(const Options& options) {
  if (!options.outputs.empty()) return options.outputs;
  return {with_extension(options.script, ".glb"), with_extension(options.script, ".png")};
}

/// What a run of a script has made.
struct Made {
  int status = 0;                    // exit status of the command
  std::vector<std::string> outputs;  // files that were written
  std::vector<Finding> findings;     // of a part that Kerf has cut
  bool is_failure_shown = false;     // by Python
};

/// Ends the command with the object of --json, which always has the status.
Status end(Console& console, const Made& made, const Diagnostics& diagnostics) {
  Diagnostics shown;
  for (const Diagnostic& d : diagnostics.list())
    if (!made.is_failure_shown || d.code != codes::script_failed) shown.add(d);
  console.show(shown);
  if (!console.json()) show(console, made.findings);
  if (console.json())
    console.print_json(text_of(Record{{"status", made.status},
                                      {"outputs", made.outputs},
                                      {"hazards", record_of(made.findings)},
                                      {"diagnostics", record_of(diagnostics)}},
                               Layout::indented));
  return static_cast<Status>(made.status);
}

Status refuse(Console& console, const Diagnostics& diagnostics, Status status) {
  return end(console, {.status = static_cast<int>(status), .outputs = {}, .findings = {}}, diagnostics);
}

/// Adds a name, unless the same file is there.
void add_output(std::vector<std::string>& outputs, const std::string& name) {
  if (std::none_of(outputs.begin(), outputs.end(),
                   [&](const std::string& o) { return is_same_file(o, name); }))
    outputs.push_back(name);
}

std::vector<std::string> names_in(const std::string& file) {
  Diagnostics unused;
  const auto input = exists(file) ? InputFile::open(file, unused) : std::nullopt;
  return input ? lines_of(input->bytes()) : std::vector<std::string>();
}

/// Cuts the program that the script has made and writes its part, where the script has not shown one. False
/// with errors.
bool write_program(Console& console, const Options& options, const std::string& program_file,
                   const std::vector<PartFile>& files, Made& made, Diagnostics& diagnostics) {
  if (!exists(program_file)) {
    diagnostics
        .error(codes::file_unwritable, TextLocation{options.script, 0, 0},
               fmt::format("the script shows no part; {} was not written", files.front().path))
        .hint =
        "a part is a kerf.Job that has ended, a toolpath that is simulated or written, or what is "
        "passed to stockandtoolpaths() or show()";
    return false;
  }
  TerminalProgress progress(console);
  auto program = load_program(program_file, {}, diagnostics, &progress);
  if (!program || diagnostics.has_errors()) return false;
  program->source = options.script;
  program->files = {options.script};
  OutputSet set(program->files);
  PartFileOptions how;
  if (options.mesh_tolerance > 0.0) how.tolerance = mm(options.mesh_tolerance);
  const bool written =
      write_part_of(std::move(*program), {}, files, how, set, made.findings, diagnostics, progress);
  progress.clear();
  if (interrupted() || !written || !set.commit(diagnostics)) return false;
  for (const PartFile& file : files) add_output(made.outputs, file.path);
  show_written(console, files);
  return true;
}

ScriptOptions script_options(const Console& console, const Options& options, const TemporaryFolder& folder,
                             std::string& error_end) {
  ScriptOptions script;
  script.arguments = options.arguments;
  script.environment = {
      {kOutputsVariable, joined(options.outputs, "\n")},
      {kToleranceVariable, options.mesh_tolerance > 0.0 ? exact_text(options.mesh_tolerance) : ""}};
  if (console.json())
    script.environment.emplace_back("KERF_RUN_WRITTEN", path_in(folder.path(), kWrittenName));
  if (!options.outputs.empty())
    script.environment.emplace_back("KERF_VIEW_PROGRAM", path_in(folder.path(), kProgramName));
  script.output = console.json() ? ScriptOutput::to_stderr : ScriptOutput::to_stdout;
  if (console.json()) script.error_end = &error_end;
  return script;
}

/// Runs the script, and writes the outputs that it has not written.
Status run_script(Console& console, const Options& options, const std::vector<PartFile>& outputs,
                  Diagnostics& diagnostics) {
  const TemporaryFolder folder("kerf-run");
  if (folder.path().empty()) {
    diagnostics.error(codes::script_failed, TextLocation{options.script, 0, 0},
                      "cannot create a temporary folder");
    return refuse(console, diagnostics, Status::input_errors);
  }
  const std::vector<std::string> expected = possible_outputs(options);
  const auto before = stamps_of(expected);
  std::string error_end;
  Made made;
  Diagnostics found;
  made.status = run_python(options.script, script_options(console, options, folder, error_end), found);
  if (interrupted()) return Status::interrupted;
  if (made.status < 0) return refuse(console, found, Status::input_errors);
  made.is_failure_shown = made.status != 0;
  if (made.status != 0 && console.json()) add_script_failure(options.script, made.status, error_end, found);
  for (const std::string& name : names_in(path_in(folder.path(), kWrittenName)))
    add_output(made.outputs, name);
  const auto after = stamps_of(expected);
  std::vector<PartFile> missing;
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (after[i] != before[i])
      add_output(made.outputs, expected[i]);
    else if (made.status == 0 && !options.outputs.empty())
      missing.push_back(outputs[i]);
  if (!missing.empty() &&
      !write_program(console, options, path_in(folder.path(), kProgramName), missing, made, found)) {
    if (interrupted()) return report_stopped(console);
    made.status = static_cast<int>(Status::input_errors);
  }
  for (const Diagnostic& d : found.list()) diagnostics.add(d);
  return end(console, made, console.json() ? diagnostics : found);
}

Status run(Console& console, const Options& options) {
  Diagnostics usage, diagnostics;
  if (std::find(options.outputs.begin(), options.outputs.end(), "-") != options.outputs.end()) {
    usage.error(codes::output_kind_unknown, CallLocation{"", 0, "-o"},
                "standard output is for what the program prints; specify a file");
    return refuse(console, usage, Status::wrong_usage);
  }
  if (is_scad_name(options.script)) return run_scad_with(console, options);
  warn_unused(options.scad_options, "the script is not an OpenSCAD program", "", diagnostics);
  const Outputs outputs = read_outputs(options.outputs, {}, {options.script}, usage, diagnostics);
  if (!outputs.files.empty()) warn_without_mesh(options.mesh_options, outputs.files, diagnostics);
  if (usage.has_errors()) return refuse(console, usage, Status::wrong_usage);
  if (!InputFile::open(options.script, diagnostics) || diagnostics.has_errors())
    return refuse(console, diagnostics, Status::input_errors);
  warn_of_hidden_module(options.script, diagnostics);
  if (!console.json()) console.show(diagnostics);  // before what the script prints
  return run_script(console, options, outputs.files, diagnostics);
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
  kerf run part.py --width 40               after the script's name all but -o, -q and --json is the script's
  kerf run -D depth=5 part.scad -o part.png an OpenSCAD program, with another value of a variable

Kerf's Python modules are on the script's path: kerf, gcodepreview, and a stand-in for PythonSCAD's openscad.
The part is what the script shows with stockandtoolpaths() or show(), else what it has simulated, written or
ended last as a kerf.Job, as in kerf view. It is written to the paths of -o; what is shown without -o, beside
the script as .glb. The exit status is that of the script. With --json what the program prints goes to
standard error; the object has the status, the files that were written, hazards and diagnostics.
)";

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), word) != names.end();
}

}  // namespace

std::vector<std::string> with_script_arguments(const std::vector<std::string>& words) {
  if (words.empty() || words.front() != "run") return words;
  std::vector<std::string> own, of_script;
  bool after_script = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--") return words;
    const bool has_value =
        is_one_of(word, {"-o", "--output"}) ||
        (!after_script && is_one_of(word, {"-D", "--define", "-I", "--include", "-p", "--parameters", "-P",
                                           "--parameter-set", "--mesh-tolerance"}));
    const bool is_own = !after_script || has_value || word.starts_with("--output=") ||
                        is_one_of(word, {"-q", "--quiet", "--json"});
    (is_own ? own : of_script).push_back(word);
    if (has_value && i + 1 < words.size())
      own.push_back(words[++i]);
    else if (i > 0 && !word.starts_with("-") && !is_scad_name(word))
      after_script = true;
  }
  if (of_script.empty()) return words;
  own.push_back("--");
  own.insert(own.end(), of_script.begin(), of_script.end());
  return own;
}

Command add_run(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(root, "run", "Run a Python script or an OpenSCAD program that makes a part", kExamples,
                  options->output);
  add_repeated(parser, "-o,--output", options->outputs, "PATH",
               "Write the part that the script shows; its ending selects the format");
  options->mesh_options = {add_mesh_tolerance(parser, options->mesh_tolerance)};
  add_scad_options(parser, *options);
  parser.add_text("SCRIPT", options->script, "The Python script, or the OpenSCAD program (.scad)")
      .required()
      .value_name("");
  parser.add_texts("ARGUMENTS", options->arguments, "Arguments of the script").value_name("");
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app

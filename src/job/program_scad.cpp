// The front end for OpenSCAD programs.
#include <fmt/format.h>
#include <utility>

#include "base/codes/scad.h"
#include "base/ending.h"
#include "front/scad/commands/commands.h"
#include "job/design_services.h"
#include "job/front_ends.h"
#include "job/scad_imports.h"
#include "job/scad_job.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace {

/// Statements of gcodepreview, or definitions of the language.
bool looks_like_scad(std::string_view text) {
  for (const std::string_view word : {"use <", "include <", "module ", "//!OpenSCAD", "$fn"})
    if (text.substr(0, word.size()) == word || text.find("\n" + std::string(word)) != std::string_view::npos)
      return true;
  return false;
}

/// The assignments of the options: the set of parameters, then those of the command line, which replace it.
std::vector<std::string> assignments(const ProgramOptions& options, const ScadParameterSet& set,
                                     Diagnostics& diagnostics) {
  std::vector<std::string> list;
  if (!set.file.empty()) {
    if (const auto file = InputFile::open(set.file, diagnostics, limits::kMaxToolFileBytes))
      list = read_parameter_set(file->bytes(), set.file, set.name, diagnostics);
  } else if (!set.name.empty()) {
    diagnostics.error(codes::scad_parameters, TextLocation{set.name, 0, 0},
                      "a set of parameters without a file of sets");
  }
  list.insert(list.end(), options.defines.begin(), options.defines.end());
  return list;
}

/// What the commands have made.
void take_result(design::Results result, ScadJob& job) {
  job.program.path = std::move(result.path);
  job.program.tools = std::move(result.tools);
  job.program.stock = std::move(result.stock);
  job.resolution = result.resolution;
  job.shown = result.shown;
  job.files = std::move(result.files);
  job.programs = std::move(result.programs);
}

Program read(const InputFile& file, const ProgramOptions& options, Diagnostics& diagnostics,
             Progress* progress) {
  return run_scad_file(file, options, {}, diagnostics, progress).program;
}

}  // namespace

bool is_scad_name(std::string_view file) { return ending_of(file) == ".scad"; }

ScadJob run_scad_file(const InputFile& file, const ProgramOptions& input, const ScadParameterSet& set,
                      Diagnostics& diagnostics, Progress* progress) {
  ScadOptions options;
  options.file_name = file.path();
  options.include_paths = input.include_paths;
  options.defines = assignments(input, set, diagnostics);
  ScadJob job;
  if (diagnostics.has_errors()) return job;
  const std::unique_ptr<scad::CommandState> state = scad::make_state(machine_services(progress));
  const scad::Imports imports = scad_imports();
  const scad::CommandSet commands{&scad::commands(), state.get(), &imports};
  options.commands = &commands;
  if (input.printed)
    options.printed = [&input](const TextLocation& where, std::string_view line) {
      input.printed(fmt::format("{}:{}: {}", where.file, where.line, line));
    };
  ScadRun run = run_scad(file.bytes(), options, diagnostics, progress);
  take_result(scad::finish(*state, diagnostics), job);
  job.program.source = file.path();
  job.program.front_end = "OpenSCAD";
  job.program.files = std::move(run.files);
  if (!job.program.stock) job.program.stock = std::move(run.material);
  job.output = std::move(run.output);
  job.parameters = std::move(run.parameters);
  job.area = std::move(run.area);
  return job;
}

FrontEnd scad_front_end() { return {"OpenSCAD", {".scad"}, looks_like_scad, read, {OptionGroup::define}}; }

}  // namespace kerf

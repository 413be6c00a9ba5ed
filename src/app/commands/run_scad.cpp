// kerf run of an OpenSCAD program: its output, its files, and the part that it shows.
#include "app/commands/run_scad.h"

#include <fmt/format.h>
#include <utility>

#include "app/options/output_options.h"
#include "app/report/findings.h"
#include "app/report/terminal_progress.h"
#include "base/file_names.h"
#include "job/record/figures.h"
#include "job/record/record.h"
#include "job/scad_job.h"

#include "kerf/base/limits.h"
#include "kerf/job/job.h"
#include "kerf/job/outputs.h"

namespace kerf::app {
namespace {

/// The part beside the program, where it shows one and -o is not given.
std::string beside(const std::string& program) { return with_extension(program, ".glb"); }

/// The parameters for the user, under the headings of their groups.
Status print_parameters(Console& console, const std::vector<ScadParameter>& parameters,
                        const Diagnostics& diagnostics) {
  if (console.json()) {
    Record list = Record::array();
    for (const ScadParameter& p : parameters)
      list.push_back(Record{{"name", p.name},
                            {"value", p.value},
                            {"group", p.group},
                            {"description", p.description},
                            {"choices", p.choices},
                            {"line", p.line}});
    console.print_json(
        text_of(Record{{"parameters", list}, {"diagnostics", record_of(diagnostics)}}, Layout::indented));
  } else {
    const std::string* group = nullptr;
    for (const ScadParameter& p : parameters) {
      if (!p.group.empty() && (group == nullptr || *group != p.group)) console.print(p.group + "\n");
      group = &p.group;
      std::string line = fmt::format("  {} = {}", p.name, p.value);
      if (!p.choices.empty()) line += "  " + p.choices;
      if (!p.description.empty()) line += "  (" + p.description + ")";
      console.print(line + "\n");
    }
  }
  console.show(diagnostics);
  return diagnostics.has_errors() ? Status::input_errors : Status::done;
}

/// The object of --json.
void print_result(Console& console, const std::vector<DesignFile>& files, const std::vector<PartFile>& parts,
                  const std::vector<Finding>& findings, const Diagnostics& diagnostics) {
  Record outputs = Record::array();
  for (const DesignFile& file : files) outputs.push_back(file.name);
  for (const PartFile& part : parts) outputs.push_back(part.path);
  console.print_json(text_of(Record{{"status", 0},
                                    {"outputs", outputs},
                                    {"hazards", record_of(findings)},
                                    {"diagnostics", record_of(diagnostics)}},
                             Layout::indented));
}

}  // namespace

bool write_part_of(Program program, Length resolution, const std::vector<PartFile>& files,
                   const PartFileOptions& options, OutputSet& set, std::vector<Finding>& findings,
                   Diagnostics& diagnostics, Progress& progress) {
  const std::size_t errors = diagnostics.errors();
  const Job job = make_job_or_print(std::move(program), {}, UnknownTool::assume, diagnostics);
  if (diagnostics.errors() > errors || !can_write(files, job.kind, diagnostics)) return false;
  RunOptions how;
  how.volumes_by_tool = true;
  if (job.kind == JobKind::milling) how.resolution = resolution;
  const auto run = run_job(job, how, diagnostics, &progress);
  if (!run) return false;
  findings = run->findings;
  return write_part(files, job, *run, options, set, diagnostics, &progress);
}

Status run_scad(Console& console, const ScadCommand& command) {
  Diagnostics usage, diagnostics;
  std::vector<PartFile> outputs = read_outputs(command.outputs, {}, {command.file}, usage, diagnostics).files;
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  if (!outputs.empty()) warn_without_mesh(command.mesh_options, outputs, diagnostics);
  TerminalProgress progress(console);
  const auto file = InputFile::open(command.file, diagnostics, limits::kMaxGcmcSourceBytes, &progress);
  if (!file || diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  ScadJob made = run_scad_file(*file, command.program, command.parameters, diagnostics, &progress);
  if (command.list_parameters) {
    progress.clear();
    return interrupted() ? report_stopped(console) : print_parameters(console, made.parameters, diagnostics);
  }
  const auto files = diagnostics.has_errors() ? std::nullopt : scad_files(made, diagnostics, &progress);
  progress.clear();
  console.print_output(made.output);
  if (interrupted()) return report_stopped(console);
  if (!files) return fail(console, diagnostics, Status::input_errors);
  made.program.files.push_back(command.file);
  OutputSet set(made.program.files);
  bool written = true;
  for (const DesignFile& output : *files)
    written = written && set.write(output.name, output.bytes, diagnostics);
  PartFileOptions options;
  options.tolerance = command.mesh_tolerance;
  if (outputs.empty() && made.shown) {
    outputs.push_back(*part_file(beside(command.file)));
    options.detail = SurfaceDetail::columns;  // a preview, for a viewer
  }
  std::vector<Finding> findings;
  if (written && !outputs.empty())
    written = write_part_of(std::move(made.program), made.resolution, outputs, options, set, findings,
                            diagnostics, progress);
  if (const auto end = finish_outputs(console, progress, written, set, diagnostics)) return *end;
  if (console.json()) {
    print_result(console, *files, outputs, findings, diagnostics);
    return Status::done;
  }
  console.show(diagnostics);
  show(console, findings);
  for (const DesignFile& output : *files) console.summary("wrote    " + output.name);
  show_written(console, outputs);
  return Status::done;
}

}  // namespace kerf::app

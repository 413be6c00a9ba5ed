// Services for the machine of designs, and their G-code files.
#include "job/design_services.h"

#include <utility>

#include "base/codes/gcode.h"
#include "base/names.h"
#include "job/front_ends.h"
#include "job/named.h"
#include "job/scad_job.h"

#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"
#include "kerf/job/job.h"
#include "kerf/job/posting.h"
#include "kerf/stock/stock.h"

namespace kerf {
namespace {

/// G-code alone: an OpenSCAD program that reads itself would not end.
std::optional<design::ReadProgram> read_program(const std::string& name, Diagnostics& diagnostics,
                                                Progress* progress) {
  const auto file = InputFile::open(name, diagnostics, limits::kMaxProgramBytes, progress);
  if (!file) return std::nullopt;
  const std::size_t errors = diagnostics.errors();
  Program program = gcode_front_end().read(*file, {}, diagnostics, progress);
  if (diagnostics.errors() > errors) return std::nullopt;
  return design::ReadProgram{std::move(program.path), std::move(program.tools), std::move(program.stock)};
}

/// The stock after the cuts of a side, without its hazards: those are reported for the file of that side.
std::optional<Stock> left_stock(const design::CutSide& side, Diagnostics& diagnostics, Progress* progress) {
  Program program;
  program.front_end = "gcodepreview";
  program.path = side.path;
  JobSettings settings;
  settings.tools.table = side.tools;
  settings.stock = side.stock;
  const std::size_t errors = diagnostics.errors();
  const Job job = make_job(std::move(program), settings, UnknownTool::error, diagnostics);
  if (diagnostics.errors() > errors) return std::nullopt;
  RunOptions how;
  how.resolution = side.resolution;
  const auto run = run_job(job, how, diagnostics, progress);
  if (!run) return std::nullopt;
  return stock_of(make_columns_body(left_columns(run->milling().workpiece)));
}

/// The post of a name, or of a file.
std::optional<PostTarget> target_of(const std::string& name, Diagnostics& diagnostics) {
  if (name.find('.') != std::string::npos) return load_post_target(name, diagnostics);
  Diagnostics found;
  if (auto target = post_called(name, found); target && !target->is_program) return target;
  if (located(Named::post, name, used_configuration()) != name) {  // a file with errors
    for (const Diagnostic& d : found.list()) diagnostics.add(d);
    return std::nullopt;
  }
  diagnostics.error(
      codes::post_unknown, {},
      "setpost: there is no post \"" + clipped(name, 60) + "\"; known: " + joined(post_target_names(), ", "));
  return std::nullopt;
}

/// Posts the line alone.
std::optional<std::string> reason_against(const std::string& line, const std::string& post) {
  Diagnostics unknown;  // of the name of a post: reported when its program is written
  const auto target = target_of(post, unknown);
  if (!target) return std::nullopt;
  Program program;
  program.path.add(step::Verbatim{line}, {});
  Diagnostics found;
  post_program(program, *target, {}, found);
  for (const Diagnostic& d : found.list())
    if (d.severity == Severity::error) return d.message;
  return std::nullopt;
}

/// The tools to which a path changes. One that is only defined, perhaps after its cuts, is not the tool of
/// their start.
std::map<int, Tool> changed_to(const Toolpath& path, const std::map<int, Tool>& own) {
  std::map<int, Tool> tools;
  for (const Step& s : path.steps()) {
    if (s.kind() != StepKind::tool_change) continue;
    if (const auto found = own.find(s.tool_change().tool); found != own.end()) tools.insert(*found);
  }
  return tools;
}

}  // namespace

design::MachineOptions machine_services(Progress* progress) {
  design::MachineOptions options;
  options.tools = &built_in_tools();
  options.progress = progress;
  options.load_stock = [](const std::string& file, Diagnostics& diagnostics) {
    return load_stock(file, diagnostics);
  };
  options.read_program = [progress](const std::string& file, Diagnostics& diagnostics) {
    return read_program(file, diagnostics, progress);
  };
  options.check_line = reason_against;
  options.left_stock = [progress](const design::CutSide& side, Diagnostics& diagnostics) {
    return left_stock(side, diagnostics, progress);
  };
  return options;
}

void post_design(const DesignProgram& made, const std::map<int, Tool>& own, std::vector<DesignFile>& files,
                 Diagnostics& diagnostics, Progress* progress) {
  const auto target = target_of(made.post, diagnostics);
  if (!target) return;
  Program program;
  program.source = made.name;
  program.path = made.path;
  program.tools = changed_to(made.path, own);
  PostingOptions options;
  options.missing_feed = made.missing_feed;
  const auto texts = post_program(program, *target, options, diagnostics, progress);
  const std::vector<std::string> names = posted_file_names(made.name, texts);
  for (std::size_t i = 0; i < texts.size(); ++i) files.push_back({names[i], texts[i].text});
}

std::optional<std::vector<DesignFile>> scad_files(const ScadJob& job, Diagnostics& diagnostics,
                                                  Progress* progress) {
  const std::size_t errors = diagnostics.errors();
  std::vector<DesignFile> files = job.files;
  for (const DesignProgram& program : job.programs)
    post_design(program, job.program.tools, files, diagnostics, progress);
  if (diagnostics.errors() > errors || stop_requested(progress)) return std::nullopt;
  return files;
}

}  // namespace kerf

// Running a script; its traceback as a diagnostic.
#include "app/view/script.h"

#include <algorithm>
#include <fmt/format.h>

#include "app/shown/printed.h"
#include "base/codes/files.h"
#include "base/file_names.h"
#include "base/split.h"
#include "base/system.h"
#include "job/python_script.h"

#include "kerf/base/files.h"

namespace kerf::app::view {
namespace {

constexpr const char* kOutputName = "/output.txt";

std::string text_of(const std::string& path) {
  Diagnostics ignored;
  const auto file = exists(path) ? InputFile::open(path, ignored) : std::nullopt;
  return file ? std::string(file->bytes()) : std::string();
}

/// The files of a program's lines, the script first. Python names it by its whole path, which becomes the
/// given one.
std::vector<std::string> name_files(OriginTable& origins, const std::string& script) {
  const std::string whole = normal_path(absolute_path(script));
  std::vector<std::string> files{script};
  for (std::uint32_t k = 0; k < origins.files().size(); ++k) {
    const std::string name = origins.files()[k];
    if (name == script || name.empty()) continue;
    if (normal_path(absolute_path(name)) != whole)
      files.push_back(name);
    else if (std::find(origins.files().begin(), origins.files().end(), script) == origins.files().end())
      origins.rename_file(k, script);
  }
  return files;
}

}  // namespace

std::string ScriptRun::output() const {
  if (folder_.path().empty()) return {};
  return shown_end(text_of(folder_.path() + kOutputName));
}

bool is_script(const std::string& file) { return extension_of(file) == ".py"; }

std::optional<Program> ScriptRun::load(const std::string& script, const ProgramOptions& options,
                                       std::vector<std::string>& used, Diagnostics& diagnostics,
                                       Progress* progress) {
  used = {script};
  if (!InputFile::open(script, diagnostics)) return std::nullopt;
  const TextLocation whole{script, 0, 0};
  if (folder_.path().empty()) folder_ = TemporaryFolder("kerf-script");
  if (folder_.path().empty()) {
    diagnostics.error(codes::script_failed, whole, "cannot create a temporary folder");
    return std::nullopt;
  }
  const std::string made = folder_.path() + "/program.kerf";
  const std::string output = folder_.path() + kOutputName;
  remove_file(made);
  ScriptOptions how;
  how.environment = {{"KERF_VIEW_PROGRAM", made}};
  how.output_file = output;
  how.progress = progress;
  warn_of_hidden_module(script, diagnostics);
  const int status = run_python(script, how, diagnostics);
  if (diagnostics.has_errors() || stop_requested(progress)) return std::nullopt;
  for (std::string& file : lines_of(text_of(made + ".imports"))) used.push_back(std::move(file));
  if (file_stamp(output).size >= kMaxScriptOutput) {
    diagnostics.error(codes::script_failed, whole,
                      fmt::format("the script prints more than {} MB", kMaxScriptOutput >> 20));
    return std::nullopt;
  }
  if (status != 0) {
    add_script_failure(script, status, text_of(output), diagnostics);
    return std::nullopt;
  }
  if (!exists(made)) {
    diagnostics.error(codes::script_failed, whole, "the script makes no toolpath").hint =
        "a toolpath is shown that is simulated, written, or ended as a kerf.Job";
    return std::nullopt;
  }
  auto program = load_program(made, options, diagnostics, progress);
  if (!program) return std::nullopt;
  program->source = script;
  program->front_end = "Python";
  program->files = name_files(program->path.origins(), script);
  return program;
}

}  // namespace kerf::app::view

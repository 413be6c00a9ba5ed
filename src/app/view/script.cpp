// Running a script; its traceback as a diagnostic.
#include "app/view/script.h"

#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <sstream>

#include "kerf/files.h"
#include "kerf/python_script.h"

namespace kerf::app::view {
namespace {

constexpr std::size_t kOutputEnd = 16'384;  // bytes of the output in which a traceback is searched

std::string text_of(const std::string& path) {
  Diagnostics ignored;
  const auto file = std::filesystem::exists(path) ? InputFile::open(path, ignored) : std::nullopt;
  return file ? std::string(file->bytes()) : std::string();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) lines.push_back(std::move(line));
  return lines;
}

/// The last error of the script: its message, at the innermost line of the script itself.
void add_failure(const std::string& script, int status, const std::string& output, Diagnostics& diagnostics) {
  const std::vector<std::string> lines =
      lines_of(output.substr(output.size() - std::min(output.size(), kOutputEnd)));
  const std::string mark = fmt::format("File \"{}\", line ", script);
  std::uint32_t at = 0;
  for (const std::string& line : lines) {
    const std::size_t found = line.find(mark);
    if (found == std::string::npos) continue;
    std::from_chars(line.data() + found + mark.size(), line.data() + line.size(), at);
  }
  const std::string message =
      lines.empty() ? fmt::format("the script ended with exit status {}", status) : lines.back();
  diagnostics.error(Code::script_failed, TextLocation{script, at, 0}, message);
}

}  // namespace

bool is_script(const std::string& file) { return std::filesystem::path(file).extension() == ".py"; }

ScriptRun::~ScriptRun() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

std::optional<Program> ScriptRun::load(const std::string& script, const ProgramOptions& options,
                                       std::vector<std::string>& used, Diagnostics& diagnostics,
                                       Progress* progress) {
  used = {script};
  if (!InputFile::open(script, diagnostics)) return std::nullopt;
  const TextLocation whole{script, 0, 0};
  if (folder_.empty()) {
    std::string pattern = (std::filesystem::temp_directory_path() / "kerf-script-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
      diagnostics.error(Code::script_failed, whole, "cannot create a temporary folder");
      return std::nullopt;
    }
    folder_ = pattern;
  }
  const std::string made = folder_ + "/" + std::filesystem::path(script).stem().string() + ".nc";
  const std::string output = folder_ + "/output.txt";
  std::error_code ignored;
  std::filesystem::remove(made, ignored);
  ScriptOptions how;
  how.environment = {{"KERF_VIEW_PROGRAM", made}};
  how.output_file = output;
  how.progress = progress;
  const int status = run_python(script, how, diagnostics);
  if (diagnostics.has_errors() || stop_requested(progress)) return std::nullopt;
  for (std::string& file : lines_of(text_of(made + ".imports"))) used.push_back(std::move(file));
  if (status != 0) {
    add_failure(script, status, text_of(output), diagnostics);
    return std::nullopt;
  }
  if (!std::filesystem::exists(made, ignored)) {
    diagnostics.error(Code::script_failed, whole, "the script makes no toolpath").hint =
        "a toolpath is shown that is simulated, written, or ended as a kerf.Job";
    return std::nullopt;
  }
  auto program = load_program(made, options, diagnostics, progress);
  if (!program) return std::nullopt;
  program->source = script;
  program->front_end = "Python";
  program->files.insert(program->files.begin(), script);
  return program;
}

}  // namespace kerf::app::view

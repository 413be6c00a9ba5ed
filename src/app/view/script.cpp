// Running a script; its traceback as a diagnostic.
#include "app/view/script.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <sstream>

#include "base/codes/files.h"
#include "base/file_names.h"
#include "base/system.h"
#include "job/python_script.h"

#include "kerf/base/files.h"

namespace kerf::app::view {
namespace {

constexpr std::size_t kShownOutput = 65'536;  // bytes that a page shows
constexpr std::size_t kOutputEnd = 16'384;    // bytes of the output in which a traceback is searched

constexpr const char* kOutputName = "/output.txt";

std::string text_of(const std::string& path) {
  Diagnostics ignored;
  const auto file = exists(path) ? InputFile::open(path, ignored) : std::nullopt;
  return file ? std::string(file->bytes()) : std::string();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) lines.push_back(std::move(line));
  return lines;
}

/// A line of a traceback: `  File "/part.py", line 7, in cut`.
struct Frame {
  std::string file;
  std::uint32_t line = 0;
};
std::optional<Frame> frame_of(const std::string& line) {
  constexpr std::string_view kFile = "File \"", kLine = "\", line ";
  const std::size_t start = line.find_first_not_of(' ');
  if (start == std::string::npos || line.compare(start, kFile.size(), kFile) != 0) return std::nullopt;
  const std::size_t end = line.rfind(kLine);
  if (end == std::string::npos || end < start + kFile.size()) return std::nullopt;
  Frame frame{line.substr(start + kFile.size(), end - start - kFile.size()), 0};
  const char* const digits = line.data() + end + kLine.size();
  if (std::from_chars(digits, line.data() + line.size(), frame.line).ec != std::errc()) return std::nullopt;
  return frame;
}

/// The last error of the script: its message, at the innermost line of the script itself or of a module
/// beside it, and the lines that called it, innermost first.
void add_failure(const std::string& script, int status, const std::string& output, Diagnostics& diagnostics) {
  const std::vector<std::string> lines =
      lines_of(output.substr(output.size() - std::min(output.size(), kOutputEnd)));
  const std::string whole = normal_path(absolute_path(script));
  std::vector<Frame> frames;
  for (const std::string& line : lines) {
    if (line.rfind("Traceback ", 0) == 0) frames.clear();  // an error while another one was handled
    auto frame = frame_of(line);
    if (!frame) continue;
    const std::string file = normal_path(absolute_path(frame->file));
    if (file == whole) frame->file = script;
    if (file == whole || parent_of(file) == parent_of(whole)) frames.push_back(std::move(*frame));
  }
  const std::string message =
      lines.empty() ? fmt::format("the script ended with exit status {}", status) : lines.back();
  const Frame at = frames.empty() ? Frame{script, 0} : frames.back();
  Diagnostic& error = diagnostics.error(codes::script_failed, TextLocation{at.file, at.line, 0}, message);
  for (std::size_t k = frames.size(); k > 1; --k)
    error.hint += fmt::format("{}called from {}:{}", error.hint.empty() ? "" : ", ",
                              file_name_of(frames[k - 2].file), frames[k - 2].line);
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
  const std::string text = text_of(folder_.path() + kOutputName);
  return text.substr(text.size() - std::min(text.size(), kShownOutput));
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
    add_failure(script, status, text_of(output), diagnostics);
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

// Running Python: choice of the interpreter, its environment and its exit status.
#include "job/python_script.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <fmt/format.h>
#include <optional>

#include "base/codes/files.h"
#include "base/file_names.h"
#include "base/process.h"
#include "base/split.h"
#include "base/system.h"

namespace kerf {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

#if defined(_WIN32)
constexpr char kPathSeparator = ';';
constexpr const char *kVenvPython = "/Scripts/python.exe", *kPython = "python";
#else
constexpr char kPathSeparator = ':';
constexpr const char *kVenvPython = "/bin/python", *kPython = "python3";
#endif

std::string interpreter() {
  if (const std::string given = variable("KERF_PYTHON"); !given.empty()) return given;
  if (const std::string venv = variable("VIRTUAL_ENV"); !venv.empty()) return venv + kVenvPython;
  return kPython;
}

/// PYTHONPATH with the folder of Kerf's modules before what it has.
std::string module_path(const std::string& folder) {
  const std::string present = variable("PYTHONPATH");
  return present.empty() ? folder : folder + kPathSeparator + present;
}

constexpr std::size_t kOutputEnd = 16'384;  // bytes of the output in which a traceback is searched

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

}  // namespace

std::string python_module_folder() {
  const auto command = command_file();
  if (!command) return "";
  for (const char* relative : {"python", "../lib/kerf/python"}) {
    const std::string folder = normal_path(path_in(parent_of(*command), relative));
    if (is_folder(path_in(folder, "kerf"))) return folder;
  }
  return "";
}

void warn_of_hidden_module(const std::string& script, Diagnostics& diagnostics) {
  for (const char* name : {"kerf.py", "kerf/__init__.py"}) {
    const std::string file = path_in(parent_of(script), name);
    if (!is_regular_file(file)) continue;
    if (is_regular_file(path_in(parent_of(file), "_kerf.pyi"))) continue;  // Kerf's own
    diagnostics
        .warning(codes::module_hidden, TextLocation{file, 0, 0},
                 "\"import kerf\" finds this file instead of Kerf's module")
        .hint = "rename it";
  }
}

int run_python(const std::string& script, const ScriptOptions& options, Diagnostics& diagnostics) {
  std::vector<std::string> words{interpreter(), script};
  words.insert(words.end(), options.arguments.begin(), options.arguments.end());
  ProcessOptions how;
  if (const std::string folder = python_module_folder(); !folder.empty())
    how.environment.emplace_back("PYTHONPATH", module_path(folder));
  how.environment.insert(how.environment.end(), options.environment.begin(), options.environment.end());
  how.output_to_error = options.output == ScriptOutput::to_stderr;
  how.error_end = options.error_end;
  how.output_file = options.output_file;
  how.output_limit = options.output_file.empty() ? 0 : kMaxScriptOutput;
  how.progress = options.progress;
  const auto fail = [&](const std::string& message) {
    diagnostics.error(codes::script_failed, TextLocation{script, 0, 0}, message);
    return -1;
  };
  const ProcessEnd end = run_process(words, how);
  using Kind = ProcessEnd::Kind;
  switch (end.kind) {
    case Kind::exited: return end.number;
    case Kind::stopped: return -1;
    case Kind::output_limit: return -1;
    case Kind::ended_by_signal: return fail(fmt::format("the script was ended by signal {}", end.number));
    case Kind::not_found:
      return fail(fmt::format("cannot run \"{}\"; set KERF_PYTHON to a Python interpreter", words[0]));
    case Kind::not_started: break;
  }
  return fail("cannot start a process");
}

void add_script_failure(const std::string& script, int status, const std::string& output,
                        Diagnostics& diagnostics) {
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

}  // namespace kerf

// Running Python: choice of the interpreter, its environment and its exit status.
#include "job/python_script.h"

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/codes/files.h"

namespace kerf {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::string interpreter() {
  if (const std::string given = variable("KERF_PYTHON"); !given.empty()) return given;
  if (const std::string venv = variable("VIRTUAL_ENV"); !venv.empty()) return venv + "/bin/python";
  return "python3";
}

/// The folder of Kerf's Python modules: next to the command in a build folder, or below the prefix where the
/// command is installed; empty if the interpreter has them (a wheel).
std::string module_folder() {
  std::error_code failed;
  const auto command = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (failed) return "";
  for (const char* relative : {"python", "../lib/kerf/python"}) {
    const auto folder = (command.parent_path() / relative).lexically_normal();
    if (std::filesystem::is_directory(folder / "kerf", failed)) return folder.string();
  }
  return "";
}

/// The environment of the script as "NAME=value" texts.
std::vector<std::string> environment_of(const std::vector<std::pair<std::string, std::string>>& added) {
  std::map<std::string, std::string> variables;
  for (char** v = environ; *v != nullptr; ++v) {
    const std::string text = *v;
    const std::size_t equals = text.find('=');
    if (equals != std::string::npos) variables[text.substr(0, equals)] = text.substr(equals + 1);
  }
  if (const std::string folder = module_folder(); !folder.empty()) {
    std::string& path = variables["PYTHONPATH"];
    path = path.empty() ? folder : folder + ":" + path;
  }
  for (const auto& [name, value] : added) variables[name] = value;
  std::vector<std::string> texts;
  for (const auto& [name, value] : variables) texts.push_back(name + "=" + value);
  return texts;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> list;
  for (std::string& text : texts) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

constexpr useconds_t kPoll = 3000;  // microseconds

/// In the child: where its output goes, and a process group of its own, so that all of it can be ended.
void prepare_child(const ScriptOptions& options) {
  if (options.progress != nullptr) setpgid(0, 0);
  if (!options.output_file.empty()) {
    const rlimit limit{kMaxScriptOutput, kMaxScriptOutput};
    setrlimit(RLIMIT_FSIZE, &limit);
    const int file = open(options.output_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
  } else if (options.output == ScriptOutput::to_stderr) {
    dup2(STDERR_FILENO, STDOUT_FILENO);
  }
}

/// The status of the child once it has ended, by itself or because the progress asked for it; nothing if that
/// fails.
std::optional<int> wait_for(pid_t child, Progress* progress) {
  int status = 0;
  for (;;) {
    const pid_t ended = waitpid(child, &status, progress != nullptr ? WNOHANG : 0);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) return std::nullopt;
    if (progress == nullptr) continue;
    if (progress->stop_requested()) {
      kill(-child, SIGKILL);
      progress = nullptr;
    } else {
      usleep(kPoll);
    }
  }
}

}  // namespace

int run_python(const std::string& script, const ScriptOptions& options, Diagnostics& diagnostics) {
  std::vector<std::string> words{interpreter(), script}, variables = environment_of(options.environment);
  words.insert(words.end(), options.arguments.begin(), options.arguments.end());
  const std::vector<char*> arguments = pointers(words), environment_texts = pointers(variables);
  const auto fail = [&](const std::string& message) {
    diagnostics.error(codes::script_failed, TextLocation{script, 0, 0}, message);
    return -1;
  };
  const pid_t child = fork();
  if (child < 0) return fail("cannot start a process");
  if (child == 0) {
    prepare_child(options);
    execvpe(arguments[0], arguments.data(), environment_texts.data());
    _exit(127);  // the status of a shell for a missing command
  }
  if (options.progress != nullptr) setpgid(child, child);  // whichever process comes first
  const std::optional<int> ended = wait_for(child, options.progress);
  if (!ended) return fail("cannot wait for the end of the script");
  if (options.progress != nullptr && options.progress->stop_requested()) return -1;
  const int status = *ended;
  if (!WIFEXITED(status)) return fail(fmt::format("the script was ended by signal {}", WTERMSIG(status)));
  if (WEXITSTATUS(status) == 127)
    return fail(fmt::format("cannot run \"{}\"; set KERF_PYTHON to a Python interpreter", words[0]));
  return WEXITSTATUS(status);
}

}  // namespace kerf

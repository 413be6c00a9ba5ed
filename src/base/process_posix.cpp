// Processes by POSIX: fork, exec and process groups.
#include "base/process.h"

#if !defined(_WIN32)
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <optional>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kerf {
namespace {

constexpr useconds_t kPoll = 3000;    // microseconds
constexpr int kCommandMissing = 127;  // the status of a shell for a missing command

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> list;
  for (std::string& text : texts) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

/// In the child: its environment, where its output goes, and a process group of its own, so that all of it
/// can be ended.
void prepare_child(const ProcessOptions& options) {
  for (const auto& [name, value] : options.environment) setenv(name.c_str(), value.c_str(), 1);
  if (options.progress != nullptr) setpgid(0, 0);
  if (options.output_limit != 0) {
    const rlimit limit{options.output_limit, options.output_limit};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  if (!options.output_file.empty()) {
    const int file = open(options.output_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
  } else if (options.output_to_error) {
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

ProcessEnd run_process(const std::vector<std::string>& words, const ProcessOptions& options) {
  using Kind = ProcessEnd::Kind;
  std::vector<std::string> texts = words;
  const std::vector<char*> arguments = pointers(texts);
  const pid_t child = fork();
  if (child < 0) return {Kind::not_started};
  if (child == 0) {
    prepare_child(options);
    execvp(arguments[0], arguments.data());
    _exit(kCommandMissing);
  }
  if (options.progress != nullptr) setpgid(child, child);  // whichever process comes first
  const std::optional<int> status = wait_for(child, options.progress);
  if (!status) return {Kind::not_started};
  if (stop_requested(options.progress)) return {Kind::stopped};
  if (!WIFEXITED(*status)) return {Kind::ended_by_signal, WTERMSIG(*status)};
  if (WEXITSTATUS(*status) == kCommandMissing) return {Kind::not_found};
  return {Kind::exited, WEXITSTATUS(*status)};
}

bool start_detached(const std::vector<std::string>& words) {
  std::vector<std::string> texts = words;
  const std::vector<char*> arguments = pointers(texts);
  const pid_t child = fork();
  if (child < 0) return false;
  if (child == 0) {
    setsid();
    if (fork() != 0) _exit(0);  // the grandchild is no child of this process
    const int nothing = ::open("/dev/null", O_RDWR);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, stream);
    execvp(arguments[0], arguments.data());
    _exit(kCommandMissing);
  }
  int status = 0;
  return waitpid(child, &status, 0) == child;
}

}  // namespace kerf
#endif

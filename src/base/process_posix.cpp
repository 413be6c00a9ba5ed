// Processes by POSIX: fork, exec and process groups.
#include "base/process.h"

#if !defined(_WIN32)
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <optional>
#include <poll.h>
#include <sys/stat.h>
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

/// Copies what comes through a pipe to standard error, and keeps its end.
class ErrorCopy {
 public:
  explicit ErrorCopy(std::string* end) : end_(end) {
    if (end_ != nullptr && pipe(ends_) != 0) end_ = nullptr;
    if (end_ != nullptr) fcntl(ends_[0], F_SETFD, FD_CLOEXEC);
  }
  ErrorCopy(const ErrorCopy&) = delete;
  ErrorCopy& operator=(const ErrorCopy&) = delete;
  ~ErrorCopy() { close_end(0), close_end(1); }

  void take_in_child() {
    if (end_ == nullptr) return;
    dup2(ends_[1], STDERR_FILENO);
    close(ends_[1]);
  }
  /// Until all writers have ended, or the child has; what it has started and left may write on.
  void copy_until_end(pid_t child) {
    if (end_ == nullptr) return;
    close_end(1);
    for (bool is_over = false;;) {
      pollfd waiting{ends_[0], POLLIN, 0};
      const int ready = poll(&waiting, 1, is_over ? 0 : kPipePoll);
      if (ready > 0) {
        if (!copy_some()) return;
      } else if (is_over) {
        return;
      }
      siginfo_t info{};
      is_over = waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOWAIT | WNOHANG) != 0 ||
                info.si_pid == child;
    }
  }

 private:
  static constexpr int kPipePoll = 20;  // ms

  bool copy_some() {
    char bytes[4096];
    const ssize_t count = read(ends_[0], bytes, sizeof bytes);
    if (count < 0) return errno == EINTR;
    if (count == 0) return false;
    const auto size = static_cast<std::size_t>(count);
    for (std::size_t at = 0; at < size;) {
      const ssize_t written = write(STDERR_FILENO, bytes + at, size - at);
      if (written <= 0 && errno != EINTR) break;
      if (written > 0) at += static_cast<std::size_t>(written);
    }
    end_->append(bytes, size);
    if (end_->size() > 2 * kErrorEnd) end_->erase(0, end_->size() - kErrorEnd);
    return true;
  }
  void close_end(int which) {
    if (ends_[which] >= 0) close(ends_[which]);
    ends_[which] = -1;
  }

  std::string* end_;
  int ends_[2] = {-1, -1};
};

/// In the child: its environment, where its output goes, and a process group of its own, so that all of it
/// can be ended.
void prepare_child(const ProcessOptions& options, ErrorCopy& copy) {
  copy.take_in_child();
  for (const auto& [name, value] : options.environment) setenv(name.c_str(), value.c_str(), 1);
  if (options.progress != nullptr) setpgid(0, 0);
  if (!options.output_file.empty()) {
    const int file = open(options.output_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
  } else if (options.output_to_error) {
    dup2(STDERR_FILENO, STDOUT_FILENO);
  }
}

bool has_too_much_output(const ProcessOptions& options) {
  struct stat found {};
  return options.output_limit != 0 && stat(options.output_file.c_str(), &found) == 0 &&
         static_cast<std::size_t>(found.st_size) >= options.output_limit;
}

struct ChildEnd {
  int status = 0;
  bool had_too_much_output = false;
};

/// The end of the child, by itself or because the progress or the limit of its output asked for it; nothing
/// if that fails. With a progress, what is left of its process group ends as well.
std::optional<ChildEnd> wait_for(pid_t child, const ProcessOptions& options) {
  ChildEnd end;
  const bool has_group = options.progress != nullptr;
  for (bool is_killed = false;;) {
    siginfo_t info{};
    // The child is not taken yet: its number stays that of its group.
    const int flags = WEXITED | WNOWAIT | (has_group && !is_killed ? WNOHANG : 0);
    if (waitid(P_PID, static_cast<id_t>(child), &info, flags) < 0 && errno != EINTR) return std::nullopt;
    if (info.si_pid == child) break;
    if (!has_group || is_killed) continue;
    end.had_too_much_output = has_too_much_output(options);
    is_killed = end.had_too_much_output || options.progress->stop_requested();
    if (is_killed)
      kill(-child, SIGKILL);
    else
      usleep(kPoll);
  }
  if (has_group) kill(-child, SIGKILL);
  if (waitpid(child, &end.status, 0) != child) return std::nullopt;
  return end;
}

}  // namespace

ProcessEnd run_process(const std::vector<std::string>& words, const ProcessOptions& options) {
  using Kind = ProcessEnd::Kind;
  std::vector<std::string> texts = words;
  const std::vector<char*> arguments = pointers(texts);
  ErrorCopy copy(options.error_end);
  const pid_t child = fork();
  if (child < 0) return {Kind::not_started};
  if (child == 0) {
    prepare_child(options, copy);
    execvp(arguments[0], arguments.data());
    _exit(kCommandMissing);
  }
  if (options.progress != nullptr) setpgid(child, child);  // whichever process comes first
  if (options.progress == nullptr) copy.copy_until_end(child);
  const std::optional<ChildEnd> end = wait_for(child, options);
  if (!end) return {Kind::not_started};
  if (stop_requested(options.progress)) return {Kind::stopped};
  if (end->had_too_much_output) return {Kind::output_limit};
  if (!WIFEXITED(end->status)) return {Kind::ended_by_signal, WTERMSIG(end->status)};
  if (WEXITSTATUS(end->status) == kCommandMissing) return {Kind::not_found};
  return {Kind::exited, WEXITSTATUS(end->status)};
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

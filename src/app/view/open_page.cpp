// Starting a browser.
#include "app/view/open_page.h"

#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "kerf/base/files.h"

namespace kerf::app::view {
namespace {

/// In a process of its own that outlives this one and is not its child, so that it need not be waited for.
bool start_detached(const char* program, const std::string& file) {
  const pid_t child = fork();
  if (child < 0) return false;
  if (child == 0) {
    setsid();
    if (fork() != 0) _exit(0);
    const int nothing = ::open("/dev/null", O_RDWR);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, stream);
    execlp(program, program, file.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  return waitpid(child, &status, 0) == child;
}

}  // namespace

OpenedPage::~OpenedPage() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

bool OpenedPage::open(const std::string& address) {
  std::string pattern = (std::filesystem::temp_directory_path() / "kerf-view-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) return false;
  folder_ = pattern;
  const std::string file = folder_ + "/view.html";
  Diagnostics diagnostics;
  OutputSet files;
  const std::string text = fmt::format(
      "<!doctype html><meta http-equiv=\"refresh\" content=\"0;url={}\"><title>kerf view</title>\n", address);
  if (!files.write(file, text, diagnostics) || !files.commit(diagnostics)) return false;
  const char* given = std::getenv("BROWSER");
  return start_detached(given != nullptr && *given != '\0' ? given : "xdg-open", file);
}

}  // namespace kerf::app::view

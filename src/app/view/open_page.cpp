// Starting a browser.
#include "app/view/open_page.h"

#include <cstdlib>
#include <fmt/format.h>

#include "base/file_names.h"
#include "base/process.h"

#include "kerf/base/files.h"

namespace kerf::app::view {
namespace {

#if defined(_WIN32)
constexpr const char* kBrowser = "explorer";
#elif defined(__APPLE__)
constexpr const char* kBrowser = "open";
#else
constexpr const char* kBrowser = "xdg-open";
#endif

}  // namespace

bool OpenedPage::open(const std::string& address) {
  folder_ = TemporaryFolder("kerf-view");
  if (folder_.path().empty()) return false;
  const std::string file = path_in(folder_.path(), "view.html");
  Diagnostics diagnostics;
  OutputSet files;
  const std::string text = fmt::format(
      "<!doctype html><meta http-equiv=\"refresh\" content=\"0;url={}\"><title>kerf view</title>\n", address);
  if (!files.write(file, text, diagnostics) || !files.commit(diagnostics)) return false;
  const char* given = std::getenv("BROWSER");
  return start_detached({given != nullptr && *given != '\0' ? given : kBrowser, file});
}

}  // namespace kerf::app::view

// The version, what the command was built with, and what this build contains.
#include "app/version.h"

#include <fmt/format.h>
#include <string_view>

#include "app/view/page.h"
#include "build_info.h"
#include "job/python_script.h"

namespace kerf::app {

std::string version_text() {
  std::string build = KERF_BUILD_COMPILER ", " KERF_BUILD_TYPE ", " KERF_BUILD_SYSTEM;
  if (constexpr std::string_view sanitize = KERF_BUILD_SANITIZE; !sanitize.empty())
    build += fmt::format(", sanitizers {}", sanitize);
  constexpr std::string_view commit = KERF_BUILD_COMMIT;
  build += commit.empty() ? ", commit unknown" : fmt::format(", commit {}", commit);
  const std::string modules = python_module_folder();
  return fmt::format("kerf {}\nbuild: {}\nfeatures: {} page of kerf view, Python modules {}", KERF_VERSION,
                     build, view::has_full_page() ? "full" : "simple",
                     modules.empty() ? "by the interpreter" : "in " + modules);
}

}  // namespace kerf::app

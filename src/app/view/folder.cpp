// Paths are compared as the file system resolves them, so that neither ".." nor a link leads out of the
// folder.
#include "app/view/folder.h"

#include <algorithm>

#include "app/shown/file_name.h"
#include "base/ending.h"
#include "base/file_names.h"

#include "kerf/base/files.h"
#include "kerf/formats/mesh_files.h"
#include "kerf/job/program.h"

namespace kerf::app::view {
namespace {

constexpr std::size_t kMaxNames = 500;

}  // namespace

bool can_view(std::string_view name) {
  const std::string ending = ending_of(name);
  if (ending == ".py" || ending == ".json" || ending == ".svg" || mesh_format_of(name)) return true;
  const auto reads = [&](const FrontEnd& front_end) {
    return std::find(front_end.endings.begin(), front_end.endings.end(), ending) != front_end.endings.end();
  };
  return std::any_of(front_ends().begin(), front_ends().end(), reads);
}

Folder::Folder(const std::string& file) {
  const std::string parent = parent_of(file);
  folder_ = canonical_path(parent.empty() ? "." : parent).value_or("");
}

std::vector<std::string> Folder::names() const {
  std::vector<std::string> names;
  for (std::string& name : names_in(folder_).value_or(std::vector<std::string>()))
    if (name.front() != '.' && can_view(name) && is_regular_file(path_in(folder_, name)))
      names.push_back(std::move(name));
  std::sort(names.begin(), names.end());
  if (names.size() > kMaxNames) names.resize(kMaxNames);
  return names;
}

std::optional<std::string> Folder::find(std::string_view name) const {
  if (folder_.empty() || name.empty() || name.find('\0') != std::string_view::npos) return std::nullopt;
  auto found = canonical_path(path_in(folder_, name));
  if (!found || !is_regular_file(*found) || !is_below(folder_, *found)) return std::nullopt;
  return found;
}

Folder::Kept Folder::keep(std::string_view name, std::string_view bytes) {
  if (!can_view(name)) return {"", "files of this kind cannot be viewed; there are: " + known_endings()};
  if (ending_of(name) == ".py")
    return {"", "scripts run with all rights of their user: start kerf view with it"};
  if (ending_of(name) == ".toml")
    return {"",
            "cutting jobs name files beside them: put it into the folder of the program, or start kerf view "
            "with it"};
  if (kept_.path().empty()) kept_ = TemporaryFolder("kerf-view");
  if (kept_.path().empty()) return {"", "there is no folder for temporary files"};
  const std::string path = kept_.path() + "/" + download_name(name);
  Diagnostics ignored;
  OutputSet files;
  if (!files.write(path, bytes, ignored) || !files.commit(ignored)) return {"", "the file cannot be stored"};
  return {path, ""};
}

}  // namespace kerf::app::view

// Paths are compared as the file system resolves them, so that neither ".." nor a link leads out of the
// folder.
#include "app/view/folder.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "app/shown/file_name.h"
#include "base/ending.h"

#include "kerf/formats/mesh_files.h"
#include "kerf/job/program.h"

namespace kerf::app::view {
namespace {

namespace fs = std::filesystem;

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
  std::error_code failed;
  const fs::path parent = fs::path(file).parent_path();
  folder_ = fs::canonical(parent.empty() ? fs::path(".") : parent, failed).string();
}

std::vector<std::string> Folder::names() const {
  std::vector<std::string> names;
  std::error_code failed;
  for (fs::directory_iterator entry(folder_, failed), end; !failed && entry != end; entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    std::error_code ignored;
    if (name.front() != '.' && can_view(name) && entry->is_regular_file(ignored)) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  if (names.size() > kMaxNames) names.resize(kMaxNames);
  return names;
}

std::optional<std::string> Folder::find(std::string_view name) const {
  if (folder_.empty() || name.empty() || name.find('\0') != std::string_view::npos) return std::nullopt;
  std::error_code failed;
  const fs::path path = fs::canonical(fs::path(folder_) / name, failed);
  if (failed || !fs::is_regular_file(path, failed)) return std::nullopt;
  const std::string below = folder_ == "/" ? folder_ : folder_ + "/", found = path.string();
  if (found.compare(0, below.size(), below) != 0) return std::nullopt;
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
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) return {"", "the file cannot be stored"};
  return {path, ""};
}

}  // namespace kerf::app::view

// The drawings of a run, and the search for sub-paths.
#include "front/pathdxf/model/library.h"

#include <algorithm>

#include "base/codes/pathdxf.h"
#include "base/ending.h"
#include "base/file_names.h"

namespace kerf::pathdxf {
namespace {

constexpr Bilingual kNoFolder{"the folder {} to be searched does not exist",
                              "Das zu durchsuchende Verzeichnis {} existiert nicht"};
constexpr Bilingual kReading{"Reading {}", "Lese {}"};
constexpr Bilingual kReadingVersion{"Reading {} (DXF version: {})", "Lese {} (DXF-Version: {})"};
constexpr Bilingual kTwice{"Path {} has already been defined in {}", "Pfad {} ist bereits definiert in {}"};

constexpr std::size_t kMaxFolderEntries = 100'000;
constexpr std::string_view kEnding = ".dxf";

bool is_drawing(const std::string& name) { return name.size() > kEnding.size() && has_ending(name, kEnding); }

}  // namespace

const DrawingPaths& Library::load(const std::string& file) {
  const auto [known, is_new] =
      by_file_.try_emplace(options_.read_file ? file : resolved_path(file), drawings_.size());
  if (!is_new) return *drawings_[known->second];
  auto drawing = std::make_unique<DrawingPaths>(read_drawing(file, names_, options_, report_));
  if (drawing->version.empty())
    report_.line(kReading, known->first);
  else
    report_.line(kReadingVersion, known->first, drawing->version);
  drawings_.push_back(std::move(drawing));
  const DrawingPaths& added = *drawings_.back();
  for (const PathDrawing& path : added.paths) {
    const auto [earlier, first] = by_name_.try_emplace(path.name, Found{&added, &path});
    if (!first)
      report_.error(codes::pathdxf_defined_twice, added.origin(path), kTwice,
                    name_in_file(*earlier->second.path, *earlier->second.drawing),
                    earlier->second.drawing->file);
  }
  return added;
}

std::vector<std::string> Library::drawings_in(const std::string& folder) {
  std::vector<std::string> names;
  if (options_.list_files) {
    names = options_.list_files(folder);
  } else {
    auto entries = names_in(folder.empty() ? "." : folder, kMaxFolderEntries);
    if (!entries) report_.error(codes::pathdxf_folder, {}, kNoFolder, folder);
    names = std::move(entries).value_or(std::vector<std::string>());
  }
  names.erase(
      std::remove_if(names.begin(), names.end(), [](const std::string& name) { return !is_drawing(name); }),
      names.end());
  std::sort(names.begin(), names.end());
  return names;
}

void Library::search(const std::string& folder, const std::string& name) {
  const auto [listed, is_new] = folders_.try_emplace(folder);
  if (is_new) listed->second = drawings_in(folder);
  for (const std::string& entry : listed->second)
    if (names_.may_contain(std::string_view(entry).substr(0, entry.size() - kEnding.size()), name))
      load(folder + entry);
}

Library::Found Library::find(const std::string& name, const std::string& folder) {
  if (const auto known = by_name_.find(name); known != by_name_.end()) return known->second;
  search(folder, name);
  for (std::string other : options_.folders) {
    if (!other.empty() && other.back() != '/' && other.back() != '\\') other += '/';
    search(other, name);
  }
  const auto known = by_name_.find(name);
  return known != by_name_.end() ? known->second : Found{};
}

std::vector<std::string> Library::files() const {
  std::vector<std::string> list;
  for (const auto& drawing : drawings_) list.push_back(drawing->file);
  return list;
}

}  // namespace kerf::pathdxf

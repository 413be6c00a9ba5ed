// Stamps of files.
#include "app/view/watch.h"

#include <algorithm>

namespace kerf::app::view {

void FileWatch::set(std::vector<std::string> files) {
  files_.clear();
  add(files);
}

void FileWatch::add(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    const bool known = std::any_of(files_.begin(), files_.end(),
                                   [&](const Watched& watched) { return watched.file == file; });
    if (!known && file != "-") files_.push_back({file, file_stamp(file)});
  }
}

bool FileWatch::has_changed() const {
  return std::any_of(files_.begin(), files_.end(),
                     [](const Watched& watched) { return !(file_stamp(watched.file) == watched.stamp); });
}

void FileWatch::take() {
  for (Watched& watched : files_) watched.stamp = file_stamp(watched.file);
}

}  // namespace kerf::app::view

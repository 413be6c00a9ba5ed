// Stamps of files.
#include "app/view/watch.h"

#include <algorithm>
#include <sys/stat.h>

namespace kerf::app::view {

FileWatch::Stamp FileWatch::stamp_of(const std::string& file) {
  struct stat info {};
  if (stat(file.c_str(), &info) != 0) return {};
  return {true,
          static_cast<unsigned long>(info.st_dev),
          static_cast<unsigned long>(info.st_ino),
          static_cast<unsigned long>(info.st_size),
          info.st_mtim.tv_sec,
          info.st_mtim.tv_nsec};
}

void FileWatch::set(std::vector<std::string> files) {
  files_.clear();
  add(files);
}

void FileWatch::add(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    const bool known = std::any_of(files_.begin(), files_.end(),
                                   [&](const Watched& watched) { return watched.file == file; });
    if (!known && file != "-") files_.push_back({file, stamp_of(file)});
  }
}

bool FileWatch::has_changed() const {
  return std::any_of(files_.begin(), files_.end(),
                     [](const Watched& watched) { return !(stamp_of(watched.file) == watched.stamp); });
}

void FileWatch::take() {
  for (Watched& watched : files_) watched.stamp = stamp_of(watched.file);
}

}  // namespace kerf::app::view

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
    if (known || file == "-") continue;
    const FileStamp stamp = file_stamp(file);
    files_.push_back({file, stamp, stamp.size});
  }
}

bool FileWatch::has_changed() const {
  return std::any_of(files_.begin(), files_.end(),
                     [](const Watched& watched) { return !(file_stamp(watched.file) == watched.stamp); });
}

void FileWatch::take() {
  for (Watched& watched : files_) {
    const FileStamp now = file_stamp(watched.file);
    if (now == watched.stamp) continue;
    watched.stamp = now;
    changed_at_ = Clock::now();
  }
}

void FileWatch::take_as_read() {
  take();
  for (Watched& watched : files_) watched.size_read = watched.stamp.size;
}

bool FileWatch::is_cut_short() const {
  return std::any_of(files_.begin(), files_.end(),
                     [](const Watched& watched) { return 2 * watched.stamp.size < watched.size_read; });
}

}  // namespace kerf::app::view

// Watching files by polling: robust against editors that rename, folders on networks, and files that vanish
// for a moment.
#pragma once

#include <string>
#include <vector>

#include "base/system.h"

namespace kerf::app::view {

/// Notices changes of files, of those as well that do not exist yet.
class FileWatch {
 public:
  /// The files as they are now. To be called before they are read, so that no change is missed.
  void set(std::vector<std::string> files);
  /// Adds files that are not watched yet.
  void add(const std::vector<std::string>& files);
  /// Whether a file is not as it was at the last call of set, add or `take`.
  bool has_changed() const;
  /// Accepts the present state.
  void take();

 private:
  struct Watched {
    std::string file;
    FileStamp stamp;
  };
  std::vector<Watched> files_;
};

}  // namespace kerf::app::view

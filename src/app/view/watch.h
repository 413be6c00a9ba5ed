// Watching files by polling: robust against editors that rename, folders on networks, and files that vanish
// for a moment.
#pragma once

#include <string>
#include <vector>

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
  /// The state of a file. Equal stamps: unchanged.
  struct Stamp {
    bool exists = false;
    unsigned long device = 0, inode = 0, size = 0;
    long seconds = 0, nanoseconds = 0;
    bool operator==(const Stamp&) const = default;
  };
  static Stamp stamp_of(const std::string& file);

  struct Watched {
    std::string file;
    Stamp stamp;
  };
  std::vector<Watched> files_;
};

}  // namespace kerf::app::view

// Watching files by polling: robust against editors that rename, folders on networks, and files that vanish
// for a moment.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "base/system.h"

namespace kerf::app::view {

/// Notices changes of files, of those as well that do not exist yet.
class FileWatch {
 public:
  using Clock = std::chrono::steady_clock;

  /// The files as they are now. To be called before they are read, so that no change is missed.
  void set(std::vector<std::string> files);
  /// Adds files that are not watched yet.
  void add(const std::vector<std::string>& files);
  /// Whether a file is not as it was at the last call of set, add or `take`.
  bool has_changed() const;
  /// Accepts the present state.
  void take();
  /// The present state is read now: the sizes with which `is_cut_short` compares.
  void take_as_read();
  /// Whether a file has lost most of what it had when it was read last, as those have that an editor empties
  /// and then writes.
  bool is_cut_short() const;
  /// When `take` last found a change.
  Clock::time_point changed_at() const { return changed_at_; }

 private:
  struct Watched {
    std::string file;
    FileStamp stamp;
    std::uint64_t size_read = 0;
  };
  std::vector<Watched> files_;
  Clock::time_point changed_at_{};
};

}  // namespace kerf::app::view

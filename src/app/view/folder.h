// The files that a page may open: those of the folder of the program that the command was called with, and
// files that a page uploads.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/system.h"

namespace kerf::app::view {

class Folder {
 public:
  /// Of the program `file`.
  explicit Folder(const std::string& file);

  /// The names of its files that can be viewed, in order; at most 500. Hidden files and folders are left out.
  std::vector<std::string> names() const;
  /// The path of a file below the folder; nothing if there is none, or if it is elsewhere.
  std::optional<std::string> find(std::string_view name) const;

  struct Kept {
    std::string path;
    std::string problem;  // empty: there is none
  };
  /// Stores a file that a page uploads. Scripts are refused, and cutting jobs, which can name scripts.
  Kept keep(std::string_view name, std::string_view bytes);

 private:
  std::string folder_;
  TemporaryFolder kept_;  // of uploaded files, once there is one
};

/// Whether kerf view reads files with the ending of this name.
bool can_view(std::string_view name);

}  // namespace kerf::app::view

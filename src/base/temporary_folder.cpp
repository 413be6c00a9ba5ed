// Temporary folders that are removed.
#include <filesystem>
#include <fmt/format.h>
#include <random>
#include <utility>

#include "base/native_path.h"
#include "base/system.h"

namespace kerf {

TemporaryFolder::TemporaryFolder(std::string_view name) {
  constexpr int kTries = 100;
  std::error_code failed;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(failed);
  std::random_device number;
  for (int i = 0; i < kTries && !failed; ++i) {
    const std::string folder = utf8_of((parent / fmt::format("{}-{:08x}", name, number())).make_preferred());
    if (!make_private_folder(folder)) continue;  // another process has one of this name
    path_ = folder;
    return;
  }
}

TemporaryFolder::TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
TemporaryFolder& TemporaryFolder::operator=(TemporaryFolder&& other) noexcept {
  std::swap(path_, other.path_);
  return *this;
}
TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_of(path_), ignored);
}

}  // namespace kerf

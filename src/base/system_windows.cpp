// The operating system is Windows.
#include "base/system.h"

#if defined(_WIN32)
#include <filesystem>
#include <io.h>
#include <process.h>
#include <windows.h>

namespace kerf {

unsigned long process_number() { return static_cast<unsigned long>(_getpid()); }

std::optional<std::string> command_file() {
  std::wstring path(32768, L'\0');  // the longest path of Windows
  const DWORD size = GetModuleFileNameW(nullptr, path.data(), static_cast<DWORD>(path.size()));
  if (size == 0 || size == path.size()) return std::nullopt;
  path.resize(size);
  return std::filesystem::path(path).string();
}

bool is_terminal(Stream stream) { return _isatty(static_cast<int>(stream)) != 0; }

bool is_writable(const std::string& path) {
  constexpr int kWrite = 2;
  return _access(path.c_str(), kWrite) == 0;
}

bool make_private_folder(const std::string& path) {
  std::error_code failed;
  return std::filesystem::create_directory(path, failed);  // the folder for temporary files is the user's own
}

FileStamp file_stamp(const std::string& path) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(path, failed);
  if (failed) return {};
  const auto changed = std::filesystem::last_write_time(path, failed);
  if (failed) return {};
  return {true, 0, 0, size, 0, changed.time_since_epoch().count()};
}

}  // namespace kerf
#endif

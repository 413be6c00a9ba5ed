// The operating system by POSIX: Linux, macOS, WebAssembly.
#include "base/system.h"

#if !defined(_WIN32)
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

#include "base/native_path.h"

#if defined(__APPLE__)
#include <mach-o/dyld.h>
#include <sys/random.h>
#endif

namespace kerf {

std::FILE* open_stream(const std::string& path, const char* mode) { return std::fopen(path.c_str(), mode); }

unsigned long process_number() { return static_cast<unsigned long>(getpid()); }

std::optional<std::string> command_file() {
#if defined(__APPLE__)
  std::uint32_t size = 0;
  _NSGetExecutablePath(nullptr, &size);
  std::string path(size, '\0');
  if (_NSGetExecutablePath(path.data(), &size) != 0) return std::nullopt;
  path.resize(path.find('\0'));
  std::error_code failed;
  const auto resolved = std::filesystem::canonical(path, failed);
  return failed ? path : resolved.string();
#else
  std::error_code failed;
  const auto command = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (failed) return std::nullopt;
  return command.string();
#endif
}

bool is_terminal(Stream stream) {
  constexpr int kHandles[] = {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO};
  return isatty(kHandles[static_cast<int>(stream)]) != 0;
}

void prepare_streams() {}

bool fill_with_random_bytes(std::span<unsigned char> bytes) {
  return getentropy(bytes.data(), bytes.size()) == 0;
}

bool is_writable(const std::string& path) { return access(path.c_str(), W_OK) == 0; }

bool make_private_folder(const std::string& path) { return mkdir(path.c_str(), S_IRWXU) == 0; }

FileStamp file_stamp(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) return {};
#if defined(__APPLE__)
  const timespec changed = info.st_mtimespec;
#else
  const timespec changed = info.st_mtim;
#endif
  return {true,
          static_cast<std::uint64_t>(info.st_dev),
          static_cast<std::uint64_t>(info.st_ino),
          static_cast<std::uint64_t>(info.st_size),
          static_cast<std::int64_t>(changed.tv_sec),
          static_cast<std::int64_t>(changed.tv_nsec)};
}

}  // namespace kerf
#endif

// The operating system is Windows.
#include "base/system.h"

#if defined(_WIN32)
#include <cstdio>
#include <fcntl.h>
#include <io.h>
#include <process.h>
// ntsecapi.h needs windows.h before it.
// clang-format off
#include <windows.h>
#include <ntsecapi.h>
// clang-format on

#include "base/native_path.h"

namespace kerf {

std::wstring wide(std::string_view utf8) {
  const int bytes = static_cast<int>(utf8.size());
  const int size = MultiByteToWideChar(CP_UTF8, 0, utf8.data(), bytes, nullptr, 0);
  std::wstring out(static_cast<std::size_t>(size), L'\0');
  MultiByteToWideChar(CP_UTF8, 0, utf8.data(), bytes, out.data(), size);
  return out;
}

std::string narrow(std::wstring_view text) {
  const int units = static_cast<int>(text.size());
  const int size = WideCharToMultiByte(CP_UTF8, 0, text.data(), units, nullptr, 0, nullptr, nullptr);
  std::string out(static_cast<std::size_t>(size), '\0');
  WideCharToMultiByte(CP_UTF8, 0, text.data(), units, out.data(), size, nullptr, nullptr);
  return out;
}

std::FILE* open_stream(const std::string& path, const char* mode) {
  return _wfopen(wide(path).c_str(), wide(mode).c_str());
}

unsigned long process_number() { return static_cast<unsigned long>(_getpid()); }

std::optional<std::string> command_file() {
  std::wstring path(32768, L'\0');  // the longest path of Windows
  const DWORD size = GetModuleFileNameW(nullptr, path.data(), static_cast<DWORD>(path.size()));
  if (size == 0 || size == path.size()) return std::nullopt;
  path.resize(size);
  return narrow(path);
}

bool is_terminal(Stream stream) { return _isatty(static_cast<int>(stream)) != 0; }

void prepare_streams() {
  for (std::FILE* const stream : {stdin, stdout, stderr}) _setmode(_fileno(stream), _O_BINARY);
  SetConsoleOutputCP(CP_UTF8);
  for (const DWORD which : {STD_OUTPUT_HANDLE, STD_ERROR_HANDLE}) {
    const HANDLE handle = GetStdHandle(which);
    DWORD mode = 0;
    if (GetConsoleMode(handle, &mode) != 0)
      SetConsoleMode(handle, mode | ENABLE_PROCESSED_OUTPUT | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
  }
}

bool fill_with_random_bytes(std::span<unsigned char> bytes) {
  return RtlGenRandom(bytes.data(), static_cast<ULONG>(bytes.size())) != 0;
}

bool is_writable(const std::string& path) {
  constexpr int kWrite = 2;
  return _waccess(path_of(path).c_str(), kWrite) == 0;
}

bool make_private_folder(const std::string& path) {
  std::error_code failed;
  return std::filesystem::create_directory(path_of(path),
                                           failed);  // the folder for temporary files is the user's own
}

FileStamp file_stamp(const std::string& path) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(path_of(path), failed);
  if (failed) return {};
  const auto changed = std::filesystem::last_write_time(path_of(path), failed);
  if (failed) return {};
  return {true, 0, 0, size, 0, changed.time_since_epoch().count()};
}

}  // namespace kerf
#endif

// Names of files as the system's functions take them. For this room: others use file_names.h.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace kerf {

#if defined(_WIN32)

/// UTF-8 as UTF-16, and back. What is not valid becomes U+FFFD.
std::wstring wide(std::string_view utf8);
std::string narrow(std::wstring_view text);

/// libstdc++ makes a path of a text by the locale of the C library, which is never that of UTF-8 in
/// msvcrt.dll, and fails for what is not valid.
inline std::filesystem::path path_of(std::string_view utf8) { return wide(utf8); }
inline std::string utf8_of(const std::filesystem::path& path) { return narrow(path.native()); }

#else

inline std::filesystem::path path_of(std::string_view bytes) { return bytes; }
inline std::string utf8_of(const std::filesystem::path& path) { return path.native(); }

#endif

/// std::fopen for such a name.
std::FILE* open_stream(const std::string& path, const char* mode);

}  // namespace kerf

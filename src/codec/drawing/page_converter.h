// The system's converter of a code page: iconv of the C library, that of Windows, none in WebAssembly. A
// source file for POSIX, one for Windows.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace kerf::dxf {

class PageConverter {
 public:
  /// `page`: the number of Windows, such as 932. Nothing if the system does not know it.
  static std::unique_ptr<PageConverter> open(int page);
  virtual ~PageConverter() = default;

  /// Appends the text as UTF-8, with U+FFFD for each byte that cannot be decoded; false if there was one.
  virtual bool append(std::string& out, std::string_view bytes) = 0;
};

}  // namespace kerf::dxf

// Text of DXF files to UTF-8: code pages before R2007, UTF-8 from then on, and characters by their number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/utf8.h"

namespace kerf::dxf {

/// The Windows or DOS code page that a $DWGCODEPAGE names ("ANSI_1252", "dos850", "ISO8859-2" as 28592,
/// "mac-roman" as 10000); nothing for a name without a known number.
std::optional<int> code_page_number(std::string_view name);
/// Unicode of the bytes 0x80 to 0xFF; null for a page without a table.
const std::uint16_t* upper_half(int code_page);

inline constexpr int kUtf8 = 65001;
inline constexpr int kWesternEurope = 1252;
inline constexpr int kUnstated = 0;  ///< UTF-8 if the bytes are valid UTF-8, else Western Europe

class PageConverter;

class TextDecoder {
 public:
  TextDecoder();
  ~TextDecoder();
  TextDecoder(const TextDecoder&) = delete;
  TextDecoder& operator=(const TextDecoder&) = delete;

  /// False, without a change, if text in this page cannot be decoded on this system.
  bool use(int code_page);
  /// To UTF-8. Also replaces \U+XXXX and \M+NXXXX. Bytes that cannot be decoded become U+FFFD and are
  /// counted.
  std::string decode(std::string_view bytes);
  /// Texts with a character that could not be decoded.
  std::size_t faulty_texts() const { return faulty_texts_; }

 private:
  void append_page(std::string& out, std::string_view bytes);
  void append_bytes(std::string& out, std::string_view bytes);
  std::size_t append_escape(std::string& out, std::string_view text);
  PageConverter* converter(int code_page);

  int page_ = kUnstated;
  const std::uint16_t* upper_ = nullptr;
  std::unique_ptr<PageConverter> converter_;   // of page_
  std::unique_ptr<PageConverter> escaped_[6];  // of \M+1 to \M+5
  std::size_t faulty_texts_ = 0;
  bool faulty_ = false;
};

bool is_utf8(std::string_view bytes);

}  // namespace kerf::dxf

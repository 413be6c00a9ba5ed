// Code pages by Windows.
#include "codec/drawing/page_converter.h"

#if defined(_WIN32)
#include <algorithm>
#include <windows.h>

#include "codec/drawing/code_page.h"

namespace kerf::dxf {
namespace {

constexpr char32_t kReplacement = 0xFFFD;
constexpr int kMaxUnits = 4;  // of UTF-16 for one character of a page: a base and a combining one at most

/// A character at a time, so that one that cannot be decoded does not hide those after it.
class WindowsPage final : public PageConverter {
 public:
  WindowsPage(UINT page, std::size_t longest) : page_(page), longest_(longest) {}

  bool append(std::string& out, std::string_view bytes) override {
    bool valid = true;
    while (!bytes.empty()) {
      std::size_t length = 1;
      const std::size_t limit = std::min(longest_, bytes.size());
      while (length <= limit && !append_character(out, bytes.substr(0, length))) ++length;
      const bool found = length <= limit;
      if (!found) append_utf8(out, kReplacement);
      valid = valid && found;
      bytes.remove_prefix(found ? length : 1);
    }
    return valid;
  }

 private:
  /// False, without a change, if the bytes are not one character of the page.
  bool append_character(std::string& out, std::string_view bytes) const {
    wchar_t units[kMaxUnits];
    const int count = MultiByteToWideChar(page_, MB_ERR_INVALID_CHARS, bytes.data(),
                                          static_cast<int>(bytes.size()), units, kMaxUnits);
    for (int k = 0; k < count; ++k) {
      const auto unit = static_cast<char32_t>(units[k]);
      const bool is_pair = unit >= 0xD800 && unit < 0xDC00 && k + 1 < count;
      append_utf8(out, is_pair ? 0x10000 + ((unit - 0xD800) << 10) + (units[++k] - 0xDC00) : unit);
    }
    return count > 0;
  }

  UINT page_;
  std::size_t longest_;  // bytes of a character
};

}  // namespace

std::unique_ptr<PageConverter> PageConverter::open(int page) {
  CPINFO info{};
  if (GetCPInfo(static_cast<UINT>(page), &info) == 0) return nullptr;
  return std::make_unique<WindowsPage>(static_cast<UINT>(page), info.MaxCharSize);
}

}  // namespace kerf::dxf
#endif

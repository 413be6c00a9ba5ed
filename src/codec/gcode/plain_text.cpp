// Detects text: by the byte order mark, otherwise by the fraction of control bytes, which is nearly 0 in
// text.
#include "codec/gcode/plain_text.h"

#include <algorithm>

namespace kerf::gcode {
namespace {

constexpr std::size_t kExamined = 64 * 1024;  // bytes from the start
/// A single control byte is an error of its line; one in so many bytes means binary data. Of random bytes 27
/// in 256 are control bytes.
constexpr std::size_t kBytesPerControlByte = 32;
/// UTF-16 of Latin letters has a zero for every other byte.
constexpr std::size_t kBytesPerZero = 3;

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  const bool blank = (byte >= '\t' && byte <= '\r') || byte == 0x1a;  // 0x1a: the end of a file in CP/M
  return byte == 0x7f || (byte < 0x20 && !blank);
}

}  // namespace

std::optional<NotPlain> find_not_plain(std::string_view bytes) {
  const std::string_view mark = bytes.substr(0, 2);
  if (mark == "\xFF\xFE" || mark == "\xFE\xFF") return NotPlain{NotPlain::Kind::utf16, 0};
  const std::string_view begin = bytes.substr(0, kExamined);
  const auto controls = static_cast<std::size_t>(std::count_if(begin.begin(), begin.end(), is_control));
  if (controls * kBytesPerControlByte <= begin.size()) return std::nullopt;
  const auto zeros = static_cast<std::size_t>(std::count(begin.begin(), begin.end(), '\0'));
  const bool wide = zeros * kBytesPerZero > begin.size() && zeros * 4 < begin.size() * 3;
  const auto first = std::find_if(begin.begin(), begin.end(), is_control);
  return NotPlain{wide ? NotPlain::Kind::utf16 : NotPlain::Kind::binary,
                  static_cast<std::size_t>(first - begin.begin())};
}

}  // namespace kerf::gcode

// The one file of a small zip archive, read from memory. Where there is no zlib (WebAssembly), only stored
// files can be read.
#include <cstdint>

#include "front/tools/library.h"

#ifndef __EMSCRIPTEN__
#include <zlib.h>
#endif

namespace kerf::detail {
namespace {

constexpr std::size_t kLocalHeader = 30, kCentralHeader = 46, kEndRecord = 22;
constexpr std::uint32_t kCentralMark = 0x02014b50, kEndMark = 0x06054b50;
constexpr std::size_t kLongestRemark = 65'535;

/// A little-endian number of `count` bytes; 0 beyond the end.
std::uint32_t number_at(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = count; i-- > 0;)
    value = (value << 8) | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0u);
  return value;
}

std::optional<std::string> inflated(std::string_view packed, std::size_t size) {
#ifdef __EMSCRIPTEN__
  (void)packed;
  (void)size;
  return std::nullopt;
#else
  std::string out(size, '\0');
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return std::nullopt;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int result = inflate(&stream, Z_FINISH);
  const bool whole = result == Z_STREAM_END && stream.avail_out == 0;
  inflateEnd(&stream);
  return whole ? std::optional(std::move(out)) : std::nullopt;
#endif
}

}  // namespace

std::optional<std::string> unzip_first(std::string_view bytes, std::size_t limit) {
  if (bytes.size() < kEndRecord || bytes.size() > limit) return std::nullopt;
  std::size_t end = bytes.size() - kEndRecord;
  const std::size_t lowest = end > kLongestRemark ? end - kLongestRemark : 0;
  while (end > lowest && number_at(bytes, end, 4) != kEndMark) --end;
  const std::size_t central = number_at(bytes, end + 16, 4);
  if (number_at(bytes, central, 4) != kCentralMark || central + kCentralHeader > bytes.size())
    return std::nullopt;
  const std::uint32_t method = number_at(bytes, central + 10, 2);
  const std::size_t packed = number_at(bytes, central + 20, 4), size = number_at(bytes, central + 24, 4);
  const std::size_t local = number_at(bytes, central + 42, 4);
  const std::size_t begin =
      local + kLocalHeader + number_at(bytes, local + 26, 2) + number_at(bytes, local + 28, 2);
  if (size > limit || begin > bytes.size() || packed > bytes.size() - begin) return std::nullopt;
  const std::string_view content = bytes.substr(begin, packed);
  if (method == 0) return std::string(content);
  return method == 8 ? inflated(content, size) : std::nullopt;
}

}  // namespace kerf::detail

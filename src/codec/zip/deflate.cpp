// Compressing with zlib.
#include "codec/zip/deflate.h"

#if KERF_WITH_ZIP
#include <zlib.h>
#endif

namespace kerf::zip {

#if KERF_WITH_ZIP

namespace {
constexpr int kLevel = 4;  // of zlib; 6 takes twice as long for a few percent
}

bool can_deflate() { return true; }

std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  const int result =
      compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), kLevel);
  out.resize(result == Z_OK ? size : 0);
  return out;
}

bool inflated(std::string_view stream, std::size_t size, std::string& bytes) {
  bytes.assign(size, '\0');
  uLongf got = static_cast<uLongf>(size);
  const int result =
      uncompress(reinterpret_cast<Bytef*>(bytes.data()), &got, reinterpret_cast<const Bytef*>(stream.data()),
                 static_cast<uLong>(stream.size()));
  return result == Z_OK && got == size;
}

#else

bool can_deflate() { return false; }
std::string deflated(std::string_view) { return {}; }
bool inflated(std::string_view, std::size_t, std::string&) { return false; }

#endif

}  // namespace kerf::zip

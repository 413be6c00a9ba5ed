// Replaces the reader where minizip is not available: no archive opens.
#if !KERF_WITH_ZIP

#include "codec/zip/zip.h"

namespace kerf::zip {

struct Reader::Archive {};

Reader::Reader(std::string_view) {}
Reader::~Reader() = default;
bool Reader::is_zip() const { return false; }
bool Reader::unpack(const std::string&, const Take&) { return false; }
std::size_t Reader::size_of(const std::string&) const { return 0; }
std::optional<std::string> Reader::first(std::size_t) { return std::nullopt; }

}  // namespace kerf::zip

#endif  // !KERF_WITH_ZIP

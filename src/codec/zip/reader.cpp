// Reads a zip archive in memory.
#if KERF_WITH_ZIP

#include <algorithm>
#include <minizip/unzip.h>
#include <vector>

#include "codec/zip/memory.h"
#include "codec/zip/zip.h"

namespace kerf::zip {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 16;

uLong write_nothing(voidpf, voidpf, const void*, uLong) { return 0; }

}  // namespace

struct Reader::Archive {
  Memory<std::string_view> memory;
  unzFile file = nullptr;
};

Reader::Reader(std::string_view bytes) : archive_(std::make_unique<Archive>(Archive{{bytes, 0}, nullptr})) {
  auto calls = archive_->memory.calls(write_nothing);
  archive_->file = unzOpen2_64("", &calls);
}

Reader::~Reader() {
  if (is_zip()) unzClose(archive_->file);
}

bool Reader::is_zip() const { return archive_->file != nullptr; }

bool Reader::unpack(const std::string& name, const Take& take) {
  constexpr int kAnyCase = 2;
  return is_zip() && unzLocateFile(archive_->file, name.c_str(), kAnyCase) == UNZ_OK && unpack_current(take);
}

bool Reader::unpack_current(const Take& take) {
  if (unzOpenCurrentFile(archive_->file) != UNZ_OK) return false;
  std::vector<char> piece(kPiece);
  int got = 0;
  bool more = true;
  do {
    got = unzReadCurrentFile(archive_->file, piece.data(), static_cast<unsigned>(piece.size()));
    if (got >= 0) more = take(std::string_view(piece.data(), static_cast<std::size_t>(got)), got == 0);
  } while (got > 0 && more);
  const bool whole = unzCloseCurrentFile(archive_->file) == UNZ_OK;
  return got >= 0 && (whole || !more);
}

std::optional<std::string> Reader::first(std::size_t limit) {
  if (!is_zip() || unzGoToFirstFile(archive_->file) != UNZ_OK) return std::nullopt;
  std::string out;
  const bool whole = unpack_current([&](std::string_view piece, bool) {
    out += piece;
    return out.size() <= limit;
  });
  return whole && out.size() <= limit ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace kerf::zip

#endif  // KERF_WITH_ZIP

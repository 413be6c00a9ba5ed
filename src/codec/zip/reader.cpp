// Reads a zip archive in memory: its directory, also in the zip64 form, and files that are stored or
// deflated.
#if KERF_WITH_ZIP

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <vector>
#include <zlib.h>

#include "codec/zip/zip.h"

namespace kerf::zip {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 16;  // bytes passed on at once
constexpr std::uint32_t kEnd = 0x06054b50, kEnd64 = 0x06064b50, kLocator64 = 0x07064b50;
constexpr std::uint32_t kDirectoryEntry = 0x02014b50, kLocalHeader = 0x04034b50;
constexpr std::size_t kEndSize = 22, kLocatorSize = 20, kEnd64Size = 56, kEntrySize = 46, kLocalSize = 30;
constexpr std::size_t kMaxComment = 65535;  // bytes, after the end record
constexpr std::uint32_t kIn64 = 0xffffffff, kEncrypted = 1;
constexpr unsigned kStored = 0, kDeflated = 8, kExtra64 = 1;

/// A little-endian number of `width` bytes. The caller has compared the size.
std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t width) {
  std::uint64_t value = 0;
  for (std::size_t k = width; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

struct Entry {
  std::string_view name;
  std::uint64_t packed = 0, size = 0, offset = 0;  // bytes; of the local header
  std::uint32_t checksum = 0;
  unsigned method = 0;
  bool encrypted = false;
};

/// Sizes and offset that do not fit into 32 bits are in an extra field, in this order.
bool read_extra64(std::string_view extra, Entry& entry) {
  while (extra.size() >= 4) {
    const std::size_t size = number_at(extra, 2, 2);
    const bool is_64 = number_at(extra, 0, 2) == kExtra64;
    if (size > extra.size() - 4) return false;
    std::string_view values = extra.substr(4, size);
    extra.remove_prefix(4 + size);
    if (!is_64) continue;
    for (std::uint64_t* value : {&entry.size, &entry.packed, &entry.offset}) {
      if (*value != kIn64) continue;
      if (values.size() < 8) return false;
      *value = number_at(values, 0, 8);
      values.remove_prefix(8);
    }
  }
  return true;
}

struct Directory {
  std::uint64_t offset = 0, size = 0;
};

/// The directory that the end record at `end` describes, with the zip64 end record before it.
std::optional<Directory> directory_at(std::string_view bytes, std::size_t end) {
  Directory found{number_at(bytes, end + 16, 4), number_at(bytes, end + 12, 4)};
  const bool has_64 = end >= kLocatorSize && number_at(bytes, end - kLocatorSize, 4) == kLocator64;
  if (has_64) {
    const std::uint64_t at = number_at(bytes, end - kLocatorSize + 8, 8);
    if (at > bytes.size() || bytes.size() - at < kEnd64Size || number_at(bytes, at, 4) != kEnd64)
      return std::nullopt;
    found = {number_at(bytes, at + 48, 8), number_at(bytes, at + 40, 8)};
  }
  if (found.offset > bytes.size() || found.size > bytes.size() - found.offset) return std::nullopt;
  return found;
}

std::optional<Directory> find_directory(std::string_view bytes) {
  if (bytes.size() < kEndSize) return std::nullopt;
  const std::size_t last = bytes.size() - kEndSize;
  for (std::size_t at = last + 1; at-- > last - std::min(last, kMaxComment);)
    if (number_at(bytes, at, 4) == kEnd) return directory_at(bytes, at);
  return std::nullopt;
}

std::vector<Entry> entries_of(std::string_view bytes, const Directory& directory) {
  std::vector<Entry> entries;
  std::string_view rest = bytes.substr(directory.offset, directory.size);
  while (rest.size() >= kEntrySize && number_at(rest, 0, 4) == kDirectoryEntry) {
    Entry entry;
    entry.encrypted = (number_at(rest, 8, 2) & kEncrypted) != 0;
    entry.method = static_cast<unsigned>(number_at(rest, 10, 2));
    entry.checksum = static_cast<std::uint32_t>(number_at(rest, 16, 4));
    entry.packed = number_at(rest, 20, 4);
    entry.size = number_at(rest, 24, 4);
    entry.offset = number_at(rest, 42, 4);
    const std::size_t name = number_at(rest, 28, 2), extra = number_at(rest, 30, 2);
    const std::size_t all = kEntrySize + name + extra + number_at(rest, 32, 2);
    if (all > rest.size()) break;
    entry.name = rest.substr(kEntrySize, name);
    if (!read_extra64(rest.substr(kEntrySize + name, extra), entry)) break;
    entries.push_back(entry);
    rest.remove_prefix(all);
  }
  return entries;
}

/// The packed bytes of a file. Sizes in the local header may be 0 and follow the data instead; those of the
/// directory are complete.
std::optional<std::string_view> packed_bytes(std::string_view bytes, const Entry& entry) {
  if (entry.encrypted || entry.offset > bytes.size() || bytes.size() - entry.offset < kLocalSize ||
      number_at(bytes, entry.offset, 4) != kLocalHeader)
    return std::nullopt;
  const std::size_t skip =
      kLocalSize + number_at(bytes, entry.offset + 26, 2) + number_at(bytes, entry.offset + 28, 2);
  const std::size_t left = bytes.size() - entry.offset;
  if (skip > left || entry.packed > left - skip) return std::nullopt;
  return bytes.substr(entry.offset + skip, entry.packed);
}

bool is_same_name(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

/// Passes the pieces of a file on; the last one, which is empty, only if size and checksum are right.
class Unpacker {
 public:
  Unpacker(const Entry& entry, const Reader::Take& take) : entry_(entry), take_(take) {}

  bool stored(std::string_view packed) {
    while (!packed.empty()) {
      if (!pass(packed.substr(0, kPiece))) return true;
      packed.remove_prefix(std::min(packed.size(), kPiece));
    }
    return finish();
  }

  bool deflated(std::string_view packed) {
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return false;
    const bool good = inflate_all(stream, packed);
    inflateEnd(&stream);
    return good;
  }

 private:
  bool inflate_all(z_stream& stream, std::string_view packed) {
    std::vector<char> piece(kPiece);
    int state = Z_OK;
    while (state == Z_OK) {
      const std::string_view input = packed.substr(0, kPiece);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(input.data()));
      stream.avail_in = static_cast<uInt>(input.size());
      stream.next_out = reinterpret_cast<Bytef*>(piece.data());
      stream.avail_out = static_cast<uInt>(piece.size());
      state = inflate(&stream, Z_NO_FLUSH);
      const std::size_t got = piece.size() - stream.avail_out;
      packed.remove_prefix(input.size() - stream.avail_in);
      if (state != Z_OK && state != Z_STREAM_END) return false;
      if (got > 0 && !pass({piece.data(), got})) return true;
    }
    return finish();
  }

  /// False if the receiver has enough.
  bool pass(std::string_view piece) {
    size_ += piece.size();
    checksum_ =
        crc32(checksum_, reinterpret_cast<const Bytef*>(piece.data()), static_cast<uInt>(piece.size()));
    return take_(piece, false);
  }
  bool finish() {
    if (size_ != entry_.size || checksum_ != entry_.checksum) return false;
    take_({}, true);
    return true;
  }

  const Entry& entry_;
  const Reader::Take& take_;
  std::uint64_t size_ = 0;
  uLong checksum_ = crc32(0, nullptr, 0);
};

}  // namespace

struct Reader::Archive {
  std::string_view bytes;
  bool is_zip = false;
  std::vector<Entry> entries;

  bool unpack(const Entry& entry, const Take& take) const {
    const auto packed = packed_bytes(bytes, entry);
    if (!packed) return false;
    Unpacker unpacker(entry, take);
    if (entry.method == kStored) return unpacker.stored(*packed);
    return entry.method == kDeflated && unpacker.deflated(*packed);
  }
};

Reader::Reader(std::string_view bytes) : archive_(std::make_unique<Archive>()) {
  archive_->bytes = bytes;
  const auto directory = find_directory(bytes);
  archive_->is_zip = directory.has_value();
  if (directory) archive_->entries = entries_of(bytes, *directory);
}

Reader::~Reader() = default;

bool Reader::is_zip() const { return archive_->is_zip; }

bool Reader::unpack(const std::string& name, const Take& take) {
  for (const Entry& entry : archive_->entries)
    if (is_same_name(entry.name, name)) return archive_->unpack(entry, take);
  return false;
}

std::size_t Reader::size_of(const std::string& name) const {
  for (const Entry& entry : archive_->entries)
    if (is_same_name(entry.name, name)) return static_cast<std::size_t>(entry.size);
  return 0;
}

std::optional<std::string> Reader::first(std::size_t limit) {
  if (archive_->entries.empty()) return std::nullopt;
  std::string out;
  const bool whole = archive_->unpack(archive_->entries.front(), [&](std::string_view piece, bool) {
    out += piece;
    return out.size() <= limit;
  });
  return whole && out.size() <= limit ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace kerf::zip

#endif  // KERF_WITH_ZIP

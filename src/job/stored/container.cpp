// Head and chunks.
//
// The head, the same in all versions: 8 bytes that no text file starts with (as those of PNG, they show files
// damaged by a transfer as text), the version (4 bytes), the length of the writer's name (1 byte) and this
// name. Then the content (1 byte). A chunk: four letters, the method (0 stored, 1 zlib), the number of stored
// bytes and of bytes (8 each), the CRC-32 of the bytes (4), the stored bytes.
#include "job/stored/container.h"

#include <array>
#include <fmt/format.h>

#include "base/codes/files.h"
#include "base/names.h"
#include "codec/zip/deflate.h"

namespace kerf::stored {
namespace {

constexpr std::string_view kMagic = "\x89KERF\r\n\x1a";
constexpr std::string_view kWriter = "Kerf " KERF_VERSION;
constexpr std::uint8_t kPlain = 0, kDeflated = 1;
constexpr std::size_t kTagBytes = 4;

std::string_view name_of(Content content) {
  switch (content) {
    case Content::program: return "a program";
    case Content::toolpath: return "a toolpath";
    case Content::tool: return "a tool";
    case Content::stock: break;
  }
  return "stock";
}

void append(std::string& out, std::uint64_t value, int bytes) {
  for (int k = 0; k < bytes; ++k) out += static_cast<char>(value >> (8 * k) & 0xff);
}

/// The checksum of PNG and zip, also where there is no zlib.
std::uint32_t crc32_of(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t n = 0; n < table.size(); ++n) {
      std::uint32_t c = n;
      for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
      table[n] = c;
    }
    return table;
  }();
  std::uint32_t sum = 0xffffffffu;
  for (const char c : bytes) sum = kTable[(sum ^ static_cast<std::uint8_t>(c)) & 0xff] ^ (sum >> 8);
  return ~sum;
}

}  // namespace

ChunkWriter::ChunkWriter(Content content) : out_(kMagic) {
  append(out_, kVersion, 4);
  append(out_, kWriter.size(), 1);
  out_ += kWriter;
  append(out_, static_cast<std::uint64_t>(content), 1);
}

void ChunkWriter::add(Tag tag, std::string_view bytes) {
  const std::string packed = zip::deflated(bytes);
  const bool is_packed =
      !packed.empty() && packed.size() < bytes.size() && bytes.size() / packed.size() < kMaxRatio;
  const std::string_view kept = is_packed ? std::string_view(packed) : bytes;
  out_ += tag;
  append(out_, is_packed ? kDeflated : kPlain, 1);
  append(out_, kept.size(), 8);
  append(out_, bytes.size(), 8);
  append(out_, crc32_of(bytes), 4);
  out_ += kept;
}

std::string ChunkWriter::finish() {
  add(kEnd, {});
  return std::move(out_);
}

bool has_head(std::string_view bytes) { return bytes.substr(0, kMagic.size()) == kMagic; }

ChunkReader::ChunkReader(std::string_view bytes, const std::string& name, Diagnostics& diagnostics)
    : all_(bytes), rest_(bytes), name_(name), diagnostics_(diagnostics) {}

bool ChunkReader::damaged(std::string_view fault) {
  diagnostics_.error(codes::program_file_damaged, TextLocation{name_, 0, 0},
                     fmt::format("the file is damaged, or no file of Kerf: {}, near byte {}", fault,
                                 all_.size() - rest_.size()));
  return false;
}

std::string_view ChunkReader::take(std::uint64_t count) {
  const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(count));
  rest_.remove_prefix(taken.size());
  return taken;
}

std::uint64_t ChunkReader::number(std::uint64_t bytes) {
  std::uint64_t value = 0;
  int shift = 0;
  for (const char c : take(bytes)) {
    value |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(c)) << shift;
    shift += 8;
  }
  return value;
}

bool ChunkReader::open(Content content) {
  if (!has_head(rest_)) return damaged("it does not start with Kerf's mark");
  take(kMagic.size());
  if (rest_.size() < 6) return damaged("it ends within its head");
  const std::uint64_t version = version_ = number(4);
  const std::string writer(take(number(1)));
  if (version > kVersion) {
    diagnostics_
        .error(codes::program_file_newer, TextLocation{name_, 0, 0},
               fmt::format("the file has version {} of its format, by {}; {} reads up to version {}", version,
                           writer.empty() ? "a newer Kerf" : clipped(writer, 40), kWriter, kVersion))
        .hint = "use a newer Kerf, or write the file again with this one";
    return false;
  }
  if (version == 0 || rest_.empty()) return damaged("its head is incomplete");
  const std::uint64_t found = number(1);
  if (found == static_cast<std::uint64_t>(content)) return true;
  if (found > static_cast<std::uint64_t>(Content::stock)) return damaged("its content is unknown");
  return damaged(fmt::format("it holds {}, not {}", name_of(static_cast<Content>(found)), name_of(content)));
}

std::optional<ChunkReader::Chunk> ChunkReader::next() {
  const auto fail = [this](std::string_view fault) {
    damaged(fault);
    return std::nullopt;
  };
  if (rest_.size() < kTagBytes + 1 + 8 + 8 + 4) return fail("it ends before its last chunk");
  Chunk chunk;
  chunk.tag = take(kTagBytes);
  const std::uint64_t method = number(1), stored = number(8), size = number(8), sum = number(4);
  if (stored > rest_.size()) return fail("it ends within a chunk");
  const std::string_view kept = take(stored);
  if (method == kPlain && stored == size) {
    chunk.bytes = kept;
  } else if (method == kDeflated && size / kMaxRatio <= stored) {
    if (!zip::can_deflate()) return fail("it is compressed, which this build cannot read");
    if (!zip::inflated(kept, static_cast<std::size_t>(size), unpacked_)) return fail("a chunk is damaged");
    chunk.bytes = unpacked_;
  } else {
    return fail("a chunk has a wrong head");
  }
  if (crc32_of(chunk.bytes) != sum) return fail("a chunk has a wrong checksum");
  if (chunk.tag == kEnd && !rest_.empty()) return fail("bytes follow its end");
  return chunk;
}

}  // namespace kerf::stored

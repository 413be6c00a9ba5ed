// Blocks of lines end where a line's text says so: an inserted line changes no blocks but its own.
#include "app/shown/sources.h"

#include <algorithm>
#include <cstring>
#include <unordered_map>
#include <utility>

#include "kerf/base/diagnostics.h"
#include "kerf/base/files.h"

namespace kerf::app::view {
namespace {

constexpr std::size_t kMaxExportedText = std::size_t{4} << 20;  // bytes of one file
constexpr std::size_t kShortest = std::size_t{16} << 10,
                      kLongest = std::size_t{256} << 10;  // bytes of a block
constexpr std::uint64_t kEnds = 255;                      // one of so many lines ends a block
constexpr std::size_t kMaxLine = std::size_t{16} << 10;   // bytes; pages show fewer
constexpr std::uint64_t kMix = 0x9e3779b97f4a7c15u;

/// Of the last bytes of a line.
std::uint64_t hash_of(std::string_view line) {
  std::uint64_t parts[2] = {line.size(), 0};
  const std::size_t tail = std::min<std::size_t>(line.size(), 8);
  std::memcpy(&parts[1], line.data() + (line.size() - tail), tail);
  const std::uint64_t h = (parts[0] ^ parts[1]) * kMix;
  return (h ^ h >> 29) * kMix >> 32;
}

/// The start of a text of at most `size` bytes, without half a character of UTF-8 at its end.
std::string_view cut(std::string_view text, std::size_t size) {
  if (text.size() <= size) return text;
  while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xc0u) == 0x80u) --size;
  return text.substr(0, size);
}

/// A line with the bytes that end it, and what follows.
std::pair<std::string_view, std::string_view> first_line(std::string_view text) {
  std::size_t end = 0;
  while (end < text.size() && text[end] != '\n' && text[end] != '\r') ++end;
  if (end + 1 < text.size() && text[end] == '\r' && text[end + 1] == '\n') ++end;
  const std::size_t after = std::min(end + 1, text.size());
  return {text.substr(0, after), text.substr(after)};
}

Record block_record(const SourceBlock& block) { return Record::array({block.id, block.lines}); }

}  // namespace

std::vector<SourceBlock> blocks_of_lines(std::string_view text) {
  std::vector<SourceBlock> blocks;
  std::string own;
  std::uint32_t lines = 0;
  const bool is_ended = !text.empty() && (text.back() == '\n' || text.back() == '\r');
  const auto end_block = [&] {
    if (lines != 0) blocks.push_back({0, lines, std::make_shared<const std::string>(std::move(own))});
    own.clear();
    lines = 0;
  };
  while (!text.empty()) {
    const auto [line, rest] = first_line(text);
    text = rest;
    const std::string_view kept = cut(line, kMaxLine);
    own += kept;
    if (kept.size() != line.size()) own += '\n';
    ++lines;
    if ((own.size() >= kShortest && (hash_of(kept) & kEnds) == 0) || own.size() >= kLongest) end_block();
  }
  end_block();
  if (is_ended) ++blocks.back().lines;  // the empty one after the last line end
  return blocks;
}

void Sources::read(const std::vector<std::string>& files, std::size_t whole) {
  files_.clear();
  for (const std::string& path : files) {
    SourceText source;
    source.path = path;
    Diagnostics ignored;
    const auto file = path != "-" ? InputFile::open(path, ignored) : std::nullopt;
    source.is_read = file.has_value();
    if (file && file->bytes().find('\0') == std::string_view::npos) {
      if (file->bytes().size() <= whole) source.text = std::string(file->bytes());
      if (!source.text) source.blocks = blocks_of_lines(file->bytes());
    }
    files_.push_back(std::move(source));
  }
}

void Sources::take_ids(const std::vector<const Sources*>& before) {
  std::unordered_map<std::string_view, SourceBlock> known;
  for (const Sources* other : before) {
    ids_ = std::max(ids_, other->ids_);
    for (const SourceText& file : other->files_)
      for (const SourceBlock& block : file.blocks) known.try_emplace(*block.text, block);
  }
  for (SourceText& file : files_) {
    for (SourceBlock& block : file.blocks) {
      const auto found = known.find(*block.text);
      if (found != known.end()) {
        block.id = found->second.id;
        block.text = found->second.text;
      } else {
        block.id = ++ids_;
        known.emplace(*block.text, block);
      }
    }
  }
}

Record Sources::record() const {
  Record list = Record::array();
  for (const SourceText& source : files_) {
    Record file{{"path", source.path},
                {"text", source.text ? Record(*source.text) : Record(nullptr)},
                {"complete", source.is_read}};
    if (!source.blocks.empty()) {
      Record blocks = Record::array();
      for (const SourceBlock& block : source.blocks) blocks.push_back(block_record(block));
      file["blocks"] = std::move(blocks);
    }
    list.push_back(std::move(file));
  }
  return list;
}

Record Sources::record_with_texts() const {
  Record list = Record::array();
  for (const SourceText& source : files_) {
    std::optional<std::string> text = source.text;
    std::size_t used = 0;
    for (; used < source.blocks.size() && (!text || text->size() < kMaxExportedText); ++used)
      text = text.value_or("") + *source.blocks[used].text;
    list.push_back({{"path", source.path},
                    {"text", text ? Record(*text) : Record(nullptr)},
                    {"complete", source.is_read && used == source.blocks.size()}});
  }
  return list;
}

std::shared_ptr<const std::string> Sources::find(std::uint32_t id) const {
  for (const SourceText& file : files_)
    for (const SourceBlock& block : file.blocks)
      if (block.id == id) return block.text;
  return nullptr;
}

}  // namespace kerf::app::view

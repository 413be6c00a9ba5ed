// The outer form of Kerf's own files: a head, chunks with checksums, an end.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "kerf/base/diagnostics.h"

namespace kerf::stored {

inline constexpr std::uint32_t kVersion = 2;  // of the format

/// What a file holds.
enum class Content : std::uint8_t { program, toolpath, tool, stock };

/// The kinds of chunks, by their four letters.
using Tag = std::string_view;
inline constexpr Tag kFields = "FLDS", kTables = "TABL", kOrigins = "ORIG", kSteps = "STEP", kEnd = "END ";

class ChunkWriter {
 public:
  explicit ChunkWriter(Content content);
  /// Compressed if that makes it smaller, by no more than kMaxRatio.
  void add(Tag tag, std::string_view bytes);
  std::string finish();

 private:
  std::string out_;
};

/// Chunks shrink to no less than an eighth: what a file makes of memory is in proportion to its size.
inline constexpr std::uint64_t kMaxRatio = 8;

bool has_head(std::string_view bytes);

class ChunkReader {
 public:
  /// `name` is that of the file, for messages.
  ChunkReader(std::string_view bytes, const std::string& name, Diagnostics& diagnostics);
  /// Checks the head; false, with an error, for another content, a newer version, and other files.
  bool open(Content content);
  /// Of the format of the file, once it is open.
  std::uint64_t version() const { return version_; }

  struct Chunk {
    std::string tag;
    std::string_view bytes;  // valid until the next call
  };
  /// The next chunk, "END " as the last one; nothing, with an error, for a damaged one.
  std::optional<Chunk> next();
  /// Appends the one error of a damaged file and returns false.
  bool damaged(std::string_view fault);

 private:
  std::string_view take(std::uint64_t count);
  std::uint64_t number(std::uint64_t bytes);

  std::string_view all_, rest_;
  std::string unpacked_;
  std::uint64_t version_ = 0;
  const std::string& name_;
  Diagnostics& diagnostics_;
};

}  // namespace kerf::stored

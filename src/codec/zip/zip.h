// Zip archives in memory: read with zlib, written by minizip, whose reader does not know zip64. Without them
// (WebAssembly) no archive opens.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace kerf::zip {

/// Reads the files of an archive one at a time. The caller owns the bytes, which must outlive the reader.
class Reader {
 public:
  explicit Reader(std::string_view bytes);
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  bool is_zip() const;
  /// Receives a piece of a file, and whether it is the last one; returns false to stop.
  using Take = std::function<bool(std::string_view piece, bool last)>;
  /// Passes a file (its name in any case) to `take` piece by piece until that returns false. False if there
  /// is no such file or it is damaged.
  bool unpack(const std::string& name, const Take& take);
  /// The unpacked bytes of a file, as the archive states them; 0 if there is no such file.
  std::size_t size_of(const std::string& name) const;
  /// The archive's first file; nothing if there is none, it is damaged or longer than `limit` bytes.
  std::optional<std::string> first(std::size_t limit);

 private:
  struct Archive;
  std::unique_ptr<Archive> archive_;
};

/// Writes an archive; files are written one after the other, text is passed to the compressor in pieces.
class Writer {
 public:
  Writer();
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Starts a file; `large` if it may be longer than 4 GiB (readers of small files need not support zip64).
  enum class Size : int { small = 0, large = 1 };
  void begin(const char* name, Size size = Size::small);
  void write(std::string_view text);
  void end();
  std::string finish();

 private:
  struct Archive;
  std::unique_ptr<Archive> archive_;
};

}  // namespace kerf::zip

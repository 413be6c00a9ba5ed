// Zip archives in memory, by minizip. Where there is no minizip (WebAssembly) no archive opens.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace kerf::zip {

/// Reads an archive's files one at a time. The bytes stay the caller's and must outlive the reader.
class Reader {
 public:
  explicit Reader(std::string_view bytes);
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  bool is_zip() const;
  /// Takes a piece of a file, and whether the file ends with it; false wants no more.
  using Take = std::function<bool(std::string_view piece, bool last)>;
  /// Hands a file (its name in any case) to `take` piece by piece until that returns false. False if there is
  /// no such file or it is damaged.
  bool unpack(const std::string& name, const Take& take);
  /// The archive's first file; nothing where there is none, it is damaged or longer than `limit` bytes.
  std::optional<std::string> first(std::size_t limit);

 private:
  bool unpack_current(const Take& take);

  struct Archive;
  std::unique_ptr<Archive> archive_;
};

/// Writes an archive; files are written one after the other, text is handed to the compressor in pieces.
class Writer {
 public:
  Writer();
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Begins a file; `large` where it may be longer than 4 GiB (readers of small files need not know zip64).
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

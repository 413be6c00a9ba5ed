// Files in and out: inputs read whole (mapped where possible), outputs that appear whole, by rename, or not
// at all.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"

namespace kerf {

/// A file's bytes, mapped into memory where the system can, else read. Moves, does not copy.
class InputFile {
 public:
  /// Opens `path`; "-" is standard input. Appends an error (no such file, a folder, not readable, larger than
  /// `limit_bytes`) and returns nothing where it cannot be had.
  static std::optional<InputFile> open(const std::string& path, Diagnostics& diagnostics,
                                       std::size_t limit_bytes = std::size_t{4} << 30);
  std::string_view bytes() const;
  const std::string& path() const { return path_; }

  InputFile(InputFile&&) noexcept;
  InputFile& operator=(InputFile&&) noexcept;
  ~InputFile();

 private:
  struct Body;
  InputFile(std::string path, std::unique_ptr<Body> body);
  std::string path_;
  std::unique_ptr<Body> body_;
};

/// An output file that is written piece by piece beside its target and appears whole, by rename, or not at
/// all. A symbolic link is followed. What is no ordinary file (a device, a pipe) is written at once instead.
class OutputFile {
 public:
  /// Begins the file. Nothing, with an error appended, where that fails.
  static std::optional<OutputFile> create(const std::string& path, Diagnostics& diagnostics);
  /// Writes behind what was written before. False, with an error appended, where that fails.
  bool write(std::string_view bytes, Diagnostics& diagnostics);
  /// Ends the writing; commit() does it too. False, with an error appended, where that fails.
  bool close(Diagnostics& diagnostics);
  /// Puts the file into place. False, with an error appended, where that or the writing failed; nothing is
  /// left behind then.
  bool commit(Diagnostics& diagnostics);

  OutputFile(OutputFile&&) noexcept;
  OutputFile& operator=(OutputFile&&) noexcept;
  ~OutputFile();

 private:
  struct Body;
  explicit OutputFile(std::unique_ptr<Body> body);
  std::unique_ptr<Body> body_;
};

/// A set of output files that appear together, when `commit()` is called. Without it nothing is left behind.
class OutputSet {
 public:
  /// Writes `bytes` to a temporary file beside `path`. False, with an error appended, where that fails.
  bool write(const std::string& path, std::string_view bytes, Diagnostics& diagnostics);
  /// Puts all files into place. False, with an error appended, where that fails; those that are not in place
  /// yet are removed.
  bool commit(Diagnostics& diagnostics);

 private:
  std::vector<OutputFile> files_;
};

}  // namespace kerf

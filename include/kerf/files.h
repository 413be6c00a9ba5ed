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
#include "kerf/limits.h"
#include "kerf/progress.h"

namespace kerf {

/// A file's bytes, mapped into memory where possible, otherwise read. Movable, not copyable.
class InputFile {
 public:
  /// Opens `path`; "-" is standard input. Appends an error (no such file, a folder, not readable, larger than
  /// `limit_bytes`, stopped by `progress`) and returns nothing on failure. Input that cannot be mapped
  /// (pipes, devices, standard input) is held in memory and limited to limits::kMaxStreamBytes.
  static std::optional<InputFile> open(const std::string& path, Diagnostics& diagnostics,
                                       std::size_t limit_bytes = limits::kMaxProgramBytes,
                                       Progress* progress = nullptr);
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

/// A set of output files that appear together: each is written beside its target under a temporary name, and
/// `commit()` renames all of them. Without a commit nothing is left behind. Links are followed as by
/// OutputFile; what is no ordinary file is written to by `commit()`.
class OutputSet {
 public:
  /// Writes `bytes` to a temporary file beside `path`. False, with an error appended, where that fails.
  bool write(const std::string& path, std::string_view bytes, Diagnostics& diagnostics);
  /// Renames all files into place. False, with an error appended, where a rename fails; those not renamed yet
  /// are removed.
  bool commit(Diagnostics& diagnostics);

 private:
  struct Pending {
    std::optional<OutputFile> file;  // nothing where the target is no ordinary file
    std::string path, bytes;
  };
  static bool put_in_place(Pending& pending, Diagnostics& diagnostics);
  std::vector<Pending> pending_;
};

}  // namespace kerf

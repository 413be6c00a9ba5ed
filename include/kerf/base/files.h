// Files: inputs are mapped or read completely; outputs appear complete, by rename, or not at all.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/limits.h"
#include "kerf/base/progress.h"

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
  /// A text in memory under the name of a file, as an editor has it before it is saved.
  static InputFile of_text(std::string path, std::string text);
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

/// An output file that is written in chunks next to its target and appears complete, by rename, or not at
/// all. A symbolic link is followed. The permissions of a replaced file are kept; one that is write-protected
/// is not replaced. Anything but a regular file (a device, a pipe) is written directly.
class OutputFile {
 public:
  /// Creates the file. Nothing, with an error appended, on failure.
  static std::optional<OutputFile> create(const std::string& path, Diagnostics& diagnostics);
  /// Appends bytes. False, with an error appended, on failure.
  bool write(std::string_view bytes, Diagnostics& diagnostics);
  /// Closes the file; commit() does so too. False, with an error appended, on failure.
  bool close(Diagnostics& diagnostics);
  /// Renames the file to its target. False, with an error appended, if that or writing failed; the temporary
  /// file is then removed.
  bool commit(Diagnostics& diagnostics);

  OutputFile(OutputFile&&) noexcept;
  OutputFile& operator=(OutputFile&&) noexcept;
  ~OutputFile();

 private:
  struct Body;
  explicit OutputFile(std::unique_ptr<Body> body);
  std::unique_ptr<Body> body_;
};

/// Whether two paths name the same file, or are the same path.
bool is_same_file(const std::string& a, const std::string& b);

/// A set of output files that appear together: each is written next to its target under a temporary name, and
/// `commit()` renames all of them. Without a commit no file remains. Links are followed as by OutputFile;
/// anything but a regular file is written by `commit()`.
class OutputSet {
 public:
  OutputSet() = default;
  /// Files that must not be replaced, such as the files of a program.
  explicit OutputSet(std::vector<std::string> inputs) : inputs_(std::move(inputs)) {}
  /// Writes `bytes` to a temporary file next to `path`. False, with an error appended, on failure or if the
  /// file would replace an input or another output.
  bool write(const std::string& path, std::string_view bytes, Diagnostics& diagnostics);
  /// Renames all files to their targets. False, with an error appended, if a rename fails; the remaining
  /// temporary files are removed.
  bool commit(Diagnostics& diagnostics);

 private:
  struct Pending {
    std::optional<OutputFile> file;  // nothing unless the target is a regular file
    std::string path, bytes;
  };
  static bool rename_to_target(Pending& pending, Diagnostics& diagnostics);
  std::vector<std::string> inputs_;
  std::vector<Pending> pending_;
};

}  // namespace kerf

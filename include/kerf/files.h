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
#include "kerf/progress.h"

namespace kerf {

/// A file's bytes, mapped into memory where the system can, else read. Moves, does not copy.
class InputFile {
 public:
  /// Opens `path`; "-" is standard input. Appends an error (no such file, a folder, not readable, larger than
  /// `limit_bytes`, stopped by `progress`) and returns nothing where it cannot be had. What cannot be mapped
  /// (pipes, devices, standard input) is held in memory, so that of it at most kLargestStream bytes are read.
  static std::optional<InputFile> open(const std::string& path, Diagnostics& diagnostics,
                                       std::size_t limit_bytes = std::size_t{4} << 30,
                                       Progress* progress = nullptr);
  static constexpr std::size_t kLargestStream = std::size_t{256} << 20;
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

/// A set of output files that appear together: each is written beside its target under a temporary name, and
/// `commit()` renames all of them. Without a commit nothing is left behind. A target that is a link is
/// followed, and one that is no ordinary file (a pipe, /dev/null) is written to by `commit()` as it is.
class OutputSet {
 public:
  OutputSet() = default;
  OutputSet(const OutputSet&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;
  ~OutputSet();

  /// Writes `bytes` to a temporary file beside `path`. False, with an error appended, where that fails.
  bool write(const std::string& path, std::string_view bytes, Diagnostics& diagnostics);
  /// Renames all files into place. False, with an error appended, where a rename fails; those not renamed yet
  /// are removed.
  bool commit(Diagnostics& diagnostics);

 private:
  struct Pending {
    std::string target;
    std::string temporary;  // empty: `bytes` go straight to the target
    std::string bytes;
  };
  bool put_in_place(const Pending& file, Diagnostics& diagnostics) const;
  std::vector<Pending> pending_;
};

}  // namespace kerf

// Text that is written piece by piece, to standard output or to a file.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "kerf/base/diagnostics.h"
#include "kerf/base/files.h"

namespace kerf::app {

/// Text for standard output, or for a file that is renamed to its name by finish().
class TextOut {
 public:
  explicit TextOut(const std::string& path) : to_file_(!path.empty()) {
    if (to_file_) file_ = OutputFile::create(path, diagnostics_);
    good_ = !to_file_ || file_.has_value();
  }

  void write(std::string_view text) {
    good_ = good_ && (to_file_ ? file_->write(text, diagnostics_)
                               : std::fwrite(text.data(), 1, text.size(), stdout) == text.size());
  }
  bool good() const { return good_; }
  /// Renames the file to its name; false if anything could not be written.
  bool finish() { return good_ && (to_file_ ? file_->commit(diagnostics_) : std::fflush(stdout) == 0); }
  /// The error, if finish() or good() is false.
  std::string error_text() const {
    return to_file_ ? to_string(diagnostics_.list().front()) : "cannot write to standard output";
  }

 private:
  bool to_file_;
  bool good_ = true;
  Diagnostics diagnostics_;
  std::optional<OutputFile> file_;
};

}  // namespace kerf::app

// Files that appear together, of which "-" is standard output.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/report/console.h"
#include "base/codes/files.h"

#include "kerf/base/files.h"

namespace kerf::app {

class SentFiles {
 public:
  /// `inputs`: files that must not be replaced.
  explicit SentFiles(Console& console, std::vector<std::string> inputs = {})
      : console_(console), set_(std::move(inputs)) {}

  /// As OutputSet::write.
  bool write(const std::string& path, std::string_view bytes, Diagnostics& diagnostics) {
    if (path != "-") return set_.write(path, bytes, diagnostics);
    if (!sent_.empty())
      diagnostics.error(codes::output_is_input, {}, "standard output takes one output; \"-\" is given twice");
    sent_ += bytes;
    return !diagnostics.has_errors();
  }
  /// As OutputSet::commit; then writes to standard output.
  bool commit(Diagnostics& diagnostics) {
    if (!set_.commit(diagnostics)) return false;
    console_.print_json(sent_);
    return true;
  }

 private:
  Console& console_;
  OutputSet set_;
  std::string sent_;
};

}  // namespace kerf::app

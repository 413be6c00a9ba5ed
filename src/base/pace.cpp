// The error of a file whose reading was stopped.
#include "base/pace.h"

#include "base/codes/files.h"

namespace kerf {

void add_if_stopped(const std::string& path, std::size_t errors, Progress* progress,
                    Diagnostics& diagnostics) {
  if (diagnostics.errors() == errors && stop_requested(progress))
    diagnostics.error(codes::stopped, TextLocation{path, 0, 0}, "interrupted while reading");
}

}  // namespace kerf

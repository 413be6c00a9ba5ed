// Sizes of threads by their names, and the holes that are drilled for them.
#pragma once

#include <optional>
#include <string_view>

#include "op/base/cutter.h"

namespace kerf::op_detail {

struct ThreadSize {
  std::string_view name;
  Length major, pitch;
  Length tap_drill;  ///< of the hole before the thread is cut
};
/// The size of "M6", "M10x1.25", "1/4-20", "#10-32 UNF", in any spelling of these; nothing if it is unknown.
std::optional<ThreadSize> thread_size(std::string_view name);
/// Likewise, with an error of the operation.
std::optional<ThreadSize> thread_size(std::string_view name, const CutOptions& cut, Diagnostics& diagnostics);

}  // namespace kerf::op_detail

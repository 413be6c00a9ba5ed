// Names of limits and of kinds of beads.
#include "path/motion_limits.h"

namespace kerf {

const std::array<std::string_view, 4>& value_names(LimitKind kind) {
  static constexpr std::array<std::string_view, 4> kAxes{"x", "y", "z", "e"},
      kMotions{"beads", "retractions", "travel", ""}, kSingle{"value", "", "", ""};
  if (kind == LimitKind::acceleration) return kMotions;
  const bool single = kind == LimitKind::junction_deviation || kind == LimitKind::corner_speed;
  return single ? kSingle : kAxes;
}

std::optional<LimitKind> limit_named(std::string_view name) {
  for (int i = 0; i <= static_cast<int>(LimitKind::corner_speed); ++i)
    if (to_string(static_cast<LimitKind>(i)) == name) return static_cast<LimitKind>(i);
  return std::nullopt;
}

std::optional<BeadKind> bead_kind_named(std::string_view name) {
  for (std::size_t i = 0; i < kBeadKinds; ++i)
    if (to_string(static_cast<BeadKind>(i)) == name) return static_cast<BeadKind>(i);
  return std::nullopt;
}

}  // namespace kerf

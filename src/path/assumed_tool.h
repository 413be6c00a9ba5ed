// The tool of a program that does not describe it.
#pragma once

#include <optional>

#include "kerf/base/units.h"
#include "kerf/path/toolpath.h"
#include "kerf/tool/tool.h"

namespace kerf {

/// The diameter of an assumed tool if the cuts do not suggest another one: 1/8", the usual router bit.
inline constexpr Length kUsualDiameter = mm(3.175);

/// The basis of an assumed diameter.
enum class AssumedDiameter : std::uint8_t {
  usual,     // kUsualDiameter: the cuts are far from each other
  stepover,  // parallel passes at equal distances, as in a pocket or a relief
  spacing,   // the narrowest distance of adjacent cuts or holes
};

struct AssumedTool {
  ToolShape shape;  // a square end mill whose flute is longer than the deepest cut
  Length diameter;
  AssumedDiameter basis = AssumedDiameter::usual;
};

/// A square end mill that fits the cuts of `tool` (nothing: those before the first tool change): slightly
/// wider than the narrowest stepover, narrower than the distance of cuts that are not a pattern, else
/// kUsualDiameter. See docs/decisions/0028-assumed-tools.md.
AssumedTool assume_tool(const Toolpath& path, std::optional<int> tool);

}  // namespace kerf

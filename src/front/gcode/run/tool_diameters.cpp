// The diameters of tools.
#include "front/gcode/run/tool_diameters.h"

namespace kerf::gcode {

std::optional<double> ToolDiameters::of(int tool) const {
  if (const auto set = set_.find(tool); set != set_.end()) return set->second;
  const auto found = program_.tools.find(tool);
  const Tool* described = found == program_.tools.end() ? nullptr : &found->second;
  if (options_.tool_diameter) return options_.tool_diameter(tool, described);
  if (described == nullptr) return std::nullopt;
  return described->diameter.mm();
}

void ToolDiameters::set_data(int tool) {
  if (const std::optional<double> radius = line_.take('R')) set_[tool] = 2.0 * *radius * modes_.scale;
  line_.use(kAxisLetters | kRotaryLetters | LineWords::bit('I') | LineWords::bit('J') | LineWords::bit('Q'));
}

}  // namespace kerf::gcode

// The diameters of tools, for cutter compensation.
#pragma once

#include <map>
#include <optional>

#include "front/gcode/run/part.h"

namespace kerf::gcode {

class ToolDiameters : Part {
 public:
  explicit ToolDiameters(Context& context) : Part(context) {}

  /// In mm: from G10, else from the user, else from the program's comments.
  std::optional<double> of(int tool) const;
  /// G10 L1. Only the diameter of a tool is used; its length is compensated by the machine.
  void set_data(int tool);

 private:
  std::map<int, double> set_;  // mm, by G10 L1
};

}  // namespace kerf::gcode

// The operations of cutting jobs for gcmc programs: what the caller of a program provides, because a front
// end does not use another.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// An operation on shapes, with its keys as texts.
struct GcmcOperation {
  std::string name;                                        // "pocket"
  std::vector<std::pair<std::string, std::string>> keys;   // "depth", "6mm"
  std::vector<std::vector<std::array<double, 3>>> shapes;  // points of each, mm; 0 for a missing coordinate
  int tool = 0;
  std::string tool_text;  // its shape, "square d=6"
  TextLocation where;     // of the call in the program
};

class GcmcWorkshop {
 public:
  virtual ~GcmcWorkshop() = default;
  /// The tool comment of a text such as "square d=6", in units of `scale` mm (25.4 for a program in inches);
  /// nothing, with errors, if it describes no tool.
  virtual std::optional<std::string> tool_comment(const std::string& text, double scale,
                                                  const TextLocation& where,
                                                  Diagnostics& diagnostics) const = 0;
  /// The motions, with a tool change and a spindle speed ahead of them; nothing, with errors, if it cannot be
  /// cut.
  virtual std::optional<Toolpath> cut(const GcmcOperation& operation, Diagnostics& diagnostics,
                                      Progress* progress) const = 0;
};

}  // namespace kerf

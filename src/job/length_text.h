// Lengths as text, in mm or in inches. JSON and diagnostics are always in mm.
#pragma once

#include <string>
#include <string_view>

#include "kerf/geom/geometry.h"
#include "kerf/job/program.h"
#include "kerf/tool/tool.h"

namespace kerf {

class LengthText {
 public:
  explicit LengthText(ProgramUnits units = ProgramUnits::mm) : inch_(units == ProgramUnits::inch) {}

  std::string_view unit() const { return inch_ ? "in" : "mm"; }
  std::string_view feed_unit() const { return inch_ ? "in/min" : "mm/min"; }
  /// The figure alone; `decimals` are those in mm, in inches there is one more.
  std::string of(double mm, int decimals) const;
  /// "12.5 mm"
  std::string with_unit(double mm, int decimals) const;
  /// "120.5 mm3"
  std::string volume(double mm3, int decimals) const;
  /// "100 x 60 x 12 mm"
  std::string size(Point3 mm) const;
  /// A message of the library with its lengths, feeds and coordinates converted: "25.4 mm deep at Z -2.54".
  std::string message(std::string_view text) const;
  /// "square 3.175 mm"
  std::string tool(const Tool& tool) const;

 private:
  bool inch_;
};

}  // namespace kerf

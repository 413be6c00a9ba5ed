// Lengths as text.
#include "app/report/length_text.h"

#include <fmt/format.h>

#include "kerf/number.h"
#include "kerf/units.h"

namespace kerf::app {

std::string LengthText::of(double mm, int decimals) const {
  return inch_ ? number_text(mm / kMmPerInch, decimals + 1) : number_text(mm, decimals);
}

std::string LengthText::with_unit(double mm, int decimals) const {
  return fmt::format("{} {}", of(mm, decimals), unit());
}

std::string LengthText::volume(double mm3, int decimals) const {
  constexpr double kCube = kMmPerInch * kMmPerInch * kMmPerInch;
  return inch_ ? number_text(mm3 / kCube, decimals + 3) + " in3" : number_text(mm3, decimals) + " mm3";
}

std::string LengthText::size(Point3 mm) const {
  return fmt::format("{} x {} x {} {}", of(mm.x, 3), of(mm.y, 3), of(mm.z, 3), unit());
}

std::string LengthText::tool(const Tool& tool) const {
  return fmt::format("{} {}", name_of(tool.shape), with_unit(tool.diameter.mm(), 3));
}

}  // namespace kerf::app

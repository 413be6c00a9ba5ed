// Support bars.
#include "front/pathdxf/compile/bars.h"

#include <algorithm>
#include <cmath>

namespace kerf::pathdxf {

double bar_count(double length, const MillingValues& values) {
  return std::floor(length / (values.bar_distance + values.bar_length));
}

std::vector<Section> bar_sections(double length, double tool, const MillingValues& values) {
  std::vector<Section> sections;
  const double count = bar_count(length, values);
  if (!(count >= 1.0) || !values.b || !values.d) return sections;
  const double bar = values.bar_length;
  const double incline = std::max(0.0, std::min(*values.d - *values.b, bar / 2.0));
  const double between = length / count - bar - 2.0 * incline - tool;
  const auto n = static_cast<std::size_t>(count);
  sections.push_back({BarSection::bar, (bar + tool) / 2.0});
  for (std::size_t i = 0; i < n; ++i) {
    sections.push_back({BarSection::down, incline});
    sections.push_back({BarSection::between, between});
    sections.push_back({BarSection::up, incline});
    sections.push_back({BarSection::bar, i + 1 < n ? bar + tool : (bar + tool) / 2.0});
  }
  return sections;
}

}  // namespace kerf::pathdxf

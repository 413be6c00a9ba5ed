// Dimensions by their tags alone: the drawing's own reader keeps no shape of them.
#include "codec/drawing/dxf_dimensions.h"

#include <cmath>
#include <numbers>

#include "codec/drawing/dxf_tags.h"

namespace kerf::dxf {
namespace {

double degrees_of(Point from, Point to) {
  return std::atan2(to.x - from.x, to.y - from.y) * 180.0 / std::numbers::pi;
}

/// A coordinate of group 10 to 16 or 20 to 26; null for other groups.
double* coordinate_of(Dimension& dimension, int group) {
  const int digit = group % 10;
  if (digit > 6 || (group / 10 != 1 && group / 10 != 2)) return nullptr;
  Point& p = dimension.points[static_cast<std::size_t>(digit)];
  return group / 10 == 1 ? &p.x : &p.y;
}

}  // namespace

std::vector<Dimension> read_dimensions(std::string_view bytes, const std::string& file_name,
                                       Diagnostics& diagnostics) {
  TagReader tags(bytes, file_name, diagnostics);
  std::vector<Dimension> list;
  bool inside = false;
  while (tags.next()) {
    if (tags.group() == 0) {
      inside = tags.text() == "DIMENSION";
      if (inside) list.emplace_back();
      continue;
    }
    if (!inside) continue;
    Dimension& d = list.back();
    if (tags.group() == 1) d.text = tags.value_text();
    if (tags.group() == 8) d.layer = tags.value_text();
    if (tags.group() == 50) d.angle = tags.number().value_or(0.0);
    if (tags.group() == 70) d.type = tags.integer().value_or(0);
    if (double* coordinate = coordinate_of(d, tags.group())) *coordinate = tags.number().value_or(0.0);
  }
  return list;
}

double measured(const Dimension& d) {
  constexpr int kKinds = 7, kAlongX = 64;
  const auto& p = d.points;
  const auto length = [](Point from, Point to) { return std::hypot(to.x - from.x, to.y - from.y); };
  switch (d.type & kKinds) {
    case 0: {  // along a line of this angle
      const double angle = d.angle * std::numbers::pi / 180.0;
      return std::fabs((p[4].x - p[3].x) * std::cos(angle) + (p[4].y - p[3].y) * std::sin(angle));
    }
    case 1: return length(p[3], p[4]);
    case 2: return std::fabs(degrees_of(p[5], p[0]) - degrees_of(p[3], p[4]));
    case 5: return std::fabs(degrees_of(p[5], p[3]) - degrees_of(p[5], p[4]));
    case 6: return (d.type & kAlongX) != 0 ? p[3].x : p[3].y;
    default: return length(p[0], p[5]);  // diameter, radius
  }
}

}  // namespace kerf::dxf

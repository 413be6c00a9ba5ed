// Draws a silhouette: each line of text is a slice, twice as high as a character is wide.
#include "app/report/sketch.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/number.h"

namespace kerf::app {
namespace {

constexpr double kCellShape = 2.0;  // a character's height over its width
constexpr int kWidest = 60;         // characters

struct Part {
  ToolPart part;
  char ink;
};
constexpr Part kParts[] = {
    {ToolPart::cutting, '#'}, {ToolPart::neck, '='}, {ToolPart::shank, '|'}, {ToolPart::holder, 'H'}};

/// The part at a height and its radius in mm; a blank if there is none.
std::pair<char, double> slice(const Silhouette& tool, double z) {
  for (const auto& [part, ink] : kParts) {
    const Profile& profile = tool.part(part);
    if (profile.empty() || z < profile.bottom() || z > profile.top()) continue;
    return {ink, profile.radius_at(z)};
  }
  return {' ', 0.0};
}

}  // namespace

std::string sketch(const Silhouette& tool, int rows) {
  const double top = tool.top();
  const double widest = tool.max_radius();
  if (!(top > 0.0) || !(widest > 0.0)) return {};
  double row_mm = top / rows;
  row_mm = std::max(row_mm, 2.0 * widest * kCellShape / kWidest);
  const double cell_mm = row_mm / kCellShape;
  const int lines = std::max(1, static_cast<int>(std::ceil(top / row_mm)));
  const int half = std::max(1, static_cast<int>(std::lround(widest / cell_mm)));
  std::string out;
  for (int line = lines - 1; line >= 0; --line) {
    const double z = std::min((line + 0.5) * row_mm, top);
    const auto [ink, radius] = slice(tool, z);
    const int cells = ink == ' ' ? 0 : std::max(1, static_cast<int>(std::lround(radius / cell_mm)));
    out += fmt::format("{:>8}  {}{}\n", number_text(line * row_mm, 2),
                       std::string(static_cast<std::size_t>(std::max(0, half - cells)), ' '),
                       std::string(2 * static_cast<std::size_t>(cells), ink));
  }
  return out;
}

}  // namespace kerf::app

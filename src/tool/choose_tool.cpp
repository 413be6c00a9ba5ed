// Chooses the tool if both the program's comment and the table describe a number.
#include <cmath>
#include <fmt/format.h>

#include "base/codes/tools.h"
#include "base/number.h"
#include "tool/comment_fields.h"
#include "tool/tool_description.h"

#include "kerf/tool/tool.h"

namespace kerf {
namespace {

using detail::CornerFields;
using detail::MillFields;

constexpr double kLength = 0.02;          // mm: two printed decimals, of diameters and radii
constexpr double kTaper = 0.00872664626;  // radians: half a degree, of the angle from the axis
constexpr double kConeTip = 0.12;         // mm: pointed Vs are written with tips of 0.03 and 0.10 mm

bool near(double a, double b, double within = kLength) { return std::abs(a - b) <= within; }

/// A comment with diameter and height exchanged, as some programs write bowls.
bool swapped(const MillFields& table, const MillFields& described) {
  return table.taper == 0.0 && described.taper == 0.0 && table.corner_radius > 0.0 &&
         near(described.diameter, table.height) && near(described.height, table.diameter) &&
         near(described.corner_radius, table.corner_radius);
}

bool same_mill(const ToolShape& known, const MillFields& table, const MillFields& described) {
  if (table.taper == 0.0 || described.taper == 0.0) {
    return table.taper == described.taper && ((near(table.diameter, described.diameter) &&
                                               near(table.corner_radius, described.corner_radius)) ||
                                              swapped(table, described));
  }
  // Some programs write tapered balls with the included angle and a tip like a pointed V's.
  const bool full_angle =
      std::holds_alternative<shape::TaperedBall>(known) && near(2.0 * table.taper, described.taper, kTaper);
  const bool pointed = std::holds_alternative<shape::TaperedBall>(known) && described.diameter <= kConeTip &&
                       table.diameter <= 0.3;
  return (near(table.taper, described.taper, kTaper) || full_angle) &&
         (near(table.diameter, described.diameter, kConeTip) || pointed);
}

/// Some programs write the radius without subtracting half of the tip; the second diameter is then wrong.
bool same_corner(const CornerFields& table, const CornerFields& described) {
  const bool radius = near(table.radius, described.radius) ||
                      near(table.radius, described.radius - 0.5 * described.tip_diameter);
  return near(table.tip_diameter, described.tip_diameter) && radius;
}

bool same_tool(const Tool& table, const Tool& described) {
  const auto table_mill = detail::mill_fields(table.shape);
  const auto described_mill = detail::mill_fields(described.shape);
  if (table_mill && described_mill) return same_mill(table.shape, *table_mill, *described_mill);
  const auto table_corner = detail::corner_fields(table.shape);
  const auto described_corner = detail::corner_fields(described.shape);
  if (table_corner && described_corner) return same_corner(*table_corner, *described_corner);
  // Comments cannot describe undercut tools: they describe a mill of the same diameter.
  const bool describable = write_tool_comment(table.shape).has_value();
  return (!describable || table.shape.index() == described.shape.index()) &&
         near(table.diameter.mm(), described.diameter.mm());
}

/// Whether the sizes of Kerf's own descriptions are those of a tool.
bool same_profile(const Profile& a, const Profile& b) {
  constexpr double kWritten = 1e-4;  // mm; descriptions have six decimals
  if (a.knots.size() != b.knots.size()) return false;
  for (std::size_t i = 0; i < a.knots.size(); ++i)
    if (!near(a.knots[i].r, b.knots[i].r, kWritten) || !near(a.knots[i].z, b.knots[i].z, kWritten) ||
        !near(a.knots[i].bulge, b.knots[i].bulge, kWritten))
      return false;
  return true;
}

}  // namespace

bool detail::agrees(const Tool& known, const Tool& described) {
  if (!is_from_description(described)) return same_tool(known, described);
  return same_profile(known.silhouette.cutting, described.silhouette.cutting);
}

std::string detail::text_of(const Tool& tool) {
  return fmt::format("{} {} mm", name_of(tool.shape), number_text(tool.diameter.mm(), 4));
}

const Tool* choose_tool(const Tool* from_table, const Tool* from_comment, const Origin& where,
                        Diagnostics& diagnostics) {
  if (from_comment == nullptr) return from_table;
  if (from_table == nullptr || detail::agrees(*from_table, *from_comment))
    return from_table ? from_table : from_comment;
  Diagnostic& warning = diagnostics.warning(
      codes::tool_comment_differs, where,
      fmt::format(
          "tool {} is {} by the program's comment, but {} in the tool table; the comment takes precedence",
          from_table->number, detail::text_of(*from_comment), detail::text_of(*from_table)));
  warning.hint = "if the comment is wrong, specify the tool with --tool";
  return from_comment;
}

}  // namespace kerf

// Which tool a program means when its comment and the table both describe the number.
#include <cmath>
#include <fmt/format.h>

#include "tool/comment_fields.h"

#include "kerf/number.h"
#include "kerf/tool.h"

namespace kerf {
namespace {

using detail::CornerFields;
using detail::MillFields;

constexpr double kLength = 0.02;          // mm: two printed decimals, of diameters and radii
constexpr double kTaper = 0.00872664626;  // radians: half a degree, of the angle from the axis
constexpr double kConeTip = 0.12;         // mm: pointed Vs are written with tips of 0.03 and 0.10 mm

bool near(double a, double b, double within = kLength) { return std::abs(a - b) <= within; }

/// A comment whose writer had diameter and height change places, as is known of bowls.
bool swapped(const MillFields& table, const MillFields& told) {
  return table.taper == 0.0 && told.taper == 0.0 && table.corner_radius > 0.0 &&
         near(told.diameter, table.height) && near(told.height, table.diameter) &&
         near(told.corner_radius, table.corner_radius);
}

bool same_mill(const ToolShape& known, const MillFields& table, const MillFields& told) {
  if (table.taper == 0.0 || told.taper == 0.0) {
    return table.taper == told.taper &&
           ((near(table.diameter, told.diameter) && near(table.corner_radius, told.corner_radius)) ||
            swapped(table, told));
  }
  // Of tapered balls some programs write the full angle and a tip like a pointed V's.
  const bool full_angle =
      std::holds_alternative<shape::TaperedBall>(known) && near(2.0 * table.taper, told.taper, kTaper);
  const bool pointed =
      std::holds_alternative<shape::TaperedBall>(known) && told.diameter <= kConeTip && table.diameter <= 0.3;
  return (near(table.taper, told.taper, kTaper) || full_angle) &&
         (near(table.diameter, told.diameter, kConeTip) || pointed);
}

/// Some programs tell the radius without taking off half of the tip; the second diameter then fits neither
/// way.
bool same_corner(const CornerFields& table, const CornerFields& told) {
  const bool radius =
      near(table.radius, told.radius) || near(table.radius, told.radius - 0.5 * told.tip_diameter);
  return near(table.tip_diameter, told.tip_diameter) && radius;
}

bool same_tool(const Tool& table, const Tool& told) {
  const auto table_mill = detail::mill_fields(table.shape);
  const auto told_mill = detail::mill_fields(told.shape);
  if (table_mill && told_mill) return same_mill(table.shape, *table_mill, *told_mill);
  const auto table_corner = detail::corner_fields(table.shape);
  const auto told_corner = detail::corner_fields(told.shape);
  if (table_corner && told_corner) return same_corner(*table_corner, *told_corner);
  // What a comment cannot say (undercut tools) it says as a mill of the same diameter.
  const bool sayable = write_tool_comment(table.shape).has_value();
  return (!sayable || table.shape.index() == told.shape.index()) &&
         near(table.diameter.mm(), told.diameter.mm());
}

std::string text_of(const Tool& tool) {
  return fmt::format("{} {} mm", name_of(tool.shape), number_text(tool.diameter.mm(), 4));
}

}  // namespace

const Tool* choose_tool(const Tool* from_table, const Tool* from_comment, const Origin& where,
                        Diagnostics& diagnostics) {
  if (from_comment == nullptr) return from_table;
  if (from_table == nullptr || same_tool(*from_table, *from_comment))
    return from_table ? from_table : from_comment;
  Diagnostic& warning = diagnostics.warning(
      Code::tool_comment_differs, where,
      fmt::format("tool {} is {} by the program's comment, but {} in the tool table; the comment holds",
                  from_table->number, text_of(*from_comment), text_of(*from_table)));
  warning.hint = "give the tool with --tool, or in a tool file, to settle it";
  return from_comment;
}

}  // namespace kerf

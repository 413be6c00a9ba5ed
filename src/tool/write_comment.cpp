// Writes CutViewer's tool comments, and their fields.
#include <cmath>
#include <fmt/format.h>

#include "base/number.h"
#include "tool/comment_fields.h"
#include "tool/tool_comments.h"

#include "kerf/tool/tool.h"

namespace kerf {
namespace detail {
namespace {

/// The height of the cone: a flute above it would make the tool of the comment wider.
double cone_height(const shape::Vee& v, double half_angle) {
  const double tip = v.tip_radius.mm();
  const double start_r = tip > 0.0 ? tip * std::cos(half_angle) : 0.5 * v.tip_diameter.mm();
  const double start_z = tip * (1.0 - std::sin(half_angle));
  const double cone = start_z + (0.5 * v.diameter.mm() - start_r) / std::tan(half_angle);
  return v.flute.mm() > 0.0 ? std::min(cone, v.flute.mm()) : cone;
}

}  // namespace

std::optional<MillFields> mill_fields(const ToolShape& shape) {
  if (const auto* s = std::get_if<shape::Square>(&shape))
    return MillFields{s->diameter.mm(), 0.0, s->flute.mm(), 0.0};
  if (const auto* s = std::get_if<shape::Ball>(&shape)) {
    return MillFields{s->diameter.mm(), 0.5 * s->diameter.mm(), s->flute.mm(), 0.0};
  }
  if (const auto* s = std::get_if<shape::BullNose>(&shape)) {
    return MillFields{s->diameter.mm(), s->corner_radius.mm(), s->flute.mm(), 0.0};
  }
  if (const auto* s = std::get_if<shape::Bowl>(&shape)) {
    return MillFields{s->diameter.mm(), s->corner_radius.mm(), s->flute.mm(), 0.0};
  }
  if (const auto* s = std::get_if<shape::Vee>(&shape)) {
    const double half = 0.5 * s->included_angle.rad();
    const double tip = s->tip_radius.mm() > 0.0 ? 2.0 * s->tip_radius.mm() : s->tip_diameter.mm();
    return MillFields{tip, s->tip_radius.mm(), cone_height(*s, half), half};
  }
  if (const auto* s = std::get_if<shape::TaperedBall>(&shape)) {
    return MillFields{s->tip_diameter.mm(), 0.5 * s->tip_diameter.mm(), s->flute.mm(),
                      0.5 * s->included_angle.rad()};
  }
  if (const auto* s = std::get_if<shape::FlatGroove>(&shape)) {
    const double widening = 0.5 * (s->diameter - s->tip_diameter).mm();
    return MillFields{s->tip_diameter.mm(), 0.0, s->flute.mm(), std::atan2(widening, s->flute.mm())};
  }
  return std::nullopt;
}

std::optional<CornerFields> corner_fields(const ToolShape& shape) {
  if (const auto* s = std::get_if<shape::Roundover>(&shape)) {
    return CornerFields{s->tip_diameter.mm(), (s->tip_diameter + 2.0 * s->radius).mm(), s->radius.mm(),
                        s->flute.mm(), s->flute.mm()};
  }
  if (const auto* s = std::get_if<shape::CornerRounding>(&shape)) {
    return CornerFields{s->tip_diameter.mm(), s->diameter.mm(), s->radius.mm(), s->height.mm(),
                        s->flute.mm()};
  }
  return std::nullopt;
}

}  // namespace detail

namespace {

/// A length or angle with at least `min_decimals` decimals and at most `max_decimals`.
std::string field(double value, int min_decimals, int max_decimals) {
  const std::string text = number_text(value, max_decimals);
  const std::size_t point = text.find('.');
  const auto decimals = point == std::string::npos ? 0 : static_cast<int>(text.size() - point) - 1;
  return decimals < min_decimals ? fixed_text(value, min_decimals) : text;
}
std::string degree_field(double value) { return field(value, 2, 6); }

/// Writes lengths in units of `scale` mm.
class LengthFields {
 public:
  explicit LengthFields(double scale) : scale_(scale) {}
  std::string operator()(double value) const {
    constexpr int kDecimals = 6;
    constexpr int kInchDecimals = 8;  // an inch is 25.4 mm, so 6 would be coarser than those of mm
    return field(value / scale_, value == 0.0 ? 2 : 0, scale_ == 1.0 ? kDecimals : kInchDecimals);
  }
  std::string operator()(Length value) const { return (*this)(value.mm()); }

 private:
  double scale_;
};

}  // namespace

std::optional<std::string> write_tool_comment(const ToolShape& shape) {
  return write_tool_comment(shape, 1.0);
}

std::optional<std::string> write_tool_comment(const ToolShape& shape, double scale) {
  const LengthFields length_field(scale);
  if (const auto mill = detail::mill_fields(shape)) {
    return fmt::format("TOOL/MILL, {}, {}, {}, {}", length_field(mill->diameter),
                       length_field(mill->corner_radius), length_field(mill->height),
                       degree_field(radians(mill->taper).deg()));
  }
  if (const auto corner = detail::corner_fields(shape)) {
    return fmt::format("TOOL/CRMILL, {}, {}, {}, {}, {}", length_field(corner->tip_diameter),
                       length_field(corner->diameter), length_field(corner->radius),
                       length_field(corner->height), length_field(corner->length));
  }
  if (const auto* s = std::get_if<shape::Drill>(&shape)) {
    return fmt::format("TOOL/DRILL, {}, {}, {}", length_field(s->diameter),
                       degree_field(s->point_angle.deg()), length_field(s->flute));
  }
  if (const auto* s = std::get_if<shape::CentreDrill>(&shape)) {
    return fmt::format("TOOL/CDRILL, {}, {}, {}, {}, {}, {}", length_field(s->pilot_diameter),
                       degree_field(s->pilot_angle.deg()), length_field(s->pilot_length),
                       length_field(s->diameter), degree_field(s->body_angle.deg()), length_field(s->flute));
  }
  if (const auto* s = std::get_if<shape::Chamfer>(&shape)) {
    std::string text = fmt::format("TOOL/CHAMFER, {}, {}, {}", length_field(s->diameter),
                                   degree_field(s->included_angle.deg()), length_field(s->flute));
    const double cone = 0.5 * (s->diameter - s->tip_diameter).mm() / std::tan(0.5 * s->included_angle.rad());
    if (s->tip_diameter.mm() > 0.0) text += ", " + length_field(cone);
    return text;
  }
  return std::nullopt;
}

}  // namespace kerf

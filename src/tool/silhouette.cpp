// The half profile of every shape's cutting part, of lines and arcs with exact tangencies.
#include "tool/silhouette.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/number.h"

namespace kerf::detail {
namespace {

constexpr double kUsualPointAngle = 118.0;  // degrees, of a drill
constexpr double kQuarter = 0.5 * std::numbers::pi;
constexpr double kCatalogueRounding = 0.01;  // mm: catalogues print the height of a cone with two decimals

std::string mm_text(double value) { return number_text(value, 4) + " mm"; }

/// Visits a shape, fills in default dimensions and makes its profile.
class Drawer {
 public:
  explicit Drawer(Length neck_length) : neck_length_(neck_length.mm()) {}

  void operator()(shape::Square& s);
  void operator()(shape::Ball& s);
  void operator()(shape::BullNose& s) { corner_mill(s.diameter, s.flute, s.corner_radius); }
  void operator()(shape::Bowl& s) { corner_mill(s.diameter, s.flute, s.corner_radius); }
  void operator()(shape::Vee& s);
  void operator()(shape::TaperedBall& s);
  void operator()(shape::Keyhole& s);
  void operator()(shape::Dovetail& s);
  void operator()(shape::Roundover& s);
  void operator()(shape::ThreadMill& s);
  void operator()(shape::Lollipop& s);
  void operator()(shape::TSlot& s);
  void operator()(shape::Drill& s);
  void operator()(shape::CentreDrill& s);
  void operator()(shape::FlatGroove& s);
  void operator()(shape::Chamfer& s);
  void operator()(shape::CornerRounding& s);
  void operator()(shape::Drawn& s);

  Cutting result;

 private:
  /// Stores the first reason; true if `fits`.
  bool require(bool fits, const std::string& reason);
  void corner_mill(Length diameter, Length& flute, Length corner_radius);
  /// Ball of `tip_radius` tangent to a cone of the half angle that reaches `radius`, then a cylinder to the
  /// flute.
  void rounded_cone(double tip_radius, double half_angle, double radius, Length& flute);
  /// A cone from a flat tip.
  void blunt_cone(double tip_diameter, double half_angle, double diameter, Length& flute);
  /// A cone from the end of the outline to `radius`, then a cylinder to the flute; flute 0: the end of the
  /// cone.
  void cone(Outline outline, double half_angle, double radius, Length& flute);
  /// From the end of a head inwards to a neck: cutting up to `flute`, or not at all if that is unspecified.
  void necked(Outline head, Length neck_diameter, Length& flute);
  /// The default flute, if the shape has none.
  void assume_flute(Length& flute, Length diameter) {
    result.flute_assumed = flute.mm() == 0.0;
    if (result.flute_assumed) flute = usual_flute(diameter);
  }
  void keep(Outline& outline) { result.cutting = outline.take(); }

  double neck_length_;
};

bool Drawer::require(bool fits, const std::string& reason) {
  if (!fits && result.error.empty()) result.error = reason;
  return fits;
}

void Drawer::operator()(shape::Square& s) {
  assume_flute(s.flute, s.diameter);
  Outline outline(0.0, 0.0);
  outline.line_to(0.5 * s.diameter.mm(), 0.0).line_to(0.5 * s.diameter.mm(), s.flute.mm());
  keep(outline);
}

void Drawer::operator()(shape::Ball& s) {
  assume_flute(s.flute, s.diameter);
  const double radius = 0.5 * s.diameter.mm();
  if (!require(s.flute.mm() >= radius,
               fmt::format("a ball of diameter {} needs a flute of at least {}, not {}",
                           mm_text(2.0 * radius), mm_text(radius), mm_text(s.flute.mm())))) {
    return;
  }
  Outline outline(0.0, 0.0);
  outline.arc_to(radius, radius, kQuarter).line_to(radius, s.flute.mm());
  keep(outline);
}

void Drawer::corner_mill(Length diameter, Length& flute, Length corner_radius) {
  assume_flute(flute, diameter);
  const double radius = 0.5 * diameter.mm();
  const double corner = corner_radius.mm();
  const bool fits =
      require(corner <= radius, fmt::format("a corner radius of {} is more than half the diameter of {}",
                                            mm_text(corner), mm_text(diameter.mm()))) &&
      require(corner <= flute.mm(), fmt::format("a corner radius of {} is higher than the flute of {}",
                                                mm_text(corner), mm_text(flute.mm())));
  if (!fits) return;
  Outline outline(0.0, 0.0);
  outline.line_to(radius - corner, 0.0).arc_to(radius, corner, kQuarter).line_to(radius, flute.mm());
  keep(outline);
}

void Drawer::cone(Outline outline, double half_angle, double radius, Length& flute) {
  const double start_r = outline.r();
  const double start_z = outline.z();
  const double end = start_z + (radius - start_r) / std::tan(half_angle);
  if (flute.mm() == 0.0) flute = mm(end);
  if (!require(flute.mm() > start_z, fmt::format("the flute of {} ends below the cone, which starts at {}",
                                                 mm_text(flute.mm()), mm_text(start_z)))) {
    return;
  }
  if (flute.mm() >= end - kCatalogueRounding) {
    outline.line_to(radius, end);
    if (flute.mm() > end) outline.line_to(radius, flute.mm());
  } else {
    const double reached = start_r + (flute.mm() - start_z) * std::tan(half_angle);
    outline.line_to(reached, flute.mm());
    result.warning =
        fmt::format("the flute of {} ends where the cone is {} wide; {} would need a flute of {}",
                    mm_text(flute.mm()), mm_text(2.0 * reached), mm_text(2.0 * radius), mm_text(end));
  }
  keep(outline);
}

void Drawer::rounded_cone(double tip_radius, double half_angle, double radius, Length& flute) {
  const double tangent_r = tip_radius * std::cos(half_angle);
  const double tangent_z = tip_radius * (1.0 - std::sin(half_angle));
  if (!require(tangent_r <= radius, fmt::format("a tip radius of {} does not fit into a diameter of {}",
                                                mm_text(tip_radius), mm_text(2.0 * radius)))) {
    return;
  }
  Outline outline(0.0, 0.0);
  outline.arc_to(tangent_r, tangent_z, kQuarter - half_angle);
  cone(std::move(outline), half_angle, radius, flute);
}

void Drawer::blunt_cone(double tip_diameter, double half_angle, double diameter, Length& flute) {
  if (!require(tip_diameter < diameter,
               fmt::format("the tip diameter of {} is not less than the diameter of {}",
                           mm_text(tip_diameter), mm_text(diameter)))) {
    return;
  }
  Outline outline(0.0, 0.0);
  outline.line_to(0.5 * tip_diameter, 0.0);
  cone(std::move(outline), half_angle, 0.5 * diameter, flute);
}

void Drawer::operator()(shape::Vee& s) {
  const double half_angle = 0.5 * s.included_angle.rad();
  if (s.tip_radius.mm() > 0.0) {
    if (!require(s.tip_diameter.mm() == 0.0,
                 "a V is either flat (tip_diameter) or rounded (tip_radius), not both")) {
      return;
    }
    rounded_cone(s.tip_radius.mm(), half_angle, 0.5 * s.diameter.mm(), s.flute);
    return;
  }
  blunt_cone(s.tip_diameter.mm(), half_angle, s.diameter.mm(), s.flute);
}

void Drawer::operator()(shape::TaperedBall& s) {
  const double tip = 0.5 * s.tip_diameter.mm();
  const double radius = 0.5 * s.diameter.mm();
  if (s.included_angle.rad() == 0.0) {
    // The line from the cone's end (radius, flute) that touches the ball at (0, tip).
    const double up = s.flute.mm() - tip;
    const bool fits = require(s.flute.mm() > 0.0, "a tapered ball needs its flute or its angle") &&
                      require(tip < radius && up > 0.0,
                              fmt::format("no cone leads from a tip of {} to {} within a flute of {}",
                                          mm_text(2.0 * tip), mm_text(2.0 * radius), mm_text(s.flute.mm())));
    if (!fits) return;
    s.included_angle = radians(2.0 * (std::atan2(radius, up) - std::asin(tip / std::hypot(radius, up))));
  }
  rounded_cone(tip, 0.5 * s.included_angle.rad(), radius, s.flute);
}

void Drawer::operator()(shape::Keyhole& s) {
  if (s.flute.mm() == 0.0) s.flute = 2.0 * s.head;
  const double radius = 0.5 * s.diameter.mm();
  const double neck = 0.5 * s.neck_diameter.mm();
  const bool fits = require(neck < radius, fmt::format("the neck of {} is not narrower than the head of {}",
                                                       mm_text(2.0 * neck), mm_text(2.0 * radius))) &&
                    require(s.flute >= s.head, fmt::format("the flute of {} ends within the head of {}",
                                                           mm_text(s.flute.mm()), mm_text(s.head.mm())));
  if (!fits) return;
  Outline outline(0.0, 0.0);
  outline.line_to(radius, 0.0).line_to(radius, s.head.mm());
  if (s.flute > s.head) outline.line_to(neck, s.head.mm()).line_to(neck, s.flute.mm());
  keep(outline);
}

void Drawer::operator()(shape::Dovetail& s) {
  const double radius = 0.5 * s.diameter.mm();
  const double top = radius - s.flute.mm() * std::tan(s.side_angle.rad());
  if (!require(s.side_angle.rad() < kQuarter && top > 0.0,
               fmt::format("sides of {} degrees meet before the flute of {} ends",
                           number_text(s.side_angle.deg(), 4), mm_text(s.flute.mm())))) {
    return;
  }
  Outline outline(0.0, 0.0);
  outline.line_to(radius, 0.0).line_to(top, s.flute.mm());
  keep(outline);
}

void Drawer::operator()(shape::Roundover& s) {
  if (s.flute.mm() == 0.0) s.flute = s.radius;
  if (!require(s.flute >= s.radius, fmt::format("the flute of {} is lower than the radius of {}",
                                                mm_text(s.flute.mm()), mm_text(s.radius.mm())))) {
    return;
  }
  const double tip = 0.5 * s.tip_diameter.mm();
  const double body = tip + s.radius.mm();
  Outline outline(0.0, 0.0);
  outline.line_to(tip, 0.0).arc_to(body, s.radius.mm(), -kQuarter).line_to(body, s.flute.mm());
  keep(outline);
}

void Drawer::operator()(shape::ThreadMill& s) {
  if (s.length.mm() == 0.0) s.length = s.cut_height;
  const double minor = 0.5 * s.minor_diameter.mm();
  const double major = 0.5 * s.major_diameter.mm();
  const double height = s.cut_height.mm();
  const bool fits =
      require(minor < major, fmt::format("the minor diameter of {} is not less than the major one of {}",
                                         mm_text(2.0 * minor), mm_text(2.0 * major))) &&
      require(s.length >= s.cut_height, fmt::format("the length of {} is less than the cut height of {}",
                                                    mm_text(s.length.mm()), mm_text(height)));
  if (!fits) return;
  Outline outline(0.0, 0.0);
  outline.line_to(minor, 0.0).line_to(major, 0.5 * height).line_to(minor, height);
  keep(outline);
  if (s.length > s.cut_height) result.neck = Outline(minor, height).line_to(minor, s.length.mm()).take();
}

void Drawer::necked(Outline head, Length neck_diameter, Length& flute) {
  const double neck = 0.5 * neck_diameter.mm();
  const double end = head.z();
  if (flute.mm() == 0.0) flute = mm(end);
  if (!require(flute.mm() >= end, fmt::format("the flute of {} ends within the head, which is {} high",
                                              mm_text(flute.mm()), mm_text(end)))) {
    return;
  }
  if (flute.mm() > end) head.line_to(neck, end).line_to(neck, flute.mm());
  keep(head);
  if (neck_length_ > 0.0)
    result.neck = Outline(neck, flute.mm()).line_to(neck, flute.mm() + neck_length_).take();
}

void Drawer::operator()(shape::Lollipop& s) {
  const double radius = 0.5 * s.diameter.mm();
  const double neck = 0.5 * s.neck_diameter.mm();
  if (!require(neck < radius, fmt::format("the neck of {} is not narrower than the ball of {}",
                                          mm_text(2.0 * neck), mm_text(2.0 * radius)))) {
    return;
  }
  Outline head(0.0, 0.0);
  head.arc_to(radius, radius, kQuarter)
      .arc_to(neck, radius + std::sqrt((radius - neck) * (radius + neck)), std::acos(neck / radius));
  necked(std::move(head), s.neck_diameter, s.flute);
}

void Drawer::operator()(shape::TSlot& s) {
  const double radius = 0.5 * s.diameter.mm();
  if (!require(s.neck_diameter < s.diameter,
               fmt::format("the neck of {} is not narrower than the disc of {}",
                           mm_text(s.neck_diameter.mm()), mm_text(2.0 * radius)))) {
    return;
  }
  Outline head(0.0, 0.0);
  head.line_to(radius, 0.0).line_to(radius, s.thickness.mm());
  necked(std::move(head), s.neck_diameter, s.flute);
}

void Drawer::operator()(shape::Drill& s) {
  const double radius = 0.5 * s.diameter.mm();
  if (s.point_angle.rad() == 0.0) s.point_angle = degrees(kUsualPointAngle);
  const double half_angle = 0.5 * s.point_angle.rad();
  assume_flute(s.flute, s.diameter);
  if (result.flute_assumed) s.flute = std::max(s.flute, mm(radius / std::tan(half_angle)));
  cone(Outline(0.0, 0.0), half_angle, radius, s.flute);
}

void Drawer::operator()(shape::CentreDrill& s) {
  const double pilot = 0.5 * s.pilot_diameter.mm();
  const double point = pilot / std::tan(0.5 * s.pilot_angle.rad());
  const bool fits =
      require(s.pilot_diameter < s.diameter,
              fmt::format("the pilot of {} is not narrower than the diameter of {}", mm_text(2.0 * pilot),
                          mm_text(s.diameter.mm()))) &&
      require(s.pilot_length.mm() >= point, fmt::format("the pilot of {} is shorter than its point of {}",
                                                        mm_text(s.pilot_length.mm()), mm_text(point)));
  if (!fits) return;
  Outline outline(0.0, 0.0);
  outline.line_to(pilot, point).line_to(pilot, s.pilot_length.mm());
  cone(std::move(outline), 0.5 * s.body_angle.rad(), 0.5 * s.diameter.mm(), s.flute);
}

void Drawer::operator()(shape::FlatGroove& s) {
  if (!require(s.tip_diameter <= s.diameter,
               fmt::format("the tip diameter of {} is more than the diameter of {}",
                           mm_text(s.tip_diameter.mm()), mm_text(s.diameter.mm())))) {
    return;
  }
  Outline outline(0.0, 0.0);
  outline.line_to(0.5 * s.tip_diameter.mm(), 0.0).line_to(0.5 * s.diameter.mm(), s.flute.mm());
  keep(outline);
}

void Drawer::operator()(shape::Chamfer& s) {
  blunt_cone(s.tip_diameter.mm(), 0.5 * s.included_angle.rad(), s.diameter.mm(), s.flute);
}

void Drawer::operator()(shape::CornerRounding& s) {
  const double tip = 0.5 * s.tip_diameter.mm();
  const double body = 0.5 * s.diameter.mm();
  const double radius = s.radius.mm();
  if (!require(tip < body, fmt::format("the tip diameter of {} is not less than the diameter of {}",
                                       mm_text(2.0 * tip), mm_text(2.0 * body)))) {
    return;
  }
  const double arc_r = std::min(tip + radius, body);
  const double left = tip + radius - arc_r;  // of the quarter arc, if it is not complete
  const double arc_z = std::sqrt((radius - left) * (radius + left));
  if (s.flute.mm() == 0.0) s.flute = std::max(s.height, mm(arc_z));
  const double top = std::max(s.flute, s.height).mm();
  if (!require(top >= arc_z, fmt::format("the height of {} ends below the arc, which is {} high",
                                         mm_text(top), mm_text(arc_z)))) {
    return;
  }
  Outline outline(0.0, 0.0);
  outline.line_to(tip, 0.0).arc_to(arc_r, arc_z, -std::asin(std::min(1.0, arc_z / radius)));
  if (top > arc_z) outline.line_to(body, arc_z).line_to(body, top);
  keep(outline);
}

void Drawer::operator()(shape::Drawn& s) {
  const std::string fault = fault_of(s.cutting);
  if (require(fault.empty(), fault)) result.cutting = s.cutting;
}

}  // namespace

Outline& Outline::line_to(double r, double z) {
  if (r != this->r() || z != this->z()) profile_.knots.push_back({r, z, 0.0});
  return *this;
}

Outline& Outline::arc_to(double r, double z, double sweep) {
  profile_.knots.back().bulge = std::tan(0.25 * sweep);
  profile_.knots.push_back({r, z, 0.0});
  return *this;
}

Cutting cutting_of(const ToolShape& shape, Length neck_length) {
  Drawer drawer(neck_length);
  ToolShape settled = shape;
  std::visit(drawer, settled);
  drawer.result.shape = std::move(settled);
  return std::move(drawer.result);
}

bool cuts_at_centre(const ToolShape& shape) {
  if (const auto* chamfer = std::get_if<shape::Chamfer>(&shape)) return chamfer->tip_diameter.mm() == 0.0;
  return !std::holds_alternative<shape::Dovetail>(shape) &&
         !std::holds_alternative<shape::ThreadMill>(shape) && !std::holds_alternative<shape::TSlot>(shape);
}

}  // namespace kerf::detail

// Makes a tool of a shape and the parts above it; the tool table.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/tools.h"
#include "base/names.h"
#include "base/number.h"
#include "tool/silhouette.h"

#include "kerf/base/limits.h"
#include "kerf/tool/tool.h"

namespace kerf {
namespace {

// Degrees of a cone: beyond them it is a disc or a line.
constexpr double kMinAngle = 0.01;
constexpr double kMaxAngle = 179.0;

/// The fault of a dimension; empty if it is valid.
std::string measure_fault(double value, ShapeParameter::Kind kind, ShapeParameter::Need need) {
  if (!std::isfinite(value)) return "is not a finite number";
  if (value < 0.0) return fmt::format("is {}, but must not be negative", number_text(value, 6));
  if (value == 0.0) return need == ShapeParameter::Need::required ? "is missing or 0" : "";
  if (kind == ShapeParameter::Kind::length) {
    return value > limits::kMaxToolSize ? "is longer than 10 m"
           : value < 1e-6               ? "is smaller than a millionth of a millimetre"
                                        : "";
  }
  if (value < kMinAngle || value > kMaxAngle) {
    return fmt::format("is {} degrees, but must be between {} and {}", number_text(value, 6), kMinAngle,
                       kMaxAngle);
  }
  return "";
}

/// Checks all measures of shape and body, and reports every fault.
class MeasureCheck {
 public:
  MeasureCheck(const Origin& where, Diagnostics& diagnostics) : where_(where), diagnostics_(diagnostics) {}

  void check(const ToolShape& shape) {
    for (const ShapeParameter& parameter : parameters_of(shape)) {
      report(parameter.name, measure_fault(parameter.get(shape), parameter.kind, parameter.need));
    }
  }

  void check(const ToolBody& body, const ToolShape& shape) {
    const bool own_neck =
        std::holds_alternative<shape::Lollipop>(shape) || std::holds_alternative<shape::TSlot>(shape);
    part("neck", body.neck_diameter,
         own_neck && body.neck_diameter.mm() == 0.0 ? Length() : body.neck_length);
    if (own_neck) length("neck_length", body.neck_length);
    part("shank", body.shank_diameter, body.shank_length);
    part("holder", body.holder_diameter, body.holder_length);
  }

  bool fine() const { return fine_; }

 private:
  void report(std::string_view name, const std::string& fault) {
    if (fault.empty()) return;
    fine_ = false;
    diagnostics_.error(codes::tool_measure_bad, where_, fmt::format("the tool's {} {}", name, fault));
  }
  void length(const std::string& name, Length value) {
    report(name, measure_fault(value.mm(), ShapeParameter::Kind::length, ShapeParameter::Need::optional));
  }
  void part(const std::string& name, Length diameter, Length height) {
    length(name + "_diameter", diameter);
    length(name + "_length", height);
    if (diameter.mm() > 0.0 && height.mm() == 0.0) report(name + "_length", "is missing or 0");
    if (diameter.mm() == 0.0 && height.mm() > 0.0) report(name + "_diameter", "is missing or 0");
  }

  const Origin& where_;
  Diagnostics& diagnostics_;
  bool fine_ = true;
};

/// The radius and height at which the next part above starts.
struct Seat {
  double r = 0.0, z = 0.0;
};

/// Puts a cylinder on the seat, with its step or cone, and moves the seat to its top.
Profile stack(Seat& seat, Length diameter, Length length, Transition transition) {
  if (diameter.mm() == 0.0) return {};
  const double radius = 0.5 * diameter.mm();
  const double top = seat.z + length.mm();
  detail::Outline outline(radius > seat.r ? seat.r : radius, seat.z);
  if (radius > seat.r) {
    const double rise = transition == Transition::cone ? std::min(radius - seat.r, length.mm()) : 0.0;
    outline.line_to(rise > 0.0 ? seat.r + rise : radius, seat.z + rise);
  }
  outline.line_to(radius, outline.z()).line_to(radius, top);
  seat = {radius, top};
  return outline.take();
}

/// The neck that the shape brings and the one of the body are one part.
Profile join(Profile lower, const Profile& upper) {
  if (lower.empty()) return upper;
  for (const Knot& knot : upper.knots) {
    if (!(knot == lower.knots.back())) lower.knots.push_back(knot);
  }
  return lower;
}

Silhouette silhouette_of(detail::Cutting& drawn, const ToolBody& body) {
  Silhouette silhouette;
  silhouette.cutting = std::move(drawn.cutting);
  Seat seat{silhouette.cutting.knots.back().r, silhouette.cutting.top()};
  if (!drawn.neck.empty()) seat = {drawn.neck.knots.back().r, drawn.neck.top()};
  silhouette.neck =
      join(std::move(drawn.neck), stack(seat, body.neck_diameter, body.neck_length, Transition::step));
  silhouette.shank = stack(seat, body.shank_diameter, body.shank_length, body.transition);
  silhouette.holder = stack(seat, body.holder_diameter, body.holder_length, Transition::step);
  return silhouette;
}

}  // namespace

std::optional<Tool> make_tool(int number, const ToolShape& shape, const ToolBody& body, const Origin& where,
                              Diagnostics& diagnostics) {
  MeasureCheck check(where, diagnostics);
  check.check(shape);
  check.check(body, shape);
  if (!check.fine()) return std::nullopt;
  detail::Cutting drawn =
      detail::cutting_of(shape, body.neck_diameter.mm() == 0.0 ? body.neck_length : Length());
  if (!drawn.error.empty()) {
    diagnostics.error(codes::tool_shape_impossible, where,
                      fmt::format("{} tool: {}", name_of(shape), drawn.error));
    return std::nullopt;
  }
  if (!drawn.warning.empty()) {
    diagnostics.warning(codes::tool_flute_short, where,
                        fmt::format("{} tool: {}", name_of(shape), drawn.warning));
  }
  Tool tool;
  tool.number = number;
  tool.shape = std::move(drawn.shape);
  tool.silhouette = silhouette_of(drawn, body);
  tool.diameter = mm(2.0 * tool.silhouette.cutting.max_radius());
  tool.flute = mm(tool.silhouette.cutting.top());
  tool.flute_assumed = drawn.flute_assumed;
  tool.plunges = detail::cuts_at_centre(tool.shape);
  return tool;
}

std::string teeth_text(const Tool& tool) {
  return fmt::format("{} teeth{}", tool.teeth, tool.teeth_assumed ? " (assumed)" : "");
}

const Tool* ToolTable::find(int number) const {
  const auto found = tools_.find(number);
  return found == tools_.end() ? nullptr : &found->second;
}

void ToolTable::set(int number, Tool tool) {
  tool.number = number;
  tools_.insert_or_assign(number, std::move(tool));
}

const Tool* ToolTable::find_name(std::string_view name) const {
  const std::string folded = fold_name(name);
  for (const auto& [number, tool] : tools_) {
    for (const std::string& known : tool.names) {
      if (fold_name(known) == folded) return &tool;
    }
  }
  return nullptr;
}

}  // namespace kerf

// Tools: their shapes, silhouettes and numbers.
#include <type_traits>

#include "job/stored/parts.h"

#include "kerf/base/limits.h"

namespace kerf::stored {
namespace {

constexpr std::uint64_t kTeethStated = 2;  // the version from which tools say whether their teeth are assumed

template <class A>
void fields(A& a, Like<A, Knot>& v) {
  auto& [r, z, bulge] = v;
  values(a, r, z, bulge);
}

template <class A>
void fields(A& a, Like<A, shape::Square>& v) {
  auto& [diameter, flute] = v;
  values(a, diameter, flute);
}
template <class A>
void fields(A& a, Like<A, shape::Ball>& v) {
  auto& [diameter, flute] = v;
  values(a, diameter, flute);
}
template <class A>
void fields(A& a, Like<A, shape::BullNose>& v) {
  auto& [diameter, flute, corner_radius] = v;
  values(a, diameter, flute, corner_radius);
}
template <class A>
void fields(A& a, Like<A, shape::Bowl>& v) {
  auto& [diameter, flute, corner_radius] = v;
  values(a, diameter, flute, corner_radius);
}
template <class A>
void fields(A& a, Like<A, shape::Vee>& v) {
  auto& [diameter, flute, included_angle, tip_diameter, tip_radius] = v;
  values(a, diameter, flute, included_angle, tip_diameter, tip_radius);
}
template <class A>
void fields(A& a, Like<A, shape::TaperedBall>& v) {
  auto& [diameter, flute, included_angle, tip_diameter] = v;
  values(a, diameter, flute, included_angle, tip_diameter);
}
template <class A>
void fields(A& a, Like<A, shape::Keyhole>& v) {
  auto& [diameter, head, neck_diameter, flute] = v;
  values(a, diameter, head, neck_diameter, flute);
}
template <class A>
void fields(A& a, Like<A, shape::Dovetail>& v) {
  auto& [diameter, flute, side_angle] = v;
  values(a, diameter, flute, side_angle);
}
template <class A>
void fields(A& a, Like<A, shape::Roundover>& v) {
  auto& [tip_diameter, radius, flute] = v;
  values(a, tip_diameter, radius, flute);
}
template <class A>
void fields(A& a, Like<A, shape::ThreadMill>& v) {
  auto& [minor_diameter, major_diameter, cut_height, length] = v;
  values(a, minor_diameter, major_diameter, cut_height, length);
}
template <class A>
void fields(A& a, Like<A, shape::Lollipop>& v) {
  auto& [diameter, neck_diameter, flute] = v;
  values(a, diameter, neck_diameter, flute);
}
template <class A>
void fields(A& a, Like<A, shape::TSlot>& v) {
  auto& [diameter, thickness, neck_diameter, flute] = v;
  values(a, diameter, thickness, neck_diameter, flute);
}
template <class A>
void fields(A& a, Like<A, shape::Drill>& v) {
  auto& [diameter, flute, point_angle] = v;
  values(a, diameter, flute, point_angle);
}
template <class A>
void fields(A& a, Like<A, shape::CentreDrill>& v) {
  auto& [pilot_diameter, pilot_length, pilot_angle, diameter, flute, body_angle] = v;
  values(a, pilot_diameter, pilot_length, pilot_angle, diameter, flute, body_angle);
}
template <class A>
void fields(A& a, Like<A, shape::FlatGroove>& v) {
  auto& [diameter, flute, tip_diameter] = v;
  values(a, diameter, flute, tip_diameter);
}
template <class A>
void fields(A& a, Like<A, shape::Chamfer>& v) {
  auto& [diameter, flute, included_angle, tip_diameter] = v;
  values(a, diameter, flute, included_angle, tip_diameter);
}
template <class A>
void fields(A& a, Like<A, shape::CornerRounding>& v) {
  auto& [tip_diameter, diameter, radius, height, flute] = v;
  values(a, tip_diameter, diameter, radius, height, flute);
}

void write(Sink& a, const Profile& profile) {
  a.whole(profile.knots.size());
  for (const Knot& knot : profile.knots) fields(a, knot);
}
void read(Source& a, Profile& profile) {
  constexpr std::size_t kKnotBytes = 3 * sizeof(double);
  for (std::size_t left = a.entries(kKnotBytes); left > 0 && !a.failed(); --left)
    fields(a, profile.knots.emplace_back());
  if (!is_valid(profile)) a.refuse("a tool has an invalid profile");
}

template <class A>
void fields(A& a, Like<A, shape::Drawn>& v) {
  auto& [cutting] = v;
  if constexpr (A::kReads)
    read(a, cutting);
  else
    write(a, cutting);
}

/// A shape of the kind with this index.
template <std::size_t I = 0>
void make_shape(std::size_t index, ToolShape& shape) {
  if constexpr (I < std::variant_size_v<ToolShape>) {
    if (index == I)
      shape = std::variant_alternative_t<I, ToolShape>{};
    else
      make_shape<I + 1>(index, shape);
  }
}

void write(Sink& a, const ToolShape& shape) {
  a.byte(static_cast<std::uint8_t>(shape.index()));
  std::visit([&a](const auto& s) { fields(a, s); }, shape);
}
void read(Source& a, ToolShape& shape) {
  const std::size_t index = a.byte();
  if (index >= std::variant_size_v<ToolShape>) return a.refuse("a tool has an unknown shape");
  make_shape(index, shape);
  std::visit([&a](auto& s) { fields(a, s); }, shape);
  for (const ShapeParameter& p : parameters_of(shape))
    if (!(p.get(shape) >= 0.0 && p.get(shape) <= limits::kMaxToolSize))
      a.refuse("a dimension of a tool is out of range");
}

template <class A>
void fields(A& a, Like<A, Silhouette>& v) {
  auto& [cutting, neck, shank, holder] = v;
  for (auto* profile : {&cutting, &neck, &shank, &holder}) {
    if constexpr (A::kReads)
      read(a, *profile);
    else
      write(a, *profile);
  }
}

template <class A>
void fields(A& a, Like<A, Tool>& v) {
  auto& [number, names, description, shape, silhouette, diameter, flute, flute_assumed, teeth, teeth_assumed,
         plunges] = v;
  values(a, number, names, description);
  if constexpr (A::kReads)
    read(a, shape);
  else
    write(a, shape);
  fields(a, silhouette);
  values(a, diameter, flute, flute_assumed, teeth);
  if constexpr (A::kReads) {
    if (a.version() < kTeethStated) {
      teeth_assumed = teeth == Tool{}.teeth;
      return values(a, plunges);
    }
  }
  values(a, teeth_assumed, plunges);
}

bool is_size(Length v) { return v >= Length() && v.mm() <= limits::kMaxToolSize; }

}  // namespace

void value(Sink& a, const Tool& tool) { fields(a, tool); }
void value(Source& a, Tool& tool) {
  fields(a, tool);
  if (tool.silhouette.cutting.empty() || !is_size(tool.diameter) || !is_size(tool.flute))
    a.refuse("a tool has no size");
}

void value(Sink& a, const ToolTable& table) { value(a, table.tools()); }
void value(Source& a, ToolTable& table) {
  std::map<int, Tool> tools;
  value(a, tools);
  table = {};
  for (auto& [number, tool] : tools) table.set(number, std::move(tool));
}

}  // namespace kerf::stored

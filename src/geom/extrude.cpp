// Figures given a thickness.
#include "kerf/extrude.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "outline_check.h"
#include "triangulate.h"

namespace kerf {
namespace {

using namespace outline_detail;

constexpr int kMostChords = 1 << 12;  // of one arc
constexpr int kFewestChords = 16;     // of a full circle, so that a coarse tolerance still leaves it round

/// Appends the points of an arc after its begin, without its end.
void add_arc(Ring& ring, Point2 from, const ArcCircle& circle, double chord) {
  const double step = 2.0 * std::acos(1.0 - std::min(chord / circle.radius, 1.0));
  const double least = circle.sweep.deg() / 360.0 * kFewestChords;
  const double wanted = std::ceil(std::max(step > 0.0 ? circle.sweep.rad() / step : kMostChords, least));
  const int count = static_cast<int>(std::min<double>(wanted, kMostChords));
  const Point2 d = from - circle.centre;
  const double begin = std::atan2(d.y, d.x), sense = circle.turn == Turn::ccw ? 1.0 : -1.0;
  for (int i = 1; i < count; ++i) {
    const double angle = begin + sense * circle.sweep.rad() * i / count;
    ring.push_back(circle.centre + circle.radius * Point2{std::cos(angle), std::sin(angle)});
  }
}

Ring ring_of(const Outline& outline, const Tolerance& tolerance) {
  Ring ring{outline.start};
  Point2 from = outline.start;
  for (const Segment& segment : outline.segments) {
    if (const auto circle = arc_circle(from, segment)) add_arc(ring, from, *circle, tolerance.chord.mm());
    from = segment.to;
    if (distance(ring.back(), from) > tolerance.weld.mm()) ring.push_back(from);
  }
  while (ring.size() > 1 && distance(ring.back(), ring.front()) <= tolerance.weld.mm()) ring.pop_back();
  return ring;
}

Ring ring_of(const Circle& circle, const Tolerance& tolerance) {
  const Point2 right = circle.centre + Point2{circle.radius.mm(), 0.0};
  Ring ring{right};
  const ArcCircle whole{circle.centre, circle.radius.mm(), Turn::ccw, degrees(360.0)};
  add_arc(ring, right, whole, tolerance.chord.mm());
  return ring;
}

/// The rings of a figure, the outside counter-clockwise and the holes clockwise; empty where one is no ring.
std::vector<Ring> rings_of(const Figure& figure, const Tolerance& tolerance, Diagnostics& diagnostics) {
  std::vector<Ring> rings;
  for (const auto& shape : figure) {
    const std::string name = fmt::format("figure.ol{}", rings.size());
    const auto refuse = [&](std::string_view what) {
      diagnostics.error(Code::figure_not_solid, {}, fmt::format("{}: {}", name, what));
      return std::vector<Ring>();
    };
    if (const auto* circle = std::get_if<Circle>(&shape)) {
      const bool sound = std::isfinite(circle->centre.x) && std::isfinite(circle->centre.y) &&
                         std::isfinite(circle->radius.mm()) && circle->radius > tolerance.weld;
      if (!sound) return refuse("the circle's radius is not above 0, or a number is not finite");
      rings.push_back(ring_of(*circle, tolerance));
    } else {
      const Outline& outline = std::get<Outline>(shape);
      if (!check_outline(outline, name, {}, diagnostics)) return {};
      if (!outline.closed()) return refuse("an open outline has no inside");
      rings.push_back(ring_of(outline, tolerance));
    }
    const double size = rings.back().size() < 3 ? 0.0 : area(rings.back());
    if (size == 0.0) return refuse("the outline has no area");
    if ((size > 0.0) != (rings.size() == 1)) std::reverse(rings.back().begin(), rings.back().end());
  }
  return rings;
}

}  // namespace

std::optional<SolidMesh> extrude(const Figure& figure, Length height, const Tolerance& tolerance,
                                 Diagnostics& diagnostics) {
  if (figure.empty() || !std::isfinite(height.mm()) || height <= Length()) {
    diagnostics.error(Code::figure_not_solid, {},
                      "a figure with an outline, and a height above 0, are needed");
    return std::nullopt;
  }
  const std::vector<Ring> rings = rings_of(figure, tolerance, diagnostics);
  if (rings.empty()) return std::nullopt;
  const Triangulation caps = triangulate(rings);
  if (caps.too_much) {
    diagnostics.error(Code::figure_not_solid, {},
                      "the figure has too many points; a coarser chord tolerance helps");
    return std::nullopt;
  }
  if (caps.triangles.empty()) {
    diagnostics.error(
        Code::figure_crosses, {},
        "outlines of the figure cross themselves or each other, or a hole is not inside the first");
    return std::nullopt;
  }
  SolidMesh mesh;
  std::uint32_t points = 0;
  for (const Ring& ring : rings) points += static_cast<std::uint32_t>(ring.size());
  for (const double z : {0.0, height.mm()})
    for (const Ring& ring : rings)
      for (const Point2 p : ring)
        for (const double v : {p.x, p.y, z}) mesh.positions.push_back(static_cast<float>(v));
  for (const auto& [a, b, c] : caps.triangles)
    for (const std::uint32_t i : {a, c, b, a + points, b + points, c + points}) mesh.triangles.push_back(i);
  std::uint32_t first = 0;
  for (const Ring& ring : rings) {
    const auto n = static_cast<std::uint32_t>(ring.size());
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t a = first + k, b = first + (k + 1) % n;
      for (const std::uint32_t i : {a, b, b + points, a, b + points, a + points}) mesh.triangles.push_back(i);
    }
    first += n;
  }
  return mesh;
}

}  // namespace kerf

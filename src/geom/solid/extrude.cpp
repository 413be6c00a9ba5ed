// Prisms of figures.
#include "geom/solid/extrude.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "base/codes/outline.h"
#include "geom/outline/outline_check.h"
#include "triangulate.h"

#include "kerf/geom/mesh_check.h"

namespace kerf {
namespace {

using namespace outline_detail;

Ring ring_of(const Outline& outline, const Tolerance& tolerance) {
  Ring ring;
  for (const Point2 p : flattened(outline, tolerance.chord))
    if (ring.empty() || distance(ring.back(), p) > tolerance.weld.mm()) ring.push_back(p);
  while (ring.size() > 1 && distance(ring.back(), ring.front()) <= tolerance.weld.mm()) ring.pop_back();
  return ring;
}

Ring ring_of(const Circle& circle, const Tolerance& tolerance) { return flattened(circle, tolerance.chord); }

/// The rings of a figure, the outside counter-clockwise and the holes clockwise; empty where one is no ring.
std::vector<Ring> rings_of(const Figure& figure, const Tolerance& tolerance, Diagnostics& diagnostics) {
  std::vector<Ring> rings;
  for (const auto& shape : figure) {
    const std::string name = fmt::format("figure.ol{}", rings.size());
    const auto refuse = [&](std::string_view what) {
      diagnostics.error(codes::figure_not_solid, {}, fmt::format("{}: {}", name, what));
      return std::vector<Ring>();
    };
    if (const auto* circle = std::get_if<Circle>(&shape)) {
      const bool valid = std::isfinite(circle->centre.x) && std::isfinite(circle->centre.y) &&
                         std::isfinite(circle->radius.mm()) && circle->radius > tolerance.weld;
      if (!valid) return refuse("the circle's radius is not above 0, or a number is not finite");
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

/// The volume of a prism over the rings. Its corners are rounded to single precision.
VolumeRange volume_of(const std::vector<Ring>& rings, double height) {
  double base = 0.0, around = 0.0, farthest = height;
  for (const Ring& ring : rings) {
    base += area(ring);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      around += distance(ring[k], ring[(k + 1) % ring.size()]);
      farthest = std::max({farthest, std::abs(ring[k].x), std::abs(ring[k].y)});
    }
  }
  const double moved = farthest * static_cast<double>(std::numeric_limits<float>::epsilon());
  return {mm3(base * height), mm3(moved * (2.0 * base + around * height))};
}

}  // namespace

std::optional<SolidMesh> extrude(const Figure& figure, Length height, const Tolerance& tolerance,
                                 Diagnostics& diagnostics) {
  if (figure.empty() || !std::isfinite(height.mm()) || height <= Length()) {
    diagnostics.error(codes::figure_not_solid, {},
                      "a figure with an outline, and a height above 0, are needed");
    return std::nullopt;
  }
  const std::vector<Ring> rings = rings_of(figure, tolerance, diagnostics);
  if (rings.empty()) return std::nullopt;
  const Triangulation caps = triangulate(rings);
  if (caps.too_much) {
    diagnostics.error(codes::figure_not_solid, {},
                      "the figure has too many points; a coarser chord tolerance helps");
    return std::nullopt;
  }
  if (caps.triangles.empty()) {
    diagnostics.error(
        codes::figure_crosses, {},
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
  if (!verify_mesh(mesh.positions, mesh.triangles, volume_of(rings, height.mm()), diagnostics))
    return std::nullopt;
  return mesh;
}

}  // namespace kerf

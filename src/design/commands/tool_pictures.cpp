// Drawings and solids of tools.
#include "design/commands/tool_pictures.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "kerf/drawing/drawing_files.h"
#include "kerf/formats/mesh_files.h"
#include "kerf/geom/outline.h"

namespace kerf::design {
namespace {

constexpr int kSides = 48;            // of the solid
constexpr Length kChord = mm(0.002);  // of its profile
constexpr int kCuttingColour = 3, kShaftColour = 1;

/// The closed outline of a part, from the axis or to both sides of it.
drawing::Polyline outline_of(const Profile& profile, Sides sides) {
  drawing::Polyline made;
  made.closed = true;
  const std::vector<Knot>& knots = profile.knots;
  const auto add = [&](double x, double z, double bulge) { made.vertices.push_back({x, z, bulge, 0.0}); };
  if (sides == Sides::one && knots.front().r > 0.0) add(0.0, knots.front().z, 0.0);
  for (std::size_t i = 0; i < knots.size(); ++i)
    add(knots[i].r, knots[i].z, i + 1 < knots.size() ? knots[i].bulge : 0.0);
  if (sides == Sides::one) {
    if (knots.back().r > 0.0) add(0.0, knots.back().z, 0.0);
    return made;
  }
  for (std::size_t i = knots.size(); i-- > 0;)
    if (knots[i].r > 0.0) add(-knots[i].r, knots[i].z, i > 0 ? knots[i - 1].bulge : 0.0);
  return made;
}

std::size_t add_layer(Drawing& drawing, const char* name, int colour) {
  DrawingLayer layer;
  layer.name = name;
  layer.colour = colour;
  layer.rgb = colour_of_index(colour);
  drawing.layers.push_back(std::move(layer));
  return drawing.layers.size() - 1;
}

/// The points of all parts from the tip upwards, without those on the axis.
std::vector<Point2> silhouette_points(const Tool& tool) {
  std::vector<Point2> points;
  for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder}) {
    const Profile& profile = tool.silhouette.part(part);
    if (profile.empty()) continue;
    Outline outline{{profile.knots.front().r, profile.knots.front().z}, {}};
    for (std::size_t i = 1; i < profile.knots.size(); ++i) {
      const Knot &from = profile.knots[i - 1], &to = profile.knots[i];
      const Point2 a{from.r, from.z}, b{to.r, to.z};
      Segment segment{b, {}};
      if (from.bulge != 0.0) segment.via = 0.5 * (a + b) - 0.5 * from.bulge * left_of(b - a);
      outline.segments.push_back(segment);
    }
    for (const Point2 p : flattened(outline, kChord))
      if (p.x > 0.0 && (points.empty() || !(p == points.back()))) points.push_back(p);
  }
  return points;
}

/// The mesh of points turned about the axis.
struct Turned {
  std::vector<float> positions;
  std::vector<std::uint32_t> triangles;

  std::uint32_t add(double x, double y, double z) {
    for (const double v : {x, y, z}) positions.push_back(static_cast<float>(v));
    return static_cast<std::uint32_t>(positions.size() / 3 - 1);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t corner : {a, b, c}) triangles.push_back(corner);
  }
};

Turned turned(const std::vector<Point2>& points) {
  Turned mesh;
  for (const Point2 p : points)
    for (int k = 0; k < kSides; ++k) {
      const double a = 2 * std::numbers::pi * k / kSides;
      mesh.add(p.x * std::cos(a), p.x * std::sin(a), p.y);
    }
  const std::uint32_t low = mesh.add(0.0, 0.0, points.front().y), high = mesh.add(0.0, 0.0, points.back().y);
  const auto last = static_cast<std::uint32_t>((points.size() - 1) * kSides);
  for (std::uint32_t k = 0; k < kSides; ++k) {
    const std::uint32_t next = (k + 1) % kSides;
    mesh.triangle(low, next, k);
    mesh.triangle(high, last + k, last + next);
    for (std::uint32_t ring = 0; ring < last; ring += kSides) {
      mesh.triangle(ring + k, ring + next, ring + kSides + next);
      mesh.triangle(ring + k, ring + kSides + next, ring + kSides + k);
    }
  }
  return mesh;
}

}  // namespace

std::string tool_svg(const Tool& tool, Sides sides, std::string title) {
  Drawing drawing;
  drawing.title = std::move(title);
  const std::size_t cutting = add_layer(drawing, "tool", kCuttingColour);
  const std::size_t shaft = add_layer(drawing, "shaft", kShaftColour);
  for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder}) {
    const Profile& profile = tool.silhouette.part(part);
    if (profile.empty()) continue;
    drawing.entities.push_back({part == ToolPart::cutting ? cutting : shaft, outline_of(profile, sides)});
  }
  return write_svg(drawing);
}

std::string tool_stl(const Tool& tool, std::string_view name) {
  const Turned mesh = turned(silhouette_points(tool));
  MeshView view{};
  view.positions = mesh.positions;
  view.triangles = mesh.triangles;
  view.name = std::string(name);
  return write_mesh(view, MeshFormat::stl);
}

}  // namespace kerf::design

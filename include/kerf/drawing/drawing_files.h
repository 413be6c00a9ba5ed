// Flat drawings as files: DXF and SVG bytes from plain structs. No policy, no geometry.
//
// Frame: x to the right, y up, in the drawing's unit; the SVG writer turns y down in its numbers. Angles are
// degrees, counter-clockwise from +x. Numbers must be finite.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace kerf {

enum class DrawingUnit : std::uint8_t { none, mm, inch };
enum class LineKind : std::uint8_t { solid, dashed };

struct DrawingLayer {
  std::string name = "0";
  int colour = 7;                     // AutoCAD colour index, 1 to 255; for DXF
  std::array<std::uint8_t, 3> rgb{};  // sRGB; for SVG
  double line_width = 0.25;           // in the drawing's unit; for SVG
  LineKind line = LineKind::solid;
};

namespace drawing {
struct Line {
  double x1 = 0.0, y1 = 0.0, x2 = 0.0, y2 = 0.0;
  double z1 = 0.0, z2 = 0.0;  // for DXF
  bool operator==(const Line&) const = default;
};
struct Arc {  // counter-clockwise from start to end
  double x = 0.0, y = 0.0, radius = 0.0, start = 0.0, end = 0.0;
  double z = 0.0;  // for DXF
  bool operator==(const Arc&) const = default;
};
struct Circle {
  double x = 0.0, y = 0.0, radius = 0.0;
  double z = 0.0;  // for DXF
  bool operator==(const Circle&) const = default;
};
struct Vertex {
  double x = 0.0, y = 0.0;
  /// Tangent of a quarter of the sweep to the next vertex, above 0 counter-clockwise; 0: a line.
  double bulge = 0.0;
  double radius = 0.0;  // of that arc, if known more precisely than from the bulge; for SVG
  bool operator==(const Vertex&) const = default;
};
struct Polyline {
  std::vector<Vertex> vertices;  // at least two
  bool closed = false;           // then not with the first vertex repeated at the end
  bool operator==(const Polyline&) const = default;
};
struct Text {
  double x = 0.0, y = 0.0, height = 2.5;
  std::string text;  // UTF-8
  bool operator==(const Text&) const = default;
};
}  // namespace drawing

struct DrawingEntity {
  std::size_t layer = 0;  // index into Drawing::layers
  std::variant<drawing::Line, drawing::Arc, drawing::Circle, drawing::Polyline, drawing::Text> shape;
};

struct Drawing {
  DrawingUnit unit = DrawingUnit::mm;
  std::vector<DrawingLayer> layers{DrawingLayer{}};
  std::vector<DrawingEntity> entities;
  std::string title;  // of the SVG
};

/// Low x, low y, high x, high y of all entities, arcs and bulges included; zeros for an empty drawing.
std::array<double, 4> drawing_bounds(const Drawing& drawing);

/// R12 for old programs: polylines as vertices, names in capitals.
enum class DxfVersion : std::uint8_t { r2000, r12 };

/// A complete AutoCAD file: header with unit and extents, tables of layers and line types, and (but in R12)
/// owners and subclass markers, as strict readers require.
std::string write_dxf(const Drawing& drawing, DxfVersion version = DxfVersion::r2000);

/// Red, green and blue of an AutoCAD colour index on white paper; index 7 is black there.
std::array<std::uint8_t, 3> colour_of_index(int index);

/// SVG 1.1 with its true size: width and height in mm or inch, one unit of the view box is one of the
/// drawing. Each layer is a group; arcs stay arcs. Without a unit the size is in pixels.
std::string write_svg(const Drawing& drawing);

}  // namespace kerf

// The paths of a drawing as drawn: elements, markers and probes per path, each with its parameter text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "front/pathdxf/text/parameters.h"
#include "front/pathdxf/text/path_names.h"
#include "front/pathdxf/text/report.h"

#include "kerf/base/origin.h"
#include "kerf/geom/geometry.h"

namespace kerf::pathdxf {

enum class Shape : std::uint8_t { circle, line, arc };
/// What a line type means. `marker`: PHANTOM, `skipped`: HIDDEN and DOT.
enum class LineKind : std::uint8_t { mill, mark, bars, embedding, sweep, skipped, marker, unknown };

/// A line, arc or circle on a path layer, in mm of the drawing.
struct Element {
  Shape shape = Shape::line;
  LineKind kind = LineKind::unknown;
  std::uint32_t layer = 0;     // index into DrawingPaths::layers
  std::uint32_t linetype = 0;  // index into DrawingPaths::linetypes
  std::uint64_t handle = 0;
  int text = -1;  // index into DrawingPaths::texts
  Point2 start, end;
  Point2 centre;             // of arcs and circles
  double radius = 0.0;       // of arcs and circles
  double start_angle = 0.0;  // radians, of arcs
  double turn = 0.0;         // radians, of arcs: above 0 counter-clockwise

  /// The point that messages name: the start of a line, the centre of others.
  Point2 position() const { return shape == Shape::line ? start : centre; }
};

struct PathDrawing {
  std::string name;               // "8998.1P"
  std::vector<Element> elements;  // circles, lines, arcs, each in the order of the file
  std::optional<Element> start, end;
  std::vector<Element> probes;
  bool usable = true;
};

struct DrawingPaths {
  std::string file;       // as opened
  std::string file_name;  // without its folder
  std::string folder;     // with its last slash, or empty
  std::string version;    // "AC1015"
  std::vector<std::string> layers, linetypes;
  std::vector<ParameterText> texts;
  std::vector<PathDrawing> paths;
  bool usable = true;  // false: errors that leave no path usable

  Origin origin(const Element& element) const;
  Origin origin(const PathDrawing& path) const;
  const ParameterText* text_of(const Element& element) const {
    return element.text < 0 ? nullptr : &texts[static_cast<std::size_t>(element.text)];
  }
  const PathDrawing* find(std::string_view name) const;
};

/// Reads the paths of a DXF file. What is wrong is reported.
DrawingPaths read_drawing(const std::string& file, const PathNames& names, const PathdxfOptions& options,
                          Report& report);

/// "8998.1P[8998.dxf]"
std::string name_in_file(const PathDrawing& path, const DrawingPaths& drawing);
/// "[1.000 2.000]"
std::string point_text(Point2 p);

}  // namespace kerf::pathdxf

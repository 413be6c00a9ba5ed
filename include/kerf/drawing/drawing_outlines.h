// Outlines from the layers of a DXF or SVG drawing: loose entities joined, curves as arcs, blocks inserted,
// in mm.
//
//   Diagnostics diagnostics;
//   const auto drawing = dxf::read_dxf(bytes, "part.dxf", diagnostics);
//   DrawingOutlineOptions options;
//   options.layers = {"CUT"};
//   // drawn->outlines, drawn->open_ends:
//   const auto drawn = drawn_outlines(*drawing, options, diagnostics);
//   const auto region = drawn_region(*drawn, Combining::drawn, {}, diagnostics);
//
// Frame: the drawing's world coordinates seen from above, x to the right, y up. Entities are joined within a
// layer only. Open ends are reported with their coordinates.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/drawing/dxf.h"
#include "kerf/drawing/svg.h"
#include "kerf/geom/outline.h"
#include "kerf/geom/region.h"

namespace kerf {

/// Of DrawingOutlineOptions::texts, for help pages.
inline constexpr std::string_view kTextsMeaning =
    "Texts of a drawing: in its own fonts (drawn, default), left out (none), or all in a built-in font of "
    "single strokes or a font file (sans, FILE.ttf)";

/// What becomes of what an SVG's clips and edges of viewports hide.
enum class HiddenParts : std::uint8_t { left_out, drawn };

struct DrawingOutlineOptions {
  std::vector<std::string> layers;  ///< only these; none: all that are neither off nor frozen
  /// Of one drawing unit. None: as specified by the drawing ($INSUNITS, the width of an SVG); an error if it
  /// specifies none.
  std::optional<Length> unit;
  Length within = mm(0.01);  ///< maximum deviation of arcs from ellipses and splines
  Length join = mm(0.01);    ///< maximum gap that is closed (ChainOptions)
  Tolerance tolerance{};
  StrokeShapes strokes = StrokeShapes::lines;
  std::vector<std::string> stroke_layers;  ///< strokes are areas on these layers anyway
  /// "drawn": texts in the fonts that the drawing names, where they are installed, areas of outline fonts and
  /// single strokes of AutoCAD's; "none": left out; else a built-in font or a font file for all texts.
  std::string texts = "drawn";
  HiddenParts hidden_parts = HiddenParts::left_out;
  Length max_coordinate = mm(1e7);       ///< entities beyond are refused
  std::size_t max_segments = 5'000'000;  ///< of all outlines
  dxf::VisitOptions visit{};
  Progress* progress = nullptr;  ///< may stop the work: then there is no value, and no error
};

struct DrawnOutline {
  std::string name;  ///< layer and number, from 1: "CUT.1"
  std::string layer;
  Outline outline;                   ///< mm
  std::optional<Circle> circle;      ///< if the outline is a whole circle
  Origin where;                      ///< of its first entity
  std::vector<std::string> handles;  ///< of its entities, in order
  OutlineFill fill{};  ///< of an SVG's element or a hatch, whose other outlines have the same figure
  bool is_text = false;
};
/// An entity of the type POINT.
struct DrawnPoint {
  Point2 at;  // mm
  std::string layer, handle;
};
struct DrawnOpenEnd {
  Point2 at;                      // mm
  std::string layer, entity;      ///< "LINE 2F"
  std::optional<Point2> nearest;  ///< the nearest other open end of the layer
  Length distance;                ///< to it
};
struct DrawnJunction {
  Point2 at;  // mm
  std::string layer;
  std::vector<std::string> entities;  ///< "LINE 2F": some of its entities
};
struct DrawingOutlines {
  Length unit;                         ///< of one drawing unit
  std::vector<DrawnOutline> outlines;  ///< by layer in the order of the layer table, then as in the file
  std::vector<DrawnPoint> points;
  std::vector<DrawnOpenEnd> open_ends;
  std::vector<DrawnJunction> junctions;
};

/// Nothing, with an error appended, if the unit is missing, a layer does not exist, or there is neither an
/// outline nor a point. Entities that are not outlines, texts whose font is not installed, repeated ones,
/// open ends, junctions, entities that do not lie in a plane parallel to XY, and those that cannot be
/// converted are warnings.
std::optional<DrawingOutlines> drawn_outlines(const dxf::Drawing& drawing,
                                              const DrawingOutlineOptions& options, Diagnostics& diagnostics);

/// The region that the outlines bound. An open outline that is not filled is left out with a warning; an
/// error if none is left.
std::optional<Region> drawn_region(const DrawingOutlines& drawn, Combining combining,
                                   const RegionOptions& options, Diagnostics& diagnostics);

/// The entities on one layer of the model, with blocks inserted.
struct LayerContent {
  std::string name;
  bool off = false, frozen = false;
  int colour = 7;
  std::string linetype;
  std::size_t entities = 0;
  std::vector<std::pair<std::string, std::size_t>> types;  ///< "LINE", 12; in order of first appearance
};
/// In the order of the layer table, including layers without entities.
std::vector<LayerContent> layer_contents(const dxf::Drawing& drawing, const dxf::VisitOptions& options,
                                         Diagnostics& diagnostics);

}  // namespace kerf

// Shapes of SVG as entities of a drawing.
#pragma once

#include <cstddef>
#include <vector>

#include "codec/drawing/svg_values.h"

#include "kerf/drawing/dxf.h"

namespace kerf::svg {

/// Appends entities with the layer and line of one element; coordinates are transformed to the drawing's.
/// Pieces of a path have the same Entity::chain, so that only they are joined.
class EntityWriter {
 public:
  EntityWriter(dxf::Drawing& drawing, std::uint32_t& chains) : drawing_(drawing), chains_(chains) {}

  struct Setting {
    Affine matrix;  // to the drawing
    std::uint32_t layer = 0;
    std::size_t line = 0;
    bool is_hidden = false;
    std::uint32_t paint = 0;  // index into Drawing::paints
    bool closes = false;      // ends of subpaths are joined, as a fill does
    bool has_start = false;   // of circles, where dashes start
    bool has_dots = false;    // subpaths without a length are dots of the stroke
  };
  void set(const Setting& setting) { setting_ = setting; }

  void path(const std::vector<PathCommand>& commands);
  void ellipse(Vec centre, double rx, double ry);

 private:
  struct Arc;
  void append(decltype(dxf::Entity::shape) shape, std::uint32_t chain);
  void start_at(Vec p);
  void line_to(Vec p);
  void arc_to(Vec radii, double turn, bool is_large, bool is_sweep, Vec end);
  void elliptic(const Arc& arc, bool is_closed);
  void curve(std::vector<Vec> control, std::vector<double> weights);
  void add_vertex(Vec p, double bulge);
  void flush(bool is_closed);
  void finish(bool is_closed);
  dxf::Point at(Vec p) const;

  dxf::Drawing& drawing_;
  std::uint32_t& chains_;
  Setting setting_;
  dxf::Polyline line_;      // lines and circular arcs that are not yet appended
  bool has_curve_ = false;  // of the current subpath
  bool is_drawn_ = false;   // it has a command besides its moveto
  std::uint32_t chain_ = 0;
  Vec start_, at_;
};

/// The box of entities; `has_text` is set where a text among them has none.
Box bounding_box(const std::vector<dxf::Entity>& entities, bool& has_text);

}  // namespace kerf::svg

// Entities of a drawing as outlines in mm.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "kerf/drawing/drawing_outlines.h"
#include "kerf/geom/fit.h"

namespace kerf::outline_front {

/// A shape seen from above, in mm.
struct FlatShape {
  Outline outline;               // empty: there is none
  std::optional<Circle> circle;  // the same, if it is a whole circle
  double low_z = 0.0, high_z = 0.0;
  bool tilted = false;  // not in a plane parallel to XY
};

/// Converts the shapes of one drawing. Errors go to the diagnostics with the entity's origin.
class ShapeConverter {
 public:
  ShapeConverter(const dxf::Drawing& drawing, double mm_per_unit, const DrawingOutlineOptions& options,
                 Diagnostics& diagnostics)
      : drawing_(drawing), scale_(mm_per_unit), options_(options), diagnostics_(diagnostics) {}

  /// Nothing if the entity is not an outline, or after an error.
  std::optional<FlatShape> make(const dxf::Placed& placed);
  /// The loops of a hatch.
  std::vector<FlatShape> make_hatch(const dxf::Placed& placed, const dxf::Hatch& hatch);
  /// The origin of an entity at a position in mm.
  Origin location(const dxf::Placed& placed, Point2 at) const;
  Point2 flat(dxf::Point p) const { return {scale_ * p.x, scale_ * p.y}; }

 private:
  struct Frame;
  std::optional<FlatShape> shape(const dxf::Line& line);
  std::optional<FlatShape> shape(const dxf::Circle& circle);
  std::optional<FlatShape> shape(const dxf::Arc& arc);
  std::optional<FlatShape> shape(const dxf::Boxed<dxf::Polyline>& polyline);
  std::optional<FlatShape> shape(const dxf::Boxed<dxf::Ellipse>& ellipse);
  std::optional<FlatShape> shape(const dxf::Boxed<dxf::Spline>& spline);
  template <class Other>
  std::optional<FlatShape> shape(const Other&) {
    return std::nullopt;
  }
  /// The arc centre + cos(t) * u + sin(t) * v, in world coordinates.
  std::optional<FlatShape> elliptic_arc(dxf::Point centre, dxf::Point u, dxf::Point v, double start,
                                        double sweep);
  bool append_bulge(Outline& outline, const dxf::Matrix& matrix, const dxf::Vertex& from,
                    const dxf::Vertex& to, FlatShape& made);
  std::optional<FlatShape> fitted(const Spline& spline, FlatShape made);
  std::optional<FlatShape> loop_of(const std::vector<FlatShape>& edges) const;
  dxf::Matrix object() const;
  void add_z(FlatShape& made, dxf::Point p) const;
  bool is_near(const Outline& outline);
  bool refuse(Code code, const std::string& what, Point2 at);
  std::string entity_name() const;
  FitOptions fit_options() const;

  const dxf::Drawing& drawing_;
  const double scale_;
  const DrawingOutlineOptions& options_;
  Diagnostics& diagnostics_;
  const dxf::Placed* placed_ = nullptr;
};

/// Of an element of an SVG with this paint.
Origin element_origin(const dxf::Drawing& drawing, std::uint32_t paint);
/// "LINE 2F", or "LINE of line 120" without a handle; "path outer of line 12" in an SVG.
std::string entity_name(const dxf::Drawing& drawing, const dxf::Entity& entity);
/// The circle, if a closed outline of arcs is exactly one circle.
std::optional<Circle> whole_circle(const Outline& outline, double weld);

}  // namespace kerf::outline_front

// Shapes of the plane by name and dimensions, as closed outlines: circles, ovals, triangles, hearts, stars.
//
//   const PlaneShape* lens = plane_shape("lens");
//   const auto outline = make_plane_shape(*lens, {0, 0, 10, 10}, {}, diagnostics);
//
// Frame as in outline.h: mm, y up; counter-clockwise. Angles are degrees, counter-clockwise from +x. Errors
// (op_option) name the shape and the argument.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/outline.h"

namespace kerf {

/// An argument of a shape.
struct ShapeArgument {
  std::string_view name;
  enum class Kind : std::uint8_t { any, size } kind = Kind::any;  ///< a size is above 0
  std::optional<double> fallback{};                               ///< nothing: required
};

struct PlaneShape {
  std::string_view name, meaning;
  std::vector<ShapeArgument> arguments;
  Outline (*make)(const double* values) = nullptr;
  /// What is wrong with values that are all allowed alone; empty: nothing.
  std::string (*problem)(const double* values) = nullptr;
};

/// All shapes, by name.
const std::vector<PlaneShape>& plane_shapes();
/// nullptr if there is none of this name.
const PlaneShape* plane_shape(std::string_view name);
/// The outline; missing values at the end are the fallbacks. Nothing, with errors, if a value is missing or
/// wrong.
std::optional<Outline> make_plane_shape(const PlaneShape& shape, const std::vector<double>& values,
                                        const Origin& where, Diagnostics& diagnostics);

/// The area below a Bezier surface of degree 3 in both directions over a rectangle: its height above a point.
/// `heights` are those of the four rows of four control points, evenly spaced, from the lower left corner
/// along X. Points outside have the height of the nearest point of the edge.
struct BezierSurface {
  Point2 corner;
  double width = 0.0, height = 0.0;
  double heights[4][4] = {};
  double at(Point2 p) const;
};

}  // namespace kerf

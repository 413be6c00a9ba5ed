// Operations on the shapes of a program: areas, and solids as stacks of slabs. Those that have no such form
// are errors that name what is possible.
#pragma once

#include <array>
#include <functional>

#include "front/scad/run/interpreter.h"

namespace kerf::scad {

/// The rows of an affine transform of points: the linear part and the offset.
using Matrix = std::array<std::array<double, 4>, 3>;
Matrix identity();
Matrix product(const Matrix& a, const Matrix& b);

enum class Operation : std::uint8_t { unite, subtract, intersect };
/// Of areas with areas and solids with solids; another kind is an error.
Shape combined(Interpreter& run, const Shape& a, const Shape& b, Operation what, Position at);
/// Transformed. A solid whose sides are not vertical then becomes a body.
Shape transformed(Interpreter& run, Shape shape, const Matrix& matrix, Position at);
/// The solid over an area from a height to a higher one.
Shape extruded(Region region, double low, double high);
/// The solid between copies of an area, each of its points moved as `point_at` says by a parameter from 0 to
/// 1 in `steps` steps. Closed: the last copy is the first one.
struct Sweep {
  int steps = 1;
  bool closed = false;
  std::function<Point3(Point2, double)> point_at;
};
/// Makes the slabs of a solid bodies, too.
void append_bodies(Interpreter& run, Shape& shape, Position at);
Shape swept(Interpreter& run, const Region& region, const Sweep& sweep, Position at);
/// A solid of triangles, turned outwards if they are inside out.
Shape body_shape(SolidBody body);
Box3 bounds_of(const Shape& shape);
/// The area below and above a solid.
Shape shadow_of(Interpreter& run, const Shape& solid, Position at);
Shape area_shape(Region region);
RegionOptions region_options(Interpreter& run, Position at);
/// The area inside polygons, holes by the even-odd rule.
Shape polygons(Interpreter& run, const std::vector<std::vector<Point2>>& paths, Position at);

}  // namespace kerf::scad

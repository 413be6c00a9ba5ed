// Operations on the shapes of a program: areas, and solids as stacks of slabs. Those that have no such form
// are errors that name what is possible.
#pragma once

#include <array>

#include "front/scad/run/interpreter.h"

namespace kerf::scad {

/// The rows of an affine transform of points: the linear part and the offset.
using Matrix = std::array<std::array<double, 4>, 3>;
Matrix identity();
Matrix product(const Matrix& a, const Matrix& b);

enum class Operation : std::uint8_t { unite, subtract, intersect };
/// Of areas with areas and solids with solids; another kind is an error.
Shape combined(Interpreter& run, const Shape& a, const Shape& b, Operation what, Position at);
/// Transformed, if the result has vertical sides.
Shape transformed(Interpreter& run, Shape shape, const Matrix& matrix, Position at);
/// The solid over an area from a height to a higher one.
Shape extruded(Region region, double low, double high);
Shape area_shape(Region region);
RegionOptions region_options(Interpreter& run, Position at);
/// The area inside polygons, holes by the even-odd rule.
Shape polygons(Interpreter& run, const std::vector<std::vector<Point2>>& paths, Position at);

}  // namespace kerf::scad

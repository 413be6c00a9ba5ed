// Outlines as values of a program, and as arguments of commands.
//
// An outline is a vector: the first element is a point [x, y], each further one a straight segment to [x, y]
// or an arc [via x, via y, x, y]. Three numbers [x, y, radius] are a circle.
#pragma once

#include <vector>

#include "front/scad/commands/machine_state.h"
#include "op/mesh/surface_rows.h"

namespace kerf::scad {

/// Closed unless the last point is another than the first.
Value value_of(const Outline& outline);
/// A vector of outlines.
Value value_of(const std::vector<Outline>& outlines);
/// The outline in a value; CommandError, with the name of the argument, if it is none.
Outline outline_of(const Value& value, std::string_view name);
/// The closed outlines of a command: those of argument `i`, which is an outline or a vector of them, or, if
/// it is undef, of the children of the call.
std::vector<Outline> outlines_given(Call& call, std::size_t i);
/// A row of numbers or of points.
std::vector<double> numbers_of(const Value& value, std::string_view name);
std::vector<Point2> points_of(const Value& value, std::string_view name);

/// The value of bezier_surface().
class SurfaceObject final : public Object {
 public:
  explicit SurfaceObject(HeightFunction f) : height(std::move(f)) {}
  std::string text() const override { return "bezier_surface()"; }
  const HeightFunction height;
};

}  // namespace kerf::scad

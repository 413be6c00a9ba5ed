// Outlines as arguments of commands.
//
// An outline is a list: the first element is a point [x, y], each further one a straight segment to [x, y]
// or an arc [via x, via y, x, y]. Three numbers [x, y, radius] are a circle.
#pragma once

#include <vector>

#include "design/machine/machine.h"
namespace kerf::design {

/// The outline in a value; Refusal, with the name of the argument, if it is none.
Outline outline_of(const Value& value, std::string_view name);
/// The closed outlines of a command: those of argument `i`, which is an outline or a list of them, or, if
/// it is undef, of the children of the call.
std::vector<Outline> outlines_given(Call& call, std::size_t i);
/// A row of numbers or of points.
std::vector<double> numbers_of(const Value& value, std::string_view name);
std::vector<Point2> points_of(const Value& value, std::string_view name);

}  // namespace kerf::design

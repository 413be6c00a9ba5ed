// The order in which OpenSCAD evaluates the arguments of a call: echo() and special variables show it.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "front/scad/text/syntax.h"

namespace kerf::scad {

/// OpenSCAD 2021.01 keeps the arguments of a call in a hash table of libstdc++ by the names of their
/// parameters, and evaluates them in the order of that table: from the last to the first, except for names
/// in the same bucket. The indices of `names`, which are all different, in that order.
std::vector<std::size_t> table_order(const std::vector<std::string_view>& names);

/// The arguments that a call evaluates, in the order of their evaluation. Those without a name are for the
/// first `positional` parameters; further ones are not evaluated.
std::vector<Taken> taken_of(const std::vector<std::string_view>& parameters, std::size_t positional,
                            const std::vector<Argument>& arguments);
std::vector<Taken> taken_of(const std::vector<Parameter>& parameters, const std::vector<Argument>& arguments);
/// Without those that only calls name.
std::size_t declared_count(const std::vector<Parameter>& parameters);

}  // namespace kerf::scad

// From the syntax tree to instructions: assigns slots, folds constants.
#pragma once

#include <string_view>
#include <unordered_set>
#include <vector>

#include "front/gcmc/code/code.h"
#include "front/gcmc/text/ast.h"
#include "front/gcmc/value/value.h"

namespace kerf::gcmc {

/// Index of the built-in function of this name; -1 if there is none.
using BuiltinIndex = int (*)(std::string_view name);

/// Thrown if a function has more than 65535 variables and temporaries.
struct TooManySlots {};

/// `constants`: names of constants that exist before the program starts.
Program compile(const Tree& tree, const std::vector<NameId>& constants, BuiltinIndex builtin_index,
                Meter& meter);

}  // namespace kerf::gcmc

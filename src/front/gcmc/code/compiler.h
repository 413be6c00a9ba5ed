// From the tree to the compact form: slots resolved, constants folded.
#pragma once

#include <string_view>
#include <unordered_set>
#include <vector>

#include "front/gcmc/code/code.h"
#include "front/gcmc/text/ast.h"
#include "front/gcmc/value/value.h"

namespace kerf::gcmc {

/// Index of a built-in function, -1 if there is none of that name.
using BuiltinIndex = int (*)(std::string_view name);

/// Too many variables or temporaries for the numbers of slots (65535).
struct TooManySlots {};

/// `constants` are names that exist, and are constant, before the program begins.
Program compile(const Tree& tree, const std::vector<NameId>& constants, BuiltinIndex builtin_index,
                Meter& meter);

}  // namespace kerf::gcmc

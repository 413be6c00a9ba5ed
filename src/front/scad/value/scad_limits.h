// Limits of OpenSCAD programs; those of memory, statements, includes and syntax are in limits.h.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kerf/base/limits.h"

namespace kerf::limits {

inline constexpr std::uint64_t kMaxScadSteps = 200'000'000;  // calls and passes of loops
inline constexpr std::size_t kMaxScadRange = 10'000'000;     // values of a range in a loop, as OpenSCAD
inline constexpr std::uint32_t kMaxScadTurns =
    1'000'000;  // of for (a; b; c), calls in tail position; as OpenSCAD
inline constexpr std::size_t kMaxScadItems = 20'000'000;              // of one vector
inline constexpr std::size_t kMaxScadString = std::size_t{16} << 20;  // bytes of one string
inline constexpr std::uint32_t kMaxScadNesting = 1'000;               // vectors in vectors
inline constexpr std::size_t kMaxScadStack = std::size_t{4} << 20;    // bytes, for calls that are not last
inline constexpr std::uint64_t kMaxScadOutput = std::uint64_t{256} << 20;  // bytes of echo()

}  // namespace kerf::limits

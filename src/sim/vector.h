// Sixteen numbers at a time, in the compiler's own vector types (GCC and clang; no intrinsics): on every
// processor the same bits, since no operation here may be fused or reordered. A kernel library for one
// processor can take this file's place.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "sim/tile.h"

namespace kerf::sim {

#define KERF_LANES [[gnu::always_inline]] inline

using Vector = float __attribute__((vector_size(64)));
using Mask = std::int32_t __attribute__((vector_size(64)));  // -1 where true
using Ids = std::uint32_t __attribute__((vector_size(64)));

KERF_LANES Vector all(Real v) { return Vector{} + v; }
KERF_LANES Vector load(const Lanes& lanes) {
  Vector v;
  std::memcpy(&v, lanes.v, sizeof v);
  return v;
}
KERF_LANES Vector load(const Real* lanes) {
  Vector v;
  std::memcpy(&v, lanes, sizeof v);
  return v;
}
KERF_LANES void store(Vector v, Lanes& lanes) { std::memcpy(lanes.v, &v, sizeof v); }
KERF_LANES Ids load_ids(const std::uint32_t* ids) {
  Ids v;
  std::memcpy(&v, ids, sizeof v);
  return v;
}
KERF_LANES void store_ids(Ids v, std::uint32_t* ids) { std::memcpy(ids, &v, sizeof v); }

KERF_LANES Vector lower_of(Vector a, Vector b) { return a < b ? a : b; }
KERF_LANES Vector higher_of(Vector a, Vector b) { return a > b ? a : b; }
KERF_LANES Vector clamped(Vector v, Vector low, Vector high) { return lower_of(higher_of(v, low), high); }
KERF_LANES Vector square(Vector v) { return v * v; }
KERF_LANES Vector absolute(Vector v) { return higher_of(v, -v); }
/// Square root; of negative numbers 0.
KERF_LANES Vector root(Vector v) {
  v = higher_of(v, Vector{});
  Vector out;
  for (int i = 0; i < kLanes; ++i) out[i] = std::sqrt(v[i]);
  return out;
}

/// Swaps halves, quarters ... so that four steps bring all lanes together.
template <class V, class Operation>
KERF_LANES auto reduced(V v, const Operation& operation) {
  v = operation(v, __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7));
  v = operation(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11));
  v = operation(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13));
  v = operation(v, __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14));
  return v[0];
}
KERF_LANES Real sum_of(Vector v) {
  return reduced(v, [](Vector a, Vector b) { return a + b; });
}
KERF_LANES Real highest_of(Vector v) {
  return reduced(v, [](Vector a, Vector b) { return higher_of(a, b); });
}
KERF_LANES Real lowest_of(Vector v) {
  return reduced(v, [](Vector a, Vector b) { return lower_of(a, b); });
}
/// One bit a lane.
KERF_LANES int bits_of(Mask m) {
  constexpr Mask kBits = {1,      1 << 1, 1 << 2,  1 << 3,  1 << 4,  1 << 5,  1 << 6,  1 << 7,
                          1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 12, 1 << 13, 1 << 14, 1 << 15};
  return reduced(m & kBits, [](Mask a, Mask b) { return a | b; });
}

}  // namespace kerf::sim

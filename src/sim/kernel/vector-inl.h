// Sixteen numbers at a time on every processor, over Highway: one, two or four registers. Compiled once per
// processor level (see kernels.cpp). No operation here is fused, approximate or reordered, so that all levels
// return the same bits.
#if defined(KERF_SIM_VECTOR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef KERF_SIM_VECTOR_INL_H
#undef KERF_SIM_VECTOR_INL_H
#else
#define KERF_SIM_VECTOR_INL_H
#endif

#include <cstdint>
#include <cstring>
#include <hwy/highway.h>

#include "sim/dexel/tile.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using RealTag = hn::CappedTag<Real, kLanes>;
using IdTag = hn::RebindToUnsigned<RealTag>;
inline constexpr int kWidth = static_cast<int>(hn::MaxLanes(RealTag()));
inline constexpr int kParts = kLanes / kWidth;

struct Vector {
  hn::Vec<RealTag> part[kParts];

  HWY_INLINE Vector() : Vector(0.0f) {}
  HWY_INLINE Vector(Real v) {  // NOLINT: one number is broadcast to sixteen lanes
    for (int p = 0; p < kParts; ++p) part[p] = hn::Set(RealTag(), v);
  }
};
// The constructors are written out: those that the compiler makes are not for the processor level.
struct Mask {
  hn::Mask<RealTag> part[kParts];

  HWY_INLINE Mask() {}
};
/// Step numbers.
struct Ids {
  hn::Vec<IdTag> part[kParts];

  HWY_INLINE Ids() {}
};

HWY_INLINE Vector load(const Real* lanes) {
  Vector v;
  for (int p = 0; p < kParts; ++p) v.part[p] = hn::LoadU(RealTag(), lanes + p * kWidth);
  return v;
}
HWY_INLINE Vector load(const Lanes& lanes) { return load(lanes.v); }
HWY_INLINE void store(Vector v, Lanes& lanes) {
  for (int p = 0; p < kParts; ++p) hn::StoreU(v.part[p], RealTag(), lanes.v + p * kWidth);
}
HWY_INLINE Ids all_ids(std::uint32_t id) {
  Ids v;
  for (int p = 0; p < kParts; ++p) v.part[p] = hn::Set(IdTag(), id);
  return v;
}
HWY_INLINE Ids load_ids(const std::uint32_t* ids) {
  Ids v;
  for (int p = 0; p < kParts; ++p) v.part[p] = hn::LoadU(IdTag(), ids + p * kWidth);
  return v;
}
HWY_INLINE void store_ids(Ids v, std::uint32_t* ids) {
  for (int p = 0; p < kParts; ++p) hn::StoreU(v.part[p], IdTag(), ids + p * kWidth);
}

HWY_INLINE Vector operator+(Vector a, Vector b) {
  for (int p = 0; p < kParts; ++p) a.part[p] = hn::Add(a.part[p], b.part[p]);
  return a;
}
HWY_INLINE Vector operator-(Vector a, Vector b) {
  for (int p = 0; p < kParts; ++p) a.part[p] = hn::Sub(a.part[p], b.part[p]);
  return a;
}
HWY_INLINE Vector operator*(Vector a, Vector b) {
  for (int p = 0; p < kParts; ++p) a.part[p] = hn::Mul(a.part[p], b.part[p]);
  return a;
}
HWY_INLINE Vector operator/(Vector a, Vector b) {
  for (int p = 0; p < kParts; ++p) a.part[p] = hn::Div(a.part[p], b.part[p]);
  return a;
}
HWY_INLINE Vector lower_of(Vector a, Vector b) {
  for (int p = 0; p < kParts; ++p) a.part[p] = hn::Min(a.part[p], b.part[p]);
  return a;
}
HWY_INLINE Vector higher_of(Vector a, Vector b) {
  for (int p = 0; p < kParts; ++p) a.part[p] = hn::Max(a.part[p], b.part[p]);
  return a;
}
HWY_INLINE Vector absolute(Vector v) {
  for (int p = 0; p < kParts; ++p) v.part[p] = hn::Abs(v.part[p]);
  return v;
}
/// Square root; 0 for negative numbers.
HWY_INLINE Vector root(Vector v) {
  for (int p = 0; p < kParts; ++p) v.part[p] = hn::Sqrt(hn::ZeroIfNegative(v.part[p]));
  return v;
}
/// Square root; NaN for negative numbers, for which all comparisons are false.
HWY_INLINE Vector root_or_nan(Vector v) {
  for (int p = 0; p < kParts; ++p) v.part[p] = hn::Sqrt(v.part[p]);
  return v;
}
HWY_INLINE Vector square(Vector v) { return v * v; }
HWY_INLINE Vector clamped(Vector v, Vector low, Vector high) { return lower_of(higher_of(v, low), high); }

HWY_INLINE Mask operator<(Vector a, Vector b) {
  Mask m;
  for (int p = 0; p < kParts; ++p) m.part[p] = hn::Lt(a.part[p], b.part[p]);
  return m;
}
HWY_INLINE Mask operator<=(Vector a, Vector b) {
  Mask m;
  for (int p = 0; p < kParts; ++p) m.part[p] = hn::Le(a.part[p], b.part[p]);
  return m;
}
HWY_INLINE Mask operator==(Vector a, Vector b) {
  Mask m;
  for (int p = 0; p < kParts; ++p) m.part[p] = hn::Eq(a.part[p], b.part[p]);
  return m;
}
HWY_INLINE Mask operator==(Ids a, Ids b) {
  Mask m;
  for (int p = 0; p < kParts; ++p) m.part[p] = hn::RebindMask(RealTag(), hn::Eq(a.part[p], b.part[p]));
  return m;
}
HWY_INLINE Mask operator>(Vector a, Vector b) { return b < a; }
HWY_INLINE Mask operator>=(Vector a, Vector b) { return b <= a; }
HWY_INLINE Mask operator&(Mask a, Mask b) {
  for (int p = 0; p < kParts; ++p) a.part[p] = hn::And(a.part[p], b.part[p]);
  return a;
}
HWY_INLINE Mask operator|(Mask a, Mask b) {
  for (int p = 0; p < kParts; ++p) a.part[p] = hn::Or(a.part[p], b.part[p]);
  return a;
}
HWY_INLINE Mask operator~(Mask a) {
  for (int p = 0; p < kParts; ++p) a.part[p] = hn::Not(a.part[p]);
  return a;
}
HWY_INLINE Mask no_lane() { return Vector() < Vector(); }
HWY_INLINE Mask every_lane() { return Vector() <= Vector(); }

HWY_INLINE Vector select(Mask m, Vector yes, Vector no) {
  for (int p = 0; p < kParts; ++p) no.part[p] = hn::IfThenElse(m.part[p], yes.part[p], no.part[p]);
  return no;
}
HWY_INLINE Ids select(Mask m, Ids yes, Ids no) {
  for (int p = 0; p < kParts; ++p)
    no.part[p] = hn::IfThenElse(hn::RebindMask(IdTag(), m.part[p]), yes.part[p], no.part[p]);
  return no;
}
HWY_INLINE Ids one_less(Ids a) {
  for (int p = 0; p < kParts; ++p) a.part[p] = hn::Sub(a.part[p], hn::Set(IdTag(), 1));
  return a;
}
/// The values where the mask is true, else 0.
HWY_INLINE Vector only(Mask m, Vector v) {
  for (int p = 0; p < kParts; ++p) v.part[p] = hn::IfThenElseZero(m.part[p], v.part[p]);
  return v;
}

/// Stores one number where the mask is true. Masked stores are fast only where masks are registers of their
/// own.
HWY_INLINE void store_where(Mask m, std::uint32_t id, std::uint32_t* ids) {
#if HWY_TARGET <= HWY_AVX3
  for (int p = 0; p < kParts; ++p)
    hn::BlendedStore(hn::Set(IdTag(), id), hn::RebindMask(IdTag(), m.part[p]), IdTag(), ids + p * kWidth);
#else
  store_ids(select(m, all_ids(id), load_ids(ids)), ids);
#endif
}

HWY_INLINE bool any(Mask m) {
  for (int p = 1; p < kParts; ++p) m.part[0] = hn::Or(m.part[0], m.part[p]);
  return !hn::AllFalse(RealTag(), m.part[0]);
}
/// One bit per lane.
HWY_INLINE unsigned bits_of(Mask m) {
  unsigned bits = 0;
  for (int p = 0; p < kParts; ++p) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(RealTag(), m.part[p], bytes);
    bits |= (bytes[0] + (kWidth > 8 ? 256u * bytes[1] : 0u)) << (p * kWidth);
  }
  return bits;
}
/// The lanes of sixteen words in which a bit is set.
HWY_INLINE unsigned lanes_with(const std::uint32_t* words, unsigned bit) {
  Mask m;
  const auto wanted = hn::Set(IdTag(), bit);
  for (int p = 0; p < kParts; ++p) {
    const auto found = hn::And(hn::LoadU(IdTag(), words + p * kWidth), wanted);
    m.part[p] = hn::RebindMask(RealTag(), hn::Eq(found, wanted));
  }
  return bits_of(m);
}

struct SumUp {
  template <class V>
  HWY_INLINE V operator()(V a, V b) const {
    return hn::Add(a, b);
  }
};
struct Highest {
  template <class V>
  HWY_INLINE V operator()(V a, V b) const {
    return hn::Max(a, b);
  }
};
struct Lowest {
  template <class V>
  HWY_INLINE V operator()(V a, V b) const {
    return hn::Min(a, b);
  }
};
#if HWY_TARGET == HWY_SCALAR
template <class D, class Operation>
HWY_INLINE hn::TFromD<D> reduced_part(D /*d*/, hn::Vec<D> v, const Operation& /*operation*/) {
  return hn::GetLane(v);
}
#else
template <class D, class Operation>
HWY_INLINE hn::TFromD<D> reduced_part(D /*d*/, hn::Vec<D> v, const Operation& operation) {
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    return reduced_part(half, operation(hn::LowerHalf(half, v), hn::UpperHalf(half, v)), operation);
  } else {
    v = operation(v, hn::Shuffle1032(v));
    v = operation(v, hn::Shuffle2301(v));
    return hn::GetLane(v);
  }
}
#endif
/// Reduces all lanes, halves first: in the same order for any width.
template <class Tag, class Sixteen, class Operation>
HWY_INLINE hn::TFromD<Tag> reduced(Sixteen v, const Operation& operation) {
  for (int n = kParts / 2; n > 0; n /= 2)
    for (int p = 0; p < n; ++p) v.part[p] = operation(v.part[p], v.part[p + n]);
  return reduced_part(Tag(), v.part[0], operation);
}
HWY_INLINE Real sum_of(Vector v) { return reduced<RealTag>(v, SumUp()); }
HWY_INLINE Real highest_of(Vector v) { return reduced<RealTag>(v, Highest()); }
HWY_INLINE Real lowest_of(Vector v) { return reduced<RealTag>(v, Lowest()); }

}  // namespace kerf::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

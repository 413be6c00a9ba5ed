// The operators on values. The inline functions compute the plain cases, scalars whose units need no
// conversion; the others implement all rules of the language, with their warnings and errors.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "front/gcmc/code/code.h"
#include "front/gcmc/value/runtime.h"
#include "front/gcmc/value/value.h"

namespace kerf::gcmc {

constexpr std::int32_t wrap_add(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
constexpr std::int32_t wrap_sub(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}
constexpr std::int32_t wrap_mul(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) * static_cast<std::uint32_t>(b));
}

/// Properties of a pair of numbers: the tag of their sum, and flags. In a table by both tags, because
/// computing them would take longer than the operation.
using Pairing = std::uint16_t;
enum : Pairing {
  kResultTag = 0x1F,
  kLeftInteger = 0x20,
  kRightInteger = 0x40,
  kBothIntegers = kLeftInteger | kRightInteger,
  kPlain = 0x80,        // both are defined, and their units are equal or one has none
  kComparable = 0x100,  // both are defined, and their units are equal
};
constexpr std::size_t kTags = 32;
constexpr Pairing pairing_of(Tag a, Tag b) {
  const Unit ua = unit_of(a), ub = unit_of(b);
  if (a >= kTags || b >= kTags || kind_of(a) == Kind::undef || kind_of(b) == Kind::undef) return 0;
  if (ua != ub && ua != Unit::none && ub != Unit::none) return 0;
  const bool whole_a = kind_of(a) == Kind::integer, whole_b = kind_of(b) == Kind::integer;
  const Tag result = make_tag(whole_a && whole_b ? Kind::integer : Kind::real, ua == Unit::none ? ub : ua);
  return static_cast<Pairing>(result | (whole_a ? +kLeftInteger : 0) | (whole_b ? +kRightInteger : 0) |
                              kPlain | (ua == ub ? +kComparable : 0));
}
/// Index of a pair of tags in the table.
constexpr std::size_t pairing_index(Tag a, Tag b) { return static_cast<std::size_t>(a * kTags + b); }
constexpr std::array<Pairing, kTags * kTags> all_pairings() {
  std::array<Pairing, kTags * kTags> all{};
  for (Tag a = 0; a < kTags; ++a)
    for (Tag b = 0; b < kTags; ++b) all[pairing_index(a, b)] = pairing_of(a, b);
  return all;
}
inline constexpr auto kPairings = all_pairings();
inline Pairing pairing(Scalar a, Scalar b) { return kPairings[pairing_index(a.tag, b.tag)]; }
inline double left_number(Scalar a, Pairing m) {
  return m & kLeftInteger ? static_cast<double>(a.p.i) : a.p.d;
}
inline double right_number(Scalar b, Pairing m) {
  return m & kRightInteger ? static_cast<double>(b.p.i) : b.p.d;
}

/// An operation on plain numbers; false for all others. `whole` and `real` do the work.
template <class Whole, class Real>
inline bool operate_plain(Scalar a, Scalar b, Scalar& out, Whole whole, Real real) {
  const Pairing m = pairing(a, b);
  if (!(m & kPlain)) return false;
  out.tag = m & kResultTag;
  if ((m & kBothIntegers) == kBothIntegers)
    out.p.i = whole(a.whole(), b.whole());
  else
    out.p.d = real(left_number(a, m), right_number(b, m));
  return true;
}
inline bool add_plain(Scalar a, Scalar b, Scalar& out) {
  return operate_plain(a, b, out, wrap_add, [](double x, double y) { return x + y; });
}
inline bool subtract_plain(Scalar a, Scalar b, Scalar& out) {
  return operate_plain(a, b, out, wrap_sub, [](double x, double y) { return x - y; });
}
inline bool multiply_plain(Scalar a, Scalar b, Scalar& out) {
  return operate_plain(a, b, out, wrap_mul, [](double x, double y) { return x * y; });
}

/// Division of plain numbers; also false if the divisor is, or may be, zero.
inline bool divide_plain(Scalar a, Scalar b, Scalar& out) {
  const Pairing m = pairing(a, b);
  if (!(m & kPlain)) return false;
  const Unit unit = m & kComparable ? Unit::none : unit_of(m & kResultTag);
  if ((m & kBothIntegers) == kBothIntegers) {
    if (b.whole() == 0 || b.whole() == -1) return false;
    out = Scalar::integer(a.whole() / b.whole(), unit);
    return true;
  }
  const double divisor = right_number(b, m);
  if (!(divisor >= kEpsilon || divisor <= -kEpsilon)) return false;
  out = Scalar::real(left_number(a, m) / divisor, unit);
  return true;
}
inline bool modulo_plain(Scalar a, Scalar b, Scalar& out) {
  constexpr Pairing kNeeded = kPlain | kBothIntegers;
  const Pairing m = pairing(a, b);
  if ((m & kNeeded) != kNeeded || b.whole() == 0 || b.whole() == -1) return false;
  out.tag = m & kResultTag;
  out.p.i = a.whole() % b.whole();
  return true;
}
/// Whether a comparison holds for numbers with the given difference.
inline bool holds(Op op, double difference) {
  switch (op) {
    case Op::equal: return std::fabs(difference) < kEpsilon;
    case Op::not_equal: return !(std::fabs(difference) < kEpsilon);
    case Op::less: return difference < -kEpsilon;
    case Op::greater: return difference > kEpsilon;
    case Op::less_equal: return difference < kEpsilon;
    default: return difference > -kEpsilon;
  }
}
inline bool holds(Op op, std::int32_t a, std::int32_t b) {
  switch (op) {
    case Op::equal: return a == b;
    case Op::not_equal: return a != b;
    case Op::less: return a < b;
    case Op::greater: return a > b;
    case Op::less_equal: return a <= b;
    default: return a >= b;
  }
}

/// Adds or subtracts 1; false if `s` is not a number.
inline bool step_plain(Scalar s, bool down, Scalar& out) {
  if (s.kind() == Kind::integer)
    out = Scalar::integer(wrap_add(s.whole(), down ? -1 : 1), s.unit());
  else if (s.kind() == Kind::real)
    out = Scalar::real(s.p.d + (down ? -1 : 1), s.unit());
  else
    return false;
  return true;
}

/// a op b of scalars, with all rules for units and undef.
Scalar scalar_operation(Runtime& rt, Op op, Scalar a, Scalar b);
/// a = a op b of any values; `b` must not be an element of `a`. Changes blocks of a single owner in place.
void operate(Runtime& rt, Op op, Value& a, const Value& b);
/// list = list + {item}, with a check of both types.
void append_vector(Runtime& rt, Value& list, Value item);
/// a op b into `out`, which may be one of them, for two short vectors, or a vector and a scalar, of plain
/// numbers; false, with nothing changed, for all others.
bool vectors_plain(Op op, const Value& a, const Value& b, Value& out);
/// Whether the comparison a op b is true.
bool compare(Runtime& rt, Op op, const Value& a, const Value& b);
bool truth(const Value& v);
Value bit_not(Runtime& rt, const Value& v);
/// v[i]; out of range warns and yields undef or an empty vector.
Value element(Runtime& rt, const Value& v, const Value& index);
/// The same into `out`; false, with a warning, if the index is out of range.
bool find_element(Runtime& rt, const Value& v, const Value& index, Value& out);
/// target[i] = item, or target[i][j] = item; grows the target.
void set_element(Runtime& rt, Value& target, const Value& first, const Value* second, const Value& item);
/// Conversion to an integer: reals are truncated, unless within 1e-12 of an integer.
std::int32_t to_integer(Scalar s);
/// Adds 1 or -1; a warning if `v` is not a number.
void step_value(Runtime& rt, Value& v, bool down);

}  // namespace kerf::gcmc

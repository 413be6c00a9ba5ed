// The operators on values. The inline part decides the plain cases, scalars whose units need no conversion;
// the rest says what the language says, warnings and errors included.
#pragma once

#include <cstdint>
#include <limits>

#include "front/gcmc/code.h"
#include "front/gcmc/runtime.h"
#include "front/gcmc/value.h"

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

/// True where two numbers are defined and their units are equal or one has none: `unit` is then the result's.
inline bool plain(Tag a, Tag b, Unit& unit) {
  const Tag ua = a >> 2, ub = b >> 2;
  unit = static_cast<Unit>(ua | ub);
  return (a & 3) != 0 && (b & 3) != 0 && (ua == ub || ua == 0 || ub == 0);
}
inline bool both_integers(Tag a, Tag b) { return ((a | b) & 2) == 0; }
static_assert(static_cast<int>(Kind::integer) == 1 && static_cast<int>(Kind::real) == 2);
inline double number_of(Payload p, Tag tag) { return (tag & 3) == 1 ? static_cast<double>(p.i) : p.d; }

inline bool add_plain(Scalar a, Scalar b, Scalar& out) {
  Unit unit;
  if (!plain(a.tag, b.tag, unit)) return false;
  if (both_integers(a.tag, b.tag)) {
    out.p.i = wrap_add(a.whole(), b.whole());
    out.tag = make_tag(Kind::integer, unit);
  } else {
    out.p.d = a.number() + b.number();
    out.tag = make_tag(Kind::real, unit);
  }
  return true;
}
inline bool subtract_plain(Scalar a, Scalar b, Scalar& out) {
  Unit unit;
  if (!plain(a.tag, b.tag, unit)) return false;
  if (both_integers(a.tag, b.tag)) {
    out.p.i = wrap_sub(a.whole(), b.whole());
    out.tag = make_tag(Kind::integer, unit);
  } else {
    out.p.d = a.number() - b.number();
    out.tag = make_tag(Kind::real, unit);
  }
  return true;
}
inline bool multiply_plain(Scalar a, Scalar b, Scalar& out) {
  Unit unit;
  if (!plain(a.tag, b.tag, unit)) return false;
  if (both_integers(a.tag, b.tag)) {
    out.p.i = wrap_mul(a.whole(), b.whole());
    out.tag = make_tag(Kind::integer, unit);
  } else {
    out.p.d = a.number() * b.number();
    out.tag = make_tag(Kind::real, unit);
  }
  return true;
}

/// Division of plain numbers; false as well where the divisor is, or may be, zero.
inline bool divide_plain(Scalar a, Scalar b, Scalar& out) {
  Unit unit;
  if (!plain(a.tag, b.tag, unit)) return false;
  if (a.unit() == b.unit()) unit = Unit::none;
  if (both_integers(a.tag, b.tag)) {
    if (b.whole() == 0 || b.whole() == -1) return false;
    out = Scalar::integer(a.whole() / b.whole(), unit);
    return true;
  }
  const double divisor = b.number();
  if (!(divisor >= kEpsilon || divisor <= -kEpsilon)) return false;
  out = Scalar::real(a.number() / divisor, unit);
  return true;
}
inline bool modulo_plain(Scalar a, Scalar b, Scalar& out) {
  Unit unit;
  if (!plain(a.tag, b.tag, unit) || !both_integers(a.tag, b.tag) || b.whole() == 0 || b.whole() == -1)
    return false;
  out = Scalar::integer(a.whole() % b.whole(), unit);
  return true;
}
/// One more or one less; false for what is no number.
inline bool step_plain(Scalar s, bool down, Scalar& out) {
  if (s.kind() == Kind::integer)
    out = Scalar::integer(wrap_add(s.whole(), down ? -1 : 1), s.unit());
  else if (s.kind() == Kind::real)
    out = Scalar::real(s.p.d + (down ? -1 : 1), s.unit());
  else
    return false;
  return true;
}

/// a op b of scalars, with all of the language's rules on units and undef.
Scalar scalar_operation(Runtime& rt, Op op, Scalar a, Scalar b);
/// a = a op b of any values; `b` is not part of `a`. What only `a` owns is changed in place.
void operate(Runtime& rt, Op op, Value& a, const Value& b);
/// a op b into `out`, which may be one of them, where both are short vectors, or a vector and a scalar, of
/// plain numbers; false, with nothing changed, for everything else.
bool vectors_plain(Op op, const Value& a, const Value& b, Value& out);
/// Whether a op b holds, op being a comparison.
bool compare(Runtime& rt, Op op, const Value& a, const Value& b);
bool truth(const Value& v);
Value bit_not(Runtime& rt, const Value& v);
/// v[i]; out of range warns and yields undef or an empty vector.
Value element(Runtime& rt, const Value& v, const Value& index);
/// The same with a place in the range; false (and a warning) where there is none.
bool find_element(Runtime& rt, const Value& v, const Value& index, Value& out);
/// target[i] = item, or target[i][j] = item; grows the target.
void set_element(Runtime& rt, Value& target, const Value& first, const Value* second, const Value& item);
/// An integer where the language wants one: reals are cut off, unless within 1e-12 of an integer.
std::int32_t to_integer(Scalar s);
/// Adds 1 or -1; warns for what is no number.
void step_value(Runtime& rt, Value& v, bool down);

}  // namespace kerf::gcmc

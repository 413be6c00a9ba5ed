// The operators of the language on all types of values.
#include "front/gcmc/code/operators.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/codes/gcmc.h"

namespace kerf::gcmc {
namespace {

constexpr std::size_t kMaxGrowth = 50'000'000;  // entries that an index or shift may add at once

std::string_view symbol(Op op) {
  switch (op) {
    case Op::add: return "+";
    case Op::sub: return "-";
    case Op::mul: return "*";
    case Op::div: return "/";
    case Op::mod: return "%";
    case Op::add_or: return "+|";
    case Op::sub_or: return "-|";
    case Op::bit_and: return "&";
    case Op::bit_or: return "|";
    case Op::bit_xor: return "^";
    case Op::shift_left: return "<<";
    default: return ">>";
  }
}

std::string types(const Value& a, const Value& b) {
  return fmt::format("(lv={}, rv={})", type_name(a), type_name(b));
}

[[noreturn]] void wrong_types(Runtime& rt, Op op, const Value& a, const Value& b) {
  std::string_view rule;
  switch (op) {
    case Op::add:
    case Op::add_or:
      rule = "Scalars and vectors can only be added to scalars vectors and vector lists";
      break;
    case Op::sub:
    case Op::sub_or: rule = "Only scalars/vectors can be subtracted from scalars/vectors"; break;
    case Op::mul: rule = "Scalars and vectors can only be multiplied by scalars and vectors"; break;
    case Op::div: rule = "Scalars, vectors and vectorlists can only be divided by scalars"; break;
    case Op::mod: rule = "Scalars, vectors and vectorlists can only be taken modulo by scalars"; break;
    default:
      rt.fail(codes::gcmc_type,
              fmt::format("Operator '{}' cannot be applied to these types {}", symbol(op), types(a, b)));
  }
  rt.fail(codes::gcmc_type, fmt::format("{} {}", rule, types(a, b)));
}

std::int32_t integer_operation(Runtime& rt, Op op, std::int32_t a, std::int32_t b) {
  switch (op) {
    case Op::add:
    case Op::add_or: return wrap_add(a, b);
    case Op::sub:
    case Op::sub_or: return wrap_sub(a, b);
    case Op::mul: return wrap_mul(a, b);
    case Op::div:
      if (b == 0) rt.fail(codes::gcmc_range, "Divide by zero");
      return b == -1 ? wrap_sub(0, a) : a / b;
    default:
      if (b == 0) rt.fail(codes::gcmc_range, "Modulo by zero");
      return b == -1 ? 0 : a % b;
  }
}

double real_operation(Runtime& rt, Op op, double a, double b) {
  switch (op) {
    case Op::add:
    case Op::add_or: return a + b;
    case Op::sub:
    case Op::sub_or: return a - b;
    case Op::mul: return a * b;
    case Op::div:
      if (std::fabs(b) < kEpsilon)
        rt.fail(codes::gcmc_range, fmt::format("Divide by zero (|val| < {:e})", kEpsilon));
      return a / b;
    default:
      if (std::fabs(b) < kEpsilon) rt.fail(codes::gcmc_range, "Modulo by zero");
      return std::fmod(a, b);
  }
}

/// The unit of a result; `b` is converted if its unit differs but is compatible.
Unit common_unit(Runtime& rt, Op op, Unit ua, Scalar& b) {
  const Unit ub = b.unit();
  if (ua == Unit::none || ub == Unit::none) return ua == Unit::none ? ub : ua;
  if (ua == ub) return op == Op::div ? Unit::none : ua;
  if (is_distance(ua) == is_distance(ub)) {
    b = Scalar::real(convert(b.number(), ub, ua), ua);
  } else {
    const auto kind = [](Unit u) { return is_distance(u) ? "distance" : "angular"; };
    rt.warn(codes::gcmc_unit,
            fmt::format("Operation '{}': LHS has {} units and RHS has {} units, RHS units ignored",
                        symbol(op), kind(ua), kind(ub)),
            fmt::format("{} is used as {}; use to_none() if that is intended", text_of(b),
                        text_of(b.with_unit(ua))));
  }
  return op == Op::div ? Unit::none : ua;
}

Scalar with_undefined(Op op, Scalar a, Scalar b) {
  switch (op) {
    case Op::add:
    case Op::sub: return a;  // undef if a is undef; an undef b is ignored
    case Op::add_or: return a.defined() ? a : b;
    case Op::sub_or:
      if (a.defined() || !b.defined()) return a;
      return b.kind() == Kind::integer ? Scalar::integer(wrap_sub(0, b.whole()), b.unit())
                                       : Scalar::real(0.0 - b.p.d, b.unit());
    default: return {};
  }
}

}  // namespace

std::int32_t to_integer(Scalar s) {
  if (s.kind() != Kind::real) return s.kind() == Kind::integer ? s.whole() : 0;
  const double nearest = std::nearbyint(s.p.d);
  const double whole = std::fabs(nearest - s.p.d) < kEpsilon ? nearest : std::trunc(s.p.d);
  if (!(whole >= -2147483648.0)) return INT32_MIN;
  return whole > 2147483647.0 ? INT32_MAX : static_cast<std::int32_t>(whole);
}

Scalar scalar_operation(Runtime& rt, Op op, Scalar a, Scalar b) {
  if (!a.defined() || !b.defined()) return with_undefined(op, a, b);
  const Unit unit = common_unit(rt, op, a.unit(), b);
  if (a.kind() == Kind::integer && b.kind() == Kind::integer)
    return Scalar::integer(integer_operation(rt, op, a.whole(), b.whole()), unit);
  return Scalar::real(real_operation(rt, op, a.number(), b.number()), unit);
}

namespace {

// ---- addition and subtraction

/// The operation on plain scalars; false if other rules apply.
inline bool plain_operation(Op op, Scalar a, Scalar b, Scalar& out) {
  switch (op) {
    case Op::add:
    case Op::add_or: return add_plain(a, b, out);
    case Op::sub:
    case Op::sub_or: return subtract_plain(a, b, out);
    case Op::mul: return multiply_plain(a, b, out);
    case Op::div: return divide_plain(a, b, out);
    default: return false;
  }
}

inline Scalar coordinate_operation(Runtime& rt, Op op, Scalar a, Scalar b) {
  Scalar out;
  return plain_operation(op, a, b, out) ? out : scalar_operation(rt, op, a, b);
}

/// The coordinates of a op b if there are at most three and all are plain.
template <class First, class Second>
bool plain_coordinates(Op op, std::size_t count, First first, Second second, Value& out) {
  Scalar r[3];
  for (std::size_t i = 0; i < count; ++i)
    if (!plain_operation(op, first(i), second(i), r[i])) return false;
  out.make_vector(count);
  for (std::size_t i = 0; i < count; ++i) out.put(i, r[i]);
  return true;
}

void vector_with_vector(Runtime& rt, Op op, Value& a, const Value& b) {
  const std::size_t count = std::max(a.vector_size(), b.vector_size());
  for (std::size_t i = 0; i < count; ++i)
    a.set_coordinate(i, coordinate_operation(rt, op, a.coordinate_or_undef(i), b.coordinate_or_undef(i)),
                     rt.meter);
}

void vector_with_scalar(Runtime& rt, Op op, Value& a, Scalar b) {
  for (std::size_t i = 0; i < a.vector_size(); ++i)
    a.set_coordinate(i, coordinate_operation(rt, op, a.coordinate(i), b), rt.meter);
}

void scalar_with_vector(Runtime& rt, Op op, Scalar a, Value& b) {
  for (std::size_t i = 0; i < b.vector_size(); ++i)
    b.set_coordinate(i, coordinate_operation(rt, op, a, b.coordinate(i)), rt.meter);
}

template <class Change>
void each_vector(Runtime& rt, Value& list, Change change) {
  for (Value& v : list.own_vectors(rt.meter)) change(v);
}

void append_list(Runtime& rt, Value& a, const Value& b) {
  auto& into = a.own_vectors(rt.meter);
  const auto& from = b.vectors();
  if (into.size() + from.size() > into.capacity())
    into.reserve(std::max(into.size() + from.size(), into.capacity() * 2));
  into.insert(into.end(), from.begin(), from.end());
  a.settle();
}

void append_to_text(Runtime& rt, Op op, Value& a, const Value& b) {
  if (b.is_undef() && op == Op::add) return;
  if (b.is_string()) {
    a.own_text(rt.meter) += b.text();
  } else {
    std::string text;
    append_text(text, b, rt.decimals);
    a.own_text(rt.meter) += from_utf8(text);
  }
  a.settle();
}

void add(Runtime& rt, Op op, Value& a, const Value& b) {
  if (a.is_string()) return append_to_text(rt, op, a, b);
  if (b.is_undef()) return;
  if (a.is_undef()) {
    if (op == Op::add_or) a = b;
    return;
  }
  if (a.is_vector() && b.is_vector()) return vector_with_vector(rt, op, a, b);
  if (a.is_list() && b.is_vector())
    return each_vector(rt, a, [&](Value& v) {
      if (!vectors_plain(op, v, b, v)) vector_with_vector(rt, op, v, b);
    });
  if (a.is_list() && b.is_list()) return append_list(rt, a, b);
  wrong_types(rt, op, a, b);
}

void subtract(Runtime& rt, Op op, Value& a, const Value& b) {
  if (a.is_string()) wrong_types(rt, op, a, b);
  if (b.is_undef()) return;
  if (a.is_undef()) {
    if (op == Op::sub) return;
    a = b;
    const Scalar minus = Scalar::integer(-1);
    if (a.is_vector()) return scalar_with_vector(rt, Op::mul, minus, a);
    if (a.is_list()) return each_vector(rt, a, [&](Value& v) { scalar_with_vector(rt, Op::mul, minus, v); });
    wrong_types(rt, op, a, b);
  }
  if (a.is_vector() && b.is_vector()) return vector_with_vector(rt, op, a, b);
  if (a.is_list() && b.is_vector())
    return each_vector(rt, a, [&](Value& v) {
      if (!vectors_plain(op, v, b, v)) vector_with_vector(rt, op, v, b);
    });
  wrong_types(rt, op, a, b);
}

// ---- multiplication and division

Value dot_product(Runtime& rt, const Value& a, const Value& b) {
  const std::size_t count = std::min(a.vector_size(), b.vector_size());
  bool has_unit = false, has_angle = false;
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    for (const Scalar s : {a.coordinate(i), b.coordinate(i)}) {
      has_unit = has_unit || s.unit() != Unit::none;
      has_angle = has_angle || is_angle(s.unit());
    }
    const auto number = [&](Scalar s) {
      return is_distance(s.unit()) ? convert(s.number(), s.unit(), rt.native) : s.number();
    };
    sum += number(a.coordinate(i)) * number(b.coordinate(i));
  }
  if (has_angle) rt.warn(codes::gcmc_unit, "Vector multiplication (dot-product) with angular units");
  return Value::real(sum, has_unit ? rt.native : Unit::none);
}

void multiply(Runtime& rt, Value& a, const Value& b) {
  const bool undefined = a.is_undef() || b.is_undef();
  if (a.is_scalar() && !undefined && (b.is_vector() || b.is_list())) {
    const Scalar factor = a.scalar();
    a = b;
    if (a.is_vector()) return scalar_with_vector(rt, Op::mul, factor, a);
    return each_vector(rt, a, [&](Value& v) { scalar_with_vector(rt, Op::mul, factor, v); });
  }
  if (b.is_scalar() && !undefined) {
    if (a.is_vector()) return vector_with_scalar(rt, Op::mul, a, b.scalar());
    if (a.is_list())
      return each_vector(rt, a, [&](Value& v) {
        if (!vectors_plain(Op::mul, v, b, v)) vector_with_scalar(rt, Op::mul, v, b.scalar());
      });
  }
  if (a.is_vector() && b.is_vector()) {
    a = dot_product(rt, a, b);
    return;
  }
  wrong_types(rt, Op::mul, a, b);
}

void divide(Runtime& rt, Op op, Value& a, const Value& b) {
  if (b.is_scalar() && !b.is_undef()) {
    if (a.is_vector()) return vector_with_scalar(rt, op, a, b.scalar());
    if (a.is_list())
      return each_vector(rt, a, [&](Value& v) {
        if (!vectors_plain(op, v, b, v)) vector_with_scalar(rt, op, v, b.scalar());
      });
  }
  wrong_types(rt, op, a, b);
}

// ---- bits and shifts

std::int32_t bits_of(Runtime& rt, Op op, std::string_view side, Scalar s) {
  if (s.kind() != Kind::integer)
    rt.warn(codes::gcmc_type,
            fmt::format("Binary '{}' operator, {}, should be integer, converted", symbol(op), side));
  if (s.unit() != Unit::none)
    rt.warn(codes::gcmc_unit,
            fmt::format("Binary '{}' operator, {}, has units associated, ignored", symbol(op), side));
  return to_integer(s);
}

/// `|` sets the coordinates that are undef in a, `&` overwrites those that are defined in both.
void merge_vectors(Runtime& rt, Op op, Value& a, const Value& b) {
  for (std::size_t i = 0; i < b.vector_size(); ++i) {
    const Scalar from = b.coordinate(i);
    const bool has = a.coordinate_or_undef(i).defined();
    if (op == Op::bit_or && (!has || i >= a.vector_size())) a.set_coordinate(i, from, rt.meter);
    if (op == Op::bit_and && has && from.defined()) a.set_coordinate(i, from, rt.meter);
    if (op == Op::bit_and && i >= a.vector_size()) a.set_coordinate(i, Scalar{}, rt.meter);
  }
}

void bits(Runtime& rt, Op op, Value& a, const Value& b) {
  if (a.is_vector() && b.is_vector() && op != Op::bit_xor) return merge_vectors(rt, op, a, b);
  if (!a.is_scalar() || !b.is_scalar()) wrong_types(rt, op, a, b);
  const std::int32_t l = bits_of(rt, op, "left-hand-side", a.scalar());
  const std::int32_t r = bits_of(rt, op, "right-hand-side", b.scalar());
  a = Value::integer(op == Op::bit_and ? l & r : op == Op::bit_or ? l | r : l ^ r);
}

void shift_scalar(Runtime& rt, Op op, Value& a, std::int32_t count) {
  if (count > 31)
    rt.fail(codes::gcmc_range, fmt::format("Operation '{}': Shift count too large", symbol(op)));
  const Scalar s = a.scalar();
  const bool left = op == Op::shift_left;
  if (s.kind() == Kind::real) {
    a = Value::real(std::ldexp(s.p.d, left ? count : -count), s.unit());
  } else if (s.kind() == Kind::integer) {
    const auto shifted = static_cast<std::int32_t>(static_cast<std::uint32_t>(s.whole()) << count);
    a = Value::integer(left ? shifted : s.whole() >> count, s.unit());
  }
}

template <class Item>
void shift_items(std::vector<Item>& items, bool left, std::size_t count, const Item& filler) {
  if (left)
    items.erase(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(std::min(count, items.size())));
  else
    items.insert(items.begin(), count, filler);
}

void shift(Runtime& rt, Op op, Value& a, const Value& b) {
  if (!b.is_scalar()) wrong_types(rt, op, a, b);
  if (b.is_undef() || a.is_undef()) return;
  if (b.scalar().unit() != Unit::none)
    rt.warn(codes::gcmc_unit,
            fmt::format("Operation '{}': Shift count has units associated, ignored", symbol(op)));
  const std::int32_t count = to_integer(b.scalar());
  if (count < 0)
    rt.fail(codes::gcmc_range, fmt::format("Operation '{}': Shift count is negative", symbol(op)));
  if (static_cast<std::size_t>(count) > kMaxGrowth)
    rt.fail(codes::gcmc_limit, fmt::format("Operation '{}': Shift count too large", symbol(op)));
  const bool left = op == Op::shift_left;
  const auto entries = static_cast<std::size_t>(count);
  if (a.is_scalar()) return shift_scalar(rt, op, a, count);
  if (a.is_vector()) {
    std::vector<Scalar> all = a.coordinates();
    shift_items(all, left, entries, Scalar{});
    a = Value::vector(all.data(), all.size(), rt.meter);
  } else if (a.is_list()) {
    if (!left) rt.meter.grow(entries * sizeof(Value)), rt.meter.shrink(entries * sizeof(Value));
    shift_items(a.own_vectors(rt.meter), left, entries, Value::empty_vector());
    a.settle();
  } else {
    wrong_types(rt, op, a, b);
  }
}

}  // namespace

namespace {

/// Real vectors of one shape, or such a vector and a real number without unit: the most frequent case.
bool reals_plain(Op op, const Value& a, const Value& b, Value& out) {
  double r[3] = {};
  const std::size_t count = a.short_size();
  if (b.is_scalar()) {
    if (b.tag() != make_tag(Kind::real, Unit::none)) return false;
    const double s = b.payload().d;
    if (op == Op::mul) {
      for (std::size_t i = 0; i < count; ++i) r[i] = a.real_coordinate(i) * s;
    } else if (op == Op::div && std::fabs(s) >= kEpsilon) {
      for (std::size_t i = 0; i < count; ++i) r[i] = a.real_coordinate(i) / s;
    } else {
      return false;
    }
  } else if (!a.same_shape(b)) {
    return false;
  } else if (op == Op::add) {
    for (std::size_t i = 0; i < count; ++i) r[i] = a.real_coordinate(i) + b.real_coordinate(i);
  } else if (op == Op::sub) {
    for (std::size_t i = 0; i < count; ++i) r[i] = a.real_coordinate(i) - b.real_coordinate(i);
  } else {
    return false;
  }
  out.store_reals(a, r);
  return true;
}

}  // namespace

bool vectors_plain(Op op, const Value& a, const Value& b, Value& out) {
  if (a.is_real_vector() && reals_plain(op, a, b, out)) return true;
  const auto of_a = [&](std::size_t i) { return a.short_coordinate(i); };
  const auto of_b = [&](std::size_t i) { return b.short_coordinate(i); };
  if (a.is_short_vector()) {
    if (b.is_scalar() && (op == Op::mul || op == Op::div)) {
      const Scalar s = b.scalar();
      return plain_coordinates(
          op, a.short_size(), of_a, [&](std::size_t) { return s; }, out);
    }
    if (!b.is_short_vector() || (op != Op::add && op != Op::sub) || a.short_size() != b.short_size())
      return false;
    return plain_coordinates(op, a.short_size(), of_a, of_b, out);
  }
  if (!a.is_scalar() || !b.is_short_vector() || op != Op::mul) return false;
  const Scalar s = a.scalar();
  return plain_coordinates(
      op, b.short_size(), [&](std::size_t) { return s; }, of_b, out);
}

void append_vector(Runtime& rt, Value& list, Value item) {
  if (!list.is_list()) {
    std::vector<Value> one;
    one.push_back(std::move(item));
    return operate(rt, Op::add, list, Value::list(std::move(one), rt.meter));
  }
  list.own_vectors(rt.meter).push_back(std::move(item));
  list.settle();
}

void operate(Runtime& rt, Op op, Value& a, const Value& b) {
  const bool shifts = op == Op::shift_left || op == Op::shift_right;
  const bool bitwise = op == Op::bit_and || op == Op::bit_or || op == Op::bit_xor;
  if (a.is_scalar() && b.is_scalar() && !shifts && !bitwise) {
    a = Value(scalar_operation(rt, op, a.scalar(), b.scalar()));
    return;
  }
  switch (op) {
    case Op::add:
    case Op::add_or: return add(rt, op, a, b);
    case Op::sub:
    case Op::sub_or: return subtract(rt, op, a, b);
    case Op::mul: return multiply(rt, a, b);
    case Op::div:
    case Op::mod: return divide(rt, op, a, b);
    case Op::shift_left:
    case Op::shift_right: return shift(rt, op, a, b);
    default: return bits(rt, op, a, b);
  }
}

// ---- comparisons

namespace {

bool compare_scalars(Runtime& rt, Op op, Scalar a, Scalar b) {
  const Unit ua = a.unit(), ub = b.unit();
  if (a.kind() == Kind::integer && b.kind() == Kind::integer && ua == ub)
    return holds(op, a.whole(), b.whole());
  if (ua == ub) return holds(op, a.number() - b.number());
  if (ua == Unit::none || ub == Unit::none) {
    const Scalar plain = ua == Unit::none ? a : b;
    const Unit other = ua == Unit::none ? ub : ua;
    rt.warn(codes::gcmc_unit,
            fmt::format("Possible unit mismatch; comparing units {} with none", unit_name(other)),
            fmt::format("{} is compared as {}; write the unit", text_of(plain),
                        text_of(plain.with_unit(is_angle(other) ? Unit::deg : rt.native))));
  } else if (is_distance(ua) != is_distance(ub)) {
    rt.warn(codes::gcmc_unit,
            fmt::format("Unit mismatch in comparison, converted to <none> (LHS={}, RHS={})", unit_name(ua),
                        unit_name(ub)),
            "a length and an angle are compared by their numbers only");
    return holds(op, a.number() - b.number());
  }
  return holds(op, native_number(rt, a) - native_number(rt, b));
}

bool compare_vectors(Runtime& rt, Op op, const Value& a, const Value& b) {
  if (op != Op::equal && op != Op::not_equal) {
    rt.warn(codes::gcmc_type, "Vectors can only be compared for equality, result is always false");
    return false;
  }
  if (a.vector_size() != b.vector_size()) {
    rt.warn(codes::gcmc_type, "Comparison of vectors with unequal nr. of entries is always false");
    return false;
  }
  bool same = true;
  for (std::size_t i = 0; same && i < a.vector_size(); ++i) {
    const Scalar x = a.coordinate(i), y = b.coordinate(i);
    if (x.defined() && y.defined())
      same = compare_scalars(rt, Op::equal, x, y);
    else
      same = x.defined() == y.defined();
  }
  return same == (op == Op::equal);
}

}  // namespace

bool compare(Runtime& rt, Op op, const Value& a, const Value& b) {
  if (a.is_scalar() && b.is_scalar() && !a.is_undef() && !b.is_undef())
    return compare_scalars(rt, op, a.scalar(), b.scalar());
  if (a.is_string() && b.is_string()) return holds(op, a.text().compare(b.text()), 0);
  if (a.is_vector() && b.is_vector()) return compare_vectors(rt, op, a, b);
  rt.warn(codes::gcmc_type,
          fmt::format("Comparison of {} with {}, result is always false", type_name(a), type_name(b)));
  return false;
}

bool truth(const Value& v) {
  switch (v.type()) {
    case Type::scalar: {
      const Scalar s = v.scalar();
      return s.kind() == Kind::integer ? s.whole() != 0
                                       : s.kind() == Kind::real && !(std::fabs(s.p.d) < kEpsilon);
    }
    case Type::vector:
    case Type::long_vector: return v.vector_size() != 0;
    case Type::list: return !v.vectors().empty();
    case Type::string: return !v.text().empty();
    default: return false;
  }
}

Value bit_not(Runtime& rt, const Value& v) {
  if (!v.is_scalar())
    rt.fail(codes::gcmc_type, fmt::format("Binary not target must be scalar ({})", type_name(v)));
  const Scalar s = v.scalar();
  if (s.kind() != Kind::integer) rt.warn(codes::gcmc_type, "Binary not target should be integer, converted");
  if (s.unit() != Unit::none) rt.warn(codes::gcmc_unit, "Binary not target has units associated, ignored");
  return Value::integer(~to_integer(s));
}

// ---- elements

namespace {

std::size_t count_of(Runtime& rt, const Value& v) {
  if (v.is_vector()) return v.vector_size();
  if (v.is_list()) return v.vectors().size();
  if (v.is_string()) return v.text().size();
  rt.fail(codes::gcmc_type,
          fmt::format("Only vectors, vectorlists and strings can be indexed ({})", type_name(v)));
}

std::int64_t index_number(Runtime& rt, const Value& index) {
  if (!index.is_scalar() || index.is_undef()) rt.fail(codes::gcmc_type, "Index of [] operator is not scalar");
  if (index.scalar().unit() != Unit::none)
    rt.warn(codes::gcmc_unit, "Index of [] operator has units associated, ignored");
  return to_integer(index.scalar());
}

void out_of_range(Runtime& rt, std::int64_t i, std::size_t count) {
  if (count == 0)
    rt.warn(codes::gcmc_range, "Vector index out of range (vector has no entries)");
  else
    rt.warn(codes::gcmc_range,
            fmt::format("Vector index out of range ({} outside [-{}..{}])", i, count, count - 1));
}

Value item_at(Runtime& rt, const Value& v, std::size_t i) {
  if (v.is_vector()) return Value(v.coordinate(i));
  if (v.is_list()) return v.vectors()[i];
  return Value::string(std::u32string(1, v.text()[i]), rt.meter);
}

/// The index to write to. A negative index counts from the end; below -count the value grows to -index
/// entries.
std::size_t writable_index(Runtime& rt, const Value& target, const Value& index) {
  const std::int64_t i = index_number(rt, index);
  const auto count = static_cast<std::int64_t>(count_of(rt, target));
  const std::int64_t position = i >= 0 ? i : i + count >= 0 ? i + count : 0;
  const std::int64_t needed = i >= 0 ? i + 1 : -i;
  if (needed > static_cast<std::int64_t>(kMaxGrowth))
    rt.fail(codes::gcmc_limit, fmt::format("Index {} is too large", i));
  return static_cast<std::size_t>(position);
}

std::size_t size_after(const Value& index, std::size_t count) {
  const std::int64_t i = to_integer(index.scalar());
  return std::max<std::size_t>(count, static_cast<std::size_t>(i >= 0 ? i + 1 : -i));
}

void set_coordinate(Runtime& rt, Value& v, const Value& index, const Value& item) {
  const std::size_t i = writable_index(rt, v, index);
  if (!item.is_scalar())
    rt.fail(codes::gcmc_type, fmt::format("Vector entries must be scalar ({})", type_name(item)));
  const std::size_t size = size_after(index, v.vector_size());
  if (size * sizeof(Scalar) > rt.meter.limit - rt.meter.used) throw OutOfMemory{};
  if (size > v.vector_size()) v.set_coordinate(size - 1, Scalar{}, rt.meter);
  v.set_coordinate(i, item.scalar(), rt.meter);
}

}  // namespace

bool find_element(Runtime& rt, const Value& v, const Value& index, Value& out) {
  const std::size_t count = count_of(rt, v);
  const std::int64_t i = index_number(rt, index);
  const std::int64_t position = i < 0 ? i + static_cast<std::int64_t>(count) : i;
  if (position < 0 || position >= static_cast<std::int64_t>(count)) {
    out_of_range(rt, i, count);
    return false;
  }
  out = item_at(rt, v, static_cast<std::size_t>(position));
  return true;
}

Value element(Runtime& rt, const Value& v, const Value& index) {
  Value out;
  if (find_element(rt, v, index, out)) return out;
  return v.is_list() ? Value::empty_vector() : Value::undef();
}

void set_element(Runtime& rt, Value& target, const Value& first, const Value* second, const Value& item) {
  if (target.is_string()) rt.fail(codes::gcmc_type, "Strings cannot be indexed as lvalues");
  if (target.is_vector() && second == nullptr) return set_coordinate(rt, target, first, item);
  if (!target.is_list()) {
    rt.fail(codes::gcmc_type, fmt::format("Only vectors and vectorlists can be indexed as lvalues ({})",
                                          type_name(target.is_vector() ? item : target)));
  }
  const std::size_t i = writable_index(rt, target, first);
  if (second == nullptr && !item.is_vector())
    rt.fail(codes::gcmc_type, fmt::format("Vectorlist entries must be vectors ({})", type_name(item)));
  auto& vectors = target.own_vectors(rt.meter);
  const std::size_t size = size_after(first, vectors.size());
  if (size > vectors.size()) {
    if (size * sizeof(Value) > rt.meter.limit - rt.meter.used) throw OutOfMemory{};
    vectors.resize(size, Value::empty_vector());
    target.settle();
  }
  if (second == nullptr)
    vectors[i] = item;
  else
    set_coordinate(rt, vectors[i], *second, item);
}

void step_value(Runtime& rt, Value& v, bool down) {
  Scalar stepped;
  if (v.is_scalar() && step_plain(v.scalar(), down, stepped)) {
    v = Value(stepped);
    return;
  }
  rt.warn(codes::gcmc_type,
          fmt::format("{} on non-scalar ({}) has no effect", down ? "Decrement" : "Increment", type_name(v)));
}

}  // namespace kerf::gcmc

// Built-in functions on vectors, vector lists and strings.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/codes/gcmc.h"
#include "front/gcmc/code/operators.h"
#include "front/gcmc/run/builtins.h"
#include "front/gcmc/run/typeset.h"

namespace kerf::gcmc {
namespace {

Value make_vector(const Call& call, const std::vector<Scalar>& all) {
  return Value::vector(all.data(), all.size(), call.vm.meter);
}

void need_vector(const Call& call, int i) {
  if (!call[i].is_vector())
    call.fail(codes::gcmc_type, fmt::format("{}() argument {} must be vector", call.name, i + 1));
}

void need_vector_or_list(const Call& call, int i) {
  if (!call[i].is_vector() && !call[i].is_list())
    call.fail(codes::gcmc_type,
              fmt::format("{}() argument {} must be vector or vectorlist", call.name, i + 1));
}

/// Calls `change` on the vector, or on each of the list.
template <class Change>
Value change_vectors(const Call& call, Change change) {
  need_vector_or_list(call, 0);
  Value v = std::move(call[0]);
  if (v.is_vector())
    change(v);
  else
    for (Value& item : v.own_vectors(call.vm.meter)) change(item);
  return v;
}

Value count(const Call& call) {
  const Value& v = call[0];
  std::size_t n = 0;
  if (v.is_vector())
    n = v.vector_size();
  else if (v.is_list())
    n = v.vectors().size();
  else if (v.is_string())
    n = v.text().size();
  else
    call.fail(codes::gcmc_type, "count() can only count vectors, vectorlists and strings");
  return Value::integer(static_cast<std::int32_t>(std::min<std::size_t>(n, INT32_MAX)));
}

double squares(const Call& call, Unit& unit) {
  const Value& v = call[0];
  if (v.is_real_vector() && v.short_size() == 2 && v.short_coordinate(0).tag == v.short_coordinate(1).tag) {
    unit = v.short_coordinate(0).unit();
    if (unit == Unit::none || unit == call.vm.native)
      return v.real_coordinate(0) * v.real_coordinate(0) + v.real_coordinate(1) * v.real_coordinate(1);
  }
  bool distance = false, angle = false;
  double sum = 0.0;
  for (std::size_t i = 0; i < v.vector_size(); ++i) {
    const Scalar s = v.coordinate(i);
    distance = distance || is_distance(s.unit());
    angle = angle || is_angle(s.unit());
    const double n = native_number(call.vm, s);
    sum += n * n;
  }
  if (distance && angle) {
    call.warn(codes::gcmc_unit,
              fmt::format("Mix of distance and angular units in vector in {}() operation", call.name));
  }
  unit = distance ? call.vm.native : angle ? Unit::deg : Unit::none;
  return sum;
}

Value length(const Call& call) {
  need_vector(call, 0);
  Unit unit;
  const double sum = squares(call, unit);
  return Value::real(std::sqrt(sum), unit);
}

Value normalize(const Call& call) {
  need_vector(call, 0);
  Unit unit;
  const double size = std::sqrt(squares(call, unit));
  if (size < kEpsilon)
    call.warn(codes::gcmc_range, "normalize() argument 1 has no length, the result is not a number");
  Value v = std::move(call[0]);
  for (std::size_t i = 0; i < v.vector_size(); ++i) {
    const Scalar s = v.coordinate(i);
    if (s.defined()) v.set_coordinate(i, Scalar::real(native_number(call.vm, s) / size), call.vm.meter);
  }
  return v;
}

// ---- parts

std::size_t size_of_sequence(const Call& call) {
  const Value& v = call[0];
  if (v.is_vector()) return v.vector_size();
  if (v.is_list()) return v.vectors().size();
  if (v.is_string()) return v.text().size();
  call.fail(codes::gcmc_type, fmt::format("{}() argument 0 must be vector, vectorlist or string", call.name));
}

/// Entries [from, from + n) of a vector, list or string.
Value part(const Call& call, std::size_t from, std::size_t n) {
  const Value& v = call[0];
  const auto first = static_cast<std::ptrdiff_t>(from), last = static_cast<std::ptrdiff_t>(from + n);
  if (v.is_vector()) {
    const std::vector<Scalar> all = v.coordinates();
    return make_vector(call, {all.begin() + first, all.begin() + last});
  }
  if (v.is_list())
    return Value::list({v.vectors().begin() + first, v.vectors().begin() + last}, call.vm.meter);
  return Value::string(v.text().substr(from, n), call.vm.meter);
}

/// The requested number of entries of head and tail: `n`, or size - |n| if negative; may exceed size.
std::size_t wanted(const Call& call, std::size_t size) {
  const std::int64_t n = call.integer(1);
  if (n >= 0) return static_cast<std::size_t>(n);
  const std::int64_t left = static_cast<std::int64_t>(size) + n;
  return left > 0 ? static_cast<std::size_t>(left) : 0;
}

Value head(const Call& call) {
  const std::size_t size = size_of_sequence(call);
  return part(call, 0, std::min(wanted(call, size), size));
}

Value tail(const Call& call) {
  constexpr std::size_t kMaxPadding = 1'000'000;
  const std::size_t size = size_of_sequence(call);
  const std::size_t n = wanted(call, size);
  if (n <= size || !call[0].is_vector()) return part(call, size - std::min(n, size), std::min(n, size));
  if (n > kMaxPadding) call.fail(codes::gcmc_limit, fmt::format("{}() argument 2 is too large", call.name));
  std::vector<Scalar> all(n - size);
  const std::vector<Scalar> had = call[0].coordinates();
  all.insert(all.end(), had.begin(), had.end());
  return make_vector(call, all);
}

std::string_view kind_name(const Value& v) {
  return v.is_vector() ? "vector" : v.is_list() ? "vectorlist" : "string";
}

Value remove(const Call& call) {
  const std::size_t size = size_of_sequence(call);
  if (size == 0) {
    call.warn(codes::gcmc_range, fmt::format("{}(): argument 0 {} has no entries, cannot delete", call.name,
                                             kind_name(call[0])));
    return std::move(call[0]);
  }
  const auto n = static_cast<std::int64_t>(size);
  const std::int64_t i = call.integer(1);
  if (i < -n || i >= n) {
    call.fail(codes::gcmc_range,
              fmt::format("{}(): argument 1 index {} out of range [-{}..{}]", call.name, i, n, n - 1));
  }
  const std::int64_t from = i < 0 ? i + n : i;
  std::int64_t removed = call.count > 2 ? call.integer(2) : 1;
  if (removed < 0)
    call.fail(codes::gcmc_range, fmt::format("{}(): argument 2 must not be negative", call.name));
  if (from + removed > n) {
    call.warn(codes::gcmc_range, fmt::format("{}(): argument 2 count {} is beyond the end, clipped to {}",
                                             call.name, removed, n - from));
    removed = n - from;
  }
  const auto at = static_cast<std::size_t>(from), drop = static_cast<std::size_t>(removed);
  Value before = part(call, 0, at);
  const Value after = part(call, at + drop, size - at - drop);
  if (before.is_list() || before.is_string()) {
    operate(call.vm, Op::add, before, after);
    return before;
  }
  std::vector<Scalar> all = before.coordinates();
  for (const Scalar& s : after.coordinates()) all.push_back(s);
  return make_vector(call, all);
}

void check_inserted(const Call& call) {
  const Value& v = call[0];
  const Value& item = call[1];
  std::string_view needed;
  if (v.is_vector() && !item.is_scalar() && !item.is_vector()) needed = "scalar or vector";
  if (v.is_list() && !item.is_vector() && !item.is_list()) needed = "vector or vectorlist";
  if (v.is_string() && !item.is_string()) needed = "string";
  if (needed.empty()) return;
  call.fail(codes::gcmc_type,
            fmt::format("{}() argument 1 must be {} for argument 0 as {}", call.name, needed, kind_name(v)));
}

Value insert(const Call& call) {
  const auto size = static_cast<std::int64_t>(size_of_sequence(call));
  check_inserted(call);
  const std::int64_t i = call.integer(2);
  if (i < -size - 1 || i > size) {
    call.fail(codes::gcmc_range,
              fmt::format("{}(): argument 2 index {} out of range [-{}..{}]", call.name, i, size + 1, size));
  }
  const auto position = static_cast<std::ptrdiff_t>(i < 0 ? i + size + 1 : i);
  Value v = std::move(call[0]);
  const Value& item = call[1];
  if (v.is_string()) {
    v.own_text(call.vm.meter).insert(static_cast<std::size_t>(position), item.text());
    v.settle();
    return v;
  }
  if (v.is_list()) {
    auto& all = v.own_vectors(call.vm.meter);
    if (item.is_vector())
      all.insert(all.begin() + position, item);
    else
      all.insert(all.begin() + position, item.vectors().begin(), item.vectors().end());
    v.settle();
    return v;
  }
  std::vector<Scalar> all = v.coordinates();
  const std::vector<Scalar> more = item.is_vector() ? item.coordinates() : std::vector<Scalar>{item.scalar()};
  all.insert(all.begin() + position, more.begin(), more.end());
  return make_vector(call, all);
}

Value reverse(const Call& call) {
  if (call[0].is_list()) {
    Value v = std::move(call[0]);
    auto& all = v.own_vectors(call.vm.meter);
    std::reverse(all.begin(), all.end());
    return v;
  }
  if (call[0].is_string()) {
    Value v = std::move(call[0]);
    auto& all = v.own_text(call.vm.meter);
    std::reverse(all.begin(), all.end());
    return v;
  }
  if (!call[0].is_vector())
    call.fail(codes::gcmc_type, "reverse() argument 1 must be vector, vectorlist or string");
  std::vector<Scalar> all = call[0].coordinates();
  std::reverse(all.begin(), all.end());
  return make_vector(call, all);
}

// ---- geometry

Value scale(const Call& call) {
  need_vector(call, 1);
  const std::vector<Scalar> factors = call[1].coordinates();
  return change_vectors(call, [&](Value& v) {
    for (std::size_t i = 0; i < factors.size(); ++i) {
      const Scalar s = v.coordinate_or_undef(i);
      if (i >= v.vector_size())
        v.set_coordinate(i, Scalar{}, call.vm.meter);
      else if (factors[i].defined())
        v.set_coordinate(i, scalar_operation(call.vm, Op::mul, s, factors[i]), call.vm.meter);
    }
  });
}

template <int first, int second>
Value rotate(const Call& call) {
  static constexpr char kNames[] = "XYZ";
  const double angle = call.angle(1);
  const double c = std::cos(angle), s = std::sin(angle);
  return change_vectors(call, [&](Value& v) {
    const Scalar a = v.coordinate_or_undef(first), b = v.coordinate_or_undef(second);
    if (a.unit() != b.unit()) {
      call.warn(codes::gcmc_unit,
                fmt::format("{}() Vector coordinates for {} and {} have different units ({}={}, {}={})",
                            call.name, kNames[first], kNames[second], kNames[first], unit_name(a.unit()),
                            kNames[second], unit_name(b.unit())));
    }
    const Unit unit = b.unit() == Unit::none ? a.unit() : b.unit();
    const double x = convert(a.number(), a.unit(), unit), y = b.number();
    v.set_coordinate(first, Scalar::real(x * c - y * s, unit), call.vm.meter);
    v.set_coordinate(second, Scalar::real(x * s + y * c, unit), call.vm.meter);
  });
}

Value typeset(const Call& call) {
  if (!call[0].is_string()) call.fail(codes::gcmc_type, "typeset() argument 1 must be string");
  const Scalar font = call.scalar(1);
  if (font.kind() != Kind::integer) call.fail(codes::gcmc_type, "typeset() argument 2 must be integer");
  return typeset_text(call.vm, call[0].text(), font.whole());
}

}  // namespace

const std::vector<Builtin>& vector_builtins() {
  static const std::vector<Builtin> table = {
      {"count", count, 1, 1},
      {"length", length, 1, 1},
      {"normalize", normalize, 1, 1},
      {"head", head, 2, 2},
      {"tail", tail, 2, 2},
      {"delete", remove, 2, 3},
      {"insert", insert, 3, 3},
      {"reverse", reverse, 1, 1},
      {"scale", scale, 2, 2},
      {"rotate_xy", rotate<0, 1>, 2, 2},
      {"rotate_xz", rotate<0, 2>, 2, 2},
      {"rotate_yz", rotate<1, 2>, 2, 2},
      {"typeset", typeset, 2, 2},
  };
  return table;
}

}  // namespace kerf::gcmc

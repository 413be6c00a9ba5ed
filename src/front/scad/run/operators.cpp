// Operators on values that are not two numbers.
#include <algorithm>
#include <cmath>
#include <compare>
#include <fmt/format.h>
#include <optional>

#include "base/codes/scad.h"
#include "base/utf8.h"
#include "front/scad/run/interpreter.h"

namespace kerf::scad {
namespace {

Value undefined(Interpreter& run, ExprKind kind, const Value& a, const Value& b, Position at) {
  run.warn(codes::scad_operation, at,
           fmt::format("{} {} {} has no value; the result is undef", name_of(a.type()), sign_of(kind),
                       name_of(b.type())));
  return {};
}

/// The order of two values; nothing for values of other types. Undefined numbers in vectors are equal to all.
std::optional<std::partial_ordering> compare(Interpreter& run, const Value& a, const Value& b, Position at) {
  run.tick(at);
  if (a.type() != b.type()) return std::nullopt;
  const auto of = [](auto x, auto y) { return std::partial_ordering(x <=> y); };
  switch (a.type()) {
    case Type::number: return of(a.number(), b.number());
    case Type::boolean: return of(a.truth(), b.truth());
    case Type::string: return of(a.text().compare(b.text()), 0);
    case Type::vector: {
      const auto x = a.items(), y = b.items();
      for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
        if (const auto c = compare(run, x[i], y[i], at); !c || *c < 0 || *c > 0) return c;
      return of(x.size(), y.size());
    }
    case Type::range: return a.range() <=> b.range();
    default: return std::nullopt;
  }
}

Value ordered(Interpreter& run, ExprKind kind, const Value& a, const Value& b, Position at) {
  const auto c = compare(run, a, b, at);
  if (!c) return undefined(run, kind, a, b, at);
  switch (kind) {
    case ExprKind::less: return Value::truth(*c < 0);
    case ExprKind::less_equal: return Value::truth(*c <= 0);
    case ExprKind::greater: return Value::truth(*c > 0);
    default: return Value::truth(*c >= 0);
  }
}

Value of_numbers(ExprKind kind, double x, double y) {
  switch (kind) {
    case ExprKind::add: return x + y;
    case ExprKind::subtract: return x - y;
    case ExprKind::multiply: return x * y;
    case ExprKind::divide: return x / y;
    case ExprKind::modulo: return remainder_of(x, y);
    default: return std::pow(x, y);
  }
}

Value of_items(Interpreter& run, ExprKind kind, const Value& a, const Value& b, Position at) {
  if (a.is_number() && b.is_number()) return of_numbers(kind, a.number(), b.number());
  return operate(run, kind, a, b, at);
}

/// Element by element, as far as the shorter one goes.
Value pairwise(Interpreter& run, ExprKind kind, const Value& a, const Value& b, Position at) {
  const std::span<const Value> x = a.items(), y = b.items();
  const std::size_t count = std::min(x.size(), y.size());
  ItemList items;
  items.reserve(count);
  for (std::size_t i = 0; i < count; ++i) items.push_back(of_items(run, kind, x[i], y[i], at));
  return run.list(std::move(items), at);
}

/// A vector with a number, on its left or right.
Value scaled(Interpreter& run, ExprKind kind, const Value& a, const Value& b, Position at) {
  const bool is_left = a.is(Type::vector);
  const auto list = is_left ? a.items() : b.items();
  ItemList items;
  items.reserve(list.size());
  for (const Value& v : list)
    items.push_back(is_left ? of_items(run, kind, v, b, at) : of_items(run, kind, a, v, at));
  return run.list(std::move(items), at);
}

bool is_matrix(const Value& v) { return !v.items().empty() && v.items()[0].is(Type::vector); }

/// Whether all rows have `width` numbers.
bool is_regular(const Value& m, std::size_t width) {
  return std::all_of(m.items().begin(), m.items().end(), [&](const Value& row) {
    return row.is(Type::vector) && row.items().size() == width &&
           std::all_of(row.items().begin(), row.items().end(), [](const Value& x) { return x.is_number(); });
  });
}
bool is_numeric(const Value& v) {
  return std::all_of(v.items().begin(), v.items().end(), [](const Value& x) { return x.is_number(); });
}

std::optional<double> dot(const Value& a, const Value& b) {
  if (a.items().size() != b.items().size() || !is_numeric(a) || !is_numeric(b)) return std::nullopt;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.items().size(); ++i) sum += a.items()[i].number() * b.items()[i].number();
  return sum;
}

/// A row times a matrix of as many rows.
std::optional<std::vector<Value>> row_times(const Value& row, const Value& m) {
  const std::size_t width = m.items()[0].items().size();
  if (row.items().size() != m.items().size() || !is_numeric(row) || !is_regular(m, width))
    return std::nullopt;
  std::vector<Value> out;
  for (std::size_t c = 0; c < width; ++c) {
    double sum = 0.0;
    for (std::size_t r = 0; r < m.items().size(); ++r)
      sum += row.items()[r].number() * m.items()[r].items()[c].number();
    out.emplace_back(sum);
  }
  return out;
}

Value product(Interpreter& run, const Value& a, const Value& b, Position at) {
  if (a.items().empty() || b.items().empty()) return undefined(run, ExprKind::multiply, a, b, at);
  if (!is_matrix(a) && !is_matrix(b)) {
    const auto sum = dot(a, b);
    return sum ? Value(*sum) : undefined(run, ExprKind::multiply, a, b, at);
  }
  std::vector<Value> out;
  if (!is_matrix(a)) {
    auto row = row_times(a, b);
    return row ? run.vector(std::move(*row), at) : undefined(run, ExprKind::multiply, a, b, at);
  }
  for (const Value& row : a.items()) {
    if (!row.is(Type::vector)) return undefined(run, ExprKind::multiply, a, b, at);
    if (is_matrix(b)) {
      auto product_row = row_times(row, b);
      if (!product_row) return undefined(run, ExprKind::multiply, a, b, at);
      out.push_back(run.vector(std::move(*product_row), at));
    } else {
      const auto sum = dot(row, b);
      if (!sum) return undefined(run, ExprKind::multiply, a, b, at);
      out.emplace_back(*sum);
    }
  }
  return run.vector(std::move(out), at);
}

}  // namespace

double remainder_of(double x, double y) {
  // Whole numbers below 2^31: the division of the processor is faster than the library's.
  constexpr double kSmall = 2147483648.0;
  if (x >= 0.0 && x < kSmall && y >= 1.0 && y < kSmall) {
    const auto i = static_cast<std::uint32_t>(x), j = static_cast<std::uint32_t>(y);
    if (static_cast<double>(i) == x && static_cast<double>(j) == y) return static_cast<double>(i % j);
  }
  return std::fmod(x, y);
}

Value operate(Interpreter& run, ExprKind kind, const Value& a, const Value& b, Position at) {
  const bool vector_a = a.is(Type::vector), vector_b = b.is(Type::vector);
  switch (kind) {
    case ExprKind::equal: return Value::truth(same(run, a, b, at));
    case ExprKind::not_equal: return Value::truth(!same(run, a, b, at));
    case ExprKind::less:
    case ExprKind::less_equal:
    case ExprKind::greater:
    case ExprKind::greater_equal: return ordered(run, kind, a, b, at);
    default: break;
  }
  if (a.is_number() && b.is_number()) return of_numbers(kind, a.number(), b.number());
  if ((kind == ExprKind::add || kind == ExprKind::subtract) && vector_a && vector_b)
    return pairwise(run, kind, a, b, at);
  if (kind == ExprKind::multiply && vector_a && vector_b) return product(run, a, b, at);
  const bool scales = kind == ExprKind::multiply || kind == ExprKind::divide;
  if (scales && ((vector_a && b.is_number()) || (a.is_number() && vector_b)))
    return scaled(run, kind, a, b, at);
  return undefined(run, kind, a, b, at);
}

bool same(Interpreter& run, const Value& a, const Value& b, Position at) {
  if (!a.is(Type::vector) || !b.is(Type::vector)) return equal(a, b);
  if (a.items().size() != b.items().size()) return false;
  for (std::size_t i = 0; i < a.items().size(); ++i) {
    run.tick(at);
    if (!same(run, a.items()[i], b.items()[i], at)) return false;
  }
  return true;
}

Value negative(Interpreter& run, const Value& a, Position at) {
  if (a.is_number()) return -a.number();
  if (a.is(Type::vector)) {
    std::vector<Value> items;
    items.reserve(a.items().size());
    for (const Value& v : a.items()) items.push_back(negative(run, v, at));
    return run.vector(std::move(items), at);
  }
  run.warn(codes::scad_operation, at,
           fmt::format("-{} has no value; the result is undef", name_of(a.type())));
  return {};
}

namespace {

std::size_t character_size(char first) {
  const auto c = static_cast<unsigned char>(first);
  if (c < 0xc0 || c >= 0xfe) return 1;
  return c < 0xe0 ? 2 : c < 0xf0 ? 3 : c < 0xf8 ? 4 : c < 0xfc ? 5 : 6;
}

}  // namespace

std::size_t character_count(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size(); i += character_size(text[i])) ++count;
  return count;
}

std::optional<char32_t> code_point(std::string_view character) {
  const std::u32string codes = from_utf8(character);
  constexpr char32_t kAscii = 0x80;
  if (codes.size() != 1 || (character.size() == 1 && codes[0] >= kAscii)) return std::nullopt;
  return codes[0];
}

std::vector<std::string_view> characters(std::string_view text) {
  std::vector<std::string_view> out;
  for (std::size_t i = 0; i < text.size();) {
    out.push_back(text.substr(i, character_size(text[i])));
    i += out.back().size();
  }
  return out;
}

Value index_value(const Value& a, const Value& b) {
  if (!b.is_number() || !(b.number() > -1.0) || !(b.number() < 1e15)) return {};
  const auto i = static_cast<std::size_t>(b.number());
  switch (a.type()) {
    case Type::vector: return i < a.items().size() ? a.items()[i] : Value();
    case Type::string: {
      const std::string& text = a.text();
      const bool is_ascii = std::none_of(text.begin(), text.end(), [](char c) { return (c & 0x80) != 0; });
      if (is_ascii) return i < text.size() ? Value::string(text.substr(i, 1)) : Value();
      const auto list = characters(text);
      return i < list.size() ? Value::string(std::string(list[i])) : Value();
    }
    case Type::range:
      return i == 0 ? a.range().begin : i == 1 ? a.range().step : i == 2 ? Value(a.range().end) : Value();
    default: return {};
  }
}

Value member_value(const Value& a, const std::string& name) {
  if (a.is(Type::vector)) {
    const std::size_t i = name == "x" ? 0 : name == "y" ? 1 : name == "z" ? 2 : a.items().size();
    return i < a.items().size() ? a.items()[i] : Value();
  }
  if (a.is(Type::range)) {
    if (name == "begin") return a.range().begin;
    if (name == "step") return a.range().step;
    if (name == "end") return a.range().end;
  }
  return {};
}

}  // namespace kerf::scad

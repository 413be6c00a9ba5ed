// The functions of OpenSCAD.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <random>

#include "base/codes/scad.h"
#include "base/names.h"
#include "front/scad/run/degrees.h"
#include "front/scad/run/interpreter.h"

namespace kerf::scad {
namespace {

Value wrong(BuiltinCall& call, std::string_view expected) {
  std::string given;
  for (const Value& v : call.arguments) {
    if (!given.empty()) given += ", ";
    given += name_of(v.type());
  }
  if (call.arguments.size() < call.names.size())
    given = fmt::format("{} arguments", call.names.size());  // not evaluated
  call.run.warn(codes::scad_operation, call.at,
                fmt::format("{}({}) is undef; expected {}", call.name, given, expected));
  return {};
}

bool has(const BuiltinCall& call, std::size_t i, Type type) {
  return i < call.arguments.size() && call.arguments[i].is(type);
}

// ---- numbers

Value not_one_number(BuiltinCall& call) { return wrong(call, "one number"); }

double sign_of(double x) { return x < 0.0 ? -1.0 : x > 0.0 ? 1.0 : 0.0; }

Value two_numbers(BuiltinCall& call, double (*f)(double, double)) {
  if (call.arguments.size() != 2 || !has(call, 0, Type::number) || !has(call, 1, Type::number))
    return wrong(call, "two numbers");
  return f(call.arguments[0].number(), call.arguments[1].number());
}
Value power(BuiltinCall& call) {
  return two_numbers(call, [](double x, double y) { return std::pow(x, y); });
}
Value atan2_of(BuiltinCall& call) { return two_numbers(call, atan2_degrees); }

/// Of several numbers, or of the values of one vector in the order of the operators "<" and ">".
Value extreme(BuiltinCall& call, ExprKind better) {
  std::span<const Value> list = call.arguments;
  const bool is_vector = list.size() == 1 && list[0].is(Type::vector);
  if (is_vector) list = list[0].items();
  const auto is_number = [](const Value& v) { return v.is_number(); };
  if (list.empty() || (!is_vector && !std::all_of(list.begin(), list.end(), is_number)))
    return wrong(call, "numbers, or a vector");
  const Value* best = &list[0];
  for (const Value& v : list.subspan(1))
    if (operate(call.run, better, v, *best, call.at).is_true()) best = &v;
  return *best;
}
Value minimum(BuiltinCall& call) { return extreme(call, ExprKind::less); }
Value maximum(BuiltinCall& call) { return extreme(call, ExprKind::greater); }

/// The seed of a number: its residue modulo the prime 2^31 - 1, with its sign, so that whole numbers are
/// themselves and every other number has a seed that depends on all of its bits.
std::uint32_t seed_of(double x) {
  constexpr int kBits = 31;
  constexpr std::uint64_t kPrime = (std::uint64_t{1} << kBits) - 1;
  constexpr std::int32_t kInfinity = 314159;
  if (std::isnan(x) || x == 0.0) return 0;
  if (std::isinf(x)) return static_cast<std::uint32_t>(x > 0.0 ? kInfinity : -kInfinity);
  int exponent = 0;
  const double fraction = std::frexp(std::fabs(x), &exponent);  // in [0.5, 1)
  constexpr int kDigits = std::numeric_limits<double>::digits;
  const auto whole = static_cast<std::uint64_t>(std::ldexp(fraction, kDigits)) % kPrime;
  // 2^31 is 1 modulo the prime: the power of two has an exponent modulo 31.
  const int shift = ((exponent - kDigits) % kBits + kBits) % kBits;
  const auto residue = static_cast<std::int64_t>((whole << shift) % kPrime);
  return static_cast<std::uint32_t>(x < 0.0 ? -residue : residue);
}

/// A limit of rands(), made finite as OpenSCAD does, with its warning.
double finite_limit(BuiltinCall& call, double x, std::string_view which, double otherwise) {
  if (std::isfinite(x)) return x;
  call.run.warn(codes::scad_operation, call.at,
                fmt::format("rands() range {} cannot be infinite; it is reset to {}", which, otherwise));
  return otherwise;
}

Value random_numbers(BuiltinCall& call) {
  if (call.arguments.size() < 3 || !has(call, 0, Type::number) || !has(call, 1, Type::number) ||
      !has(call, 2, Type::number) || (call.arguments.size() > 3 && !has(call, 3, Type::number)))
    return wrong(call, "the lowest and highest value, their number and perhaps a seed");
  constexpr double kHalf = std::numeric_limits<double>::max() / 2.0;
  double low = finite_limit(call, call.arguments[0].number(), "min", -kHalf);
  double high = finite_limit(call, call.arguments[1].number(), "max", kHalf);
  if (high < low) std::swap(low, high);
  double count = std::fabs(call.arguments[2].number());
  if (!std::isfinite(count)) {
    call.run.warn(codes::scad_operation, call.at,
                  "rands() cannot create an infinite number of results; their number is reset to 1");
    count = 1.0;
  }
  call.run.check_items(static_cast<std::size_t>(std::min(count, 1e15)), call.at);
  // Without a seed the values are those of one sequence in each run: results depend on the program alone.
  std::mt19937 engine(has(call, 3, Type::number) ? seed_of(call.arguments[3].number())
                                                 : call.run.next_seed());
  std::vector<Value> items;
  for (double i = 0; i < std::floor(count); ++i) {
    double x = low;
    if (high > low) {  // 64 random bits for each value
      constexpr double kTwo32 = 4294967296.0;
      const auto first = static_cast<double>(engine()), second = static_cast<double>(engine());
      x = (first + second * kTwo32) / (kTwo32 * kTwo32) * (high - low) + low;
    }
    items.emplace_back(x);
  }
  return call.run.vector(std::move(items), call.at);
}

/// To base 10, or to the first number.
Value logarithm(BuiltinCall& call) {
  if (call.arguments.empty() || !has(call, 0, Type::number) ||
      (call.arguments.size() > 1 && !has(call, 1, Type::number)))
    return wrong(call, "one or two numbers");
  const double x = call.arguments[0].number();
  return call.arguments.size() == 1 ? std::log10(x) : std::log(call.arguments[1].number()) / std::log(x);
}

Value norm(BuiltinCall& call) {
  if (call.arguments.size() != 1 || !has(call, 0, Type::vector)) return wrong(call, "a vector of numbers");
  double sum = 0.0;
  for (const Value& v : call.arguments[0].items()) {
    if (!v.is_number()) return wrong(call, "a vector of numbers");
    sum += v.number() * v.number();
  }
  return std::sqrt(sum);
}

Value cross_product(BuiltinCall& call) {
  const std::string_view expected = "two vectors of 2 or of 3 numbers";
  if (call.arguments.size() != 2 || !has(call, 0, Type::vector) || !has(call, 1, Type::vector))
    return wrong(call, expected);
  const auto a = call.arguments[0].items(), b = call.arguments[1].items();
  if (a.size() != b.size() || (a.size() != 2 && a.size() != 3)) return wrong(call, expected);
  if (a.size() == 2) {  // as in OpenSCAD, other values count as 0
    const auto of = [](const Value& v) { return v.is_number() ? v.number() : 0.0; };
    return of(a[0]) * of(b[1]) - of(a[1]) * of(b[0]);
  }
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!a[i].is_number() || !b[i].is_number() || !std::isfinite(a[i].number()) ||
        !std::isfinite(b[i].number()))
      return wrong(call, expected);
  const auto minor = [&](std::size_t i, std::size_t j) {
    return a[i].number() * b[j].number() - a[j].number() * b[i].number();
  };
  return call.run.vector({minor(1, 2), minor(2, 0), minor(0, 1)}, call.at);
}

Value lookup(BuiltinCall& call) {
  if (call.arguments.size() != 2 || !has(call, 0, Type::number) ||
      !std::isfinite(call.arguments[0].number()) || !has(call, 1, Type::vector))
    return wrong(call, "a finite number and a vector of pairs of numbers");
  const double key = call.arguments[0].number();
  const auto pair = [](const Value& v) -> std::optional<std::pair<double, double>> {
    if (!v.is(Type::vector) || v.items().size() != 2 || !v.items()[0].is_number() ||
        !v.items()[1].is_number())
      return std::nullopt;
    return std::pair{v.items()[0].number(), v.items()[1].number()};
  };
  const auto table = call.arguments[1].items();
  const auto first = table.empty() ? std::nullopt : pair(table[0]);
  if (!first) return {};  // as in OpenSCAD, further ones that are no pairs are skipped
  auto below = *first, above = *first;
  for (const Value& v : table.subspan(1)) {
    const auto p = pair(v);
    if (!p) continue;
    if (p->first <= key && (p->first > below.first || below.first > key)) below = *p;
    if (p->first >= key && (p->first < above.first || above.first < key)) above = *p;
  }
  if (key <= below.first) return above.second;
  if (key >= above.first) return below.second;
  const double t = (key - below.first) / (above.first - below.first);
  return above.second * t + below.second * (1.0 - t);
}

// ---- strings and vectors

Value length(BuiltinCall& call) {
  if (call.arguments.size() == 1) {
    const Value& v = call.arguments[0];
    if (v.is(Type::vector)) return static_cast<double>(v.items().size());
    if (v.is(Type::string)) return static_cast<double>(character_count(v.text()));
  }
  return wrong(call, "a vector or string");
}

Value concatenated_text(BuiltinCall& call) {
  std::string text;
  for (const Value& v : call.arguments) {
    text += as_text(v);
    if (text.size() > call.run.limits().max_string) break;  // which string() reports
  }
  return call.run.string(std::move(text), call.at);
}

Value concatenated(BuiltinCall& call) {
  std::vector<Value> items;
  for (const Value& v : call.arguments) {
    if (v.is(Type::vector)) {
      call.run.check_items(items.size() + v.items().size(), call.at);
      items.insert(items.end(), v.items().begin(), v.items().end());
    } else {
      items.push_back(v);
    }
  }
  return call.run.vector(std::move(items), call.at);
}

void append_code_point(std::string& out, double code) {
  if (!(code >= 1.0 && code < 0x110000) || (code >= 0xd800 && code < 0xe000)) return;
  const auto c = static_cast<unsigned>(code);
  const auto byte = [&](unsigned b) { out += static_cast<char>(static_cast<unsigned char>(b)); };
  if (c < 0x80) return byte(c);
  if (c < 0x800) {
    byte(0xc0 | c >> 6);
  } else {
    if (c < 0x10000) {
      byte(0xe0 | c >> 12);
    } else {
      byte(0xf0 | c >> 18);
      byte(0x80 | (c >> 12 & 0x3f));
    }
    byte(0x80 | (c >> 6 & 0x3f));
  }
  byte(0x80 | (c & 0x3f));
}

void append_characters(std::string& out, const Value& v, BuiltinCall& call) {
  call.run.tick(call.at);
  if (out.size() > call.run.limits().max_string) return;  // which string() reports
  if (v.is_number()) {
    append_code_point(out, v.number());
  } else if (v.is(Type::vector)) {
    for (const Value& item : v.items()) append_characters(out, item, call);
  } else if (v.is(Type::range)) {
    const double count = std::min(v.range().count(), static_cast<double>(0x110000));
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) append_code_point(out, v.range().at(i));
  }
}

Value text_of_codes(BuiltinCall& call) {
  std::string text;
  for (const Value& v : call.arguments) append_characters(text, v, call);
  return call.run.string(std::move(text), call.at);
}

Value code_of(BuiltinCall& call) {
  if (call.arguments.size() != 1 || !has(call, 0, Type::string)) return wrong(call, "a string");
  const std::string& text = call.arguments[0].text();
  if (text.empty()) return {};
  const std::optional<char32_t> code = code_point(characters(text)[0]);
  if (code) return static_cast<double>(*code);
  call.run.warn(codes::scad_operation, call.at, "ord(): the string is not valid UTF-8; the result is undef");
  return {};
}

// ---- search

/// Whether an entry of a table is what is searched for: its column, or in column 0 itself.
bool is_match(BuiltinCall& call, const Value& entry, const Value& wanted, std::size_t column) {
  const auto equals = [&](const Value& v) { return same(call.run, v, wanted, call.at); };
  if (column == 0 && equals(entry)) return true;
  return entry.is(Type::vector) && column < entry.items().size() && equals(entry.items()[column]);
}

struct SearchOptions {
  std::size_t per_match = 1;  // 0: all
  std::size_t column = 0;
};

/// Indices of the entries that match, at most as many as the options say.
template <class Matches>
std::vector<Value> indices(BuiltinCall& call, std::size_t count, const SearchOptions& options,
                           Matches matches) {
  std::vector<Value> found;
  for (std::size_t i = 0; i < count; ++i) {
    call.run.tick(call.at);
    if (!matches(i)) continue;
    found.emplace_back(static_cast<double>(i));
    if (options.per_match != 0 && found.size() >= options.per_match) break;
  }
  return found;
}

/// The first characters of a column, up to the first entry that has no such column.
std::vector<std::string> first_characters(std::span<const Value> rows, std::size_t column) {
  std::vector<std::string> firsts;
  for (const Value& row : rows) {
    if (!row.is(Type::vector) || column >= row.items().size()) break;
    const std::string cell = as_text(row.items()[column], 16);
    firsts.emplace_back(cell.empty() ? "" : std::string(characters(cell)[0]));
  }
  return firsts;
}

Value invalid_entry(BuiltinCall& call, std::size_t index, std::size_t column) {
  const Value& entry = call.arguments[1].items()[index];
  call.run.warn(codes::scad_operation, call.at,
                fmt::format("invalid entry in search vector at index {}, required number of values in the "
                            "entry: {}; invalid entry: {}",
                            index, column + 1, to_string(entry, 60).substr(0, 60)));
  return call.run.vector({}, call.at);
}

Value search_text(BuiltinCall& call, const SearchOptions& options) {
  const auto wanted = characters(call.arguments[0].text());
  const Value& table = call.arguments[1];
  std::vector<std::string_view> letters;
  if (table.is(Type::string)) letters = characters(table.text());
  std::vector<std::string> firsts;  // of the entries of a table, as far as they are valid
  const auto rows = table.is(Type::vector) ? table.items() : std::span<const Value>();
  firsts = first_characters(rows, options.column);
  std::vector<Value> out;
  for (const std::string_view c : wanted) {
    std::vector<Value> found;
    if (table.is(Type::string)) {
      found = indices(call, letters.size(), options, [&](std::size_t i) { return letters[i] == c; });
    } else {
      found = indices(call, firsts.size(), options, [&](std::size_t i) { return firsts[i] == c; });
      const bool is_complete = firsts.size() == rows.size();
      if (!is_complete && (options.per_match == 0 || found.size() < options.per_match))
        return invalid_entry(call, firsts.size(), options.column);
      if (found.empty())
        call.run.warn(codes::scad_operation, call.at,
                      fmt::format("search term not found: \"{}\"", clipped(c)));
    }
    if (options.per_match != 1)
      out.push_back(call.run.vector(std::move(found), call.at));
    else if (!found.empty())
      out.push_back(found[0]);
  }
  return call.run.vector(std::move(out), call.at);
}

Value search(BuiltinCall& call) {
  if (call.arguments.size() < 2) return wrong(call, "what to search for, and a vector or string");
  const Value& wanted = call.arguments[0];
  if (!wanted.is(Type::vector) && !wanted.is(Type::string) && !wanted.is_number()) return {};
  if (!has(call, 1, Type::vector) && !has(call, 1, Type::string)) {
    call.run.warn(codes::scad_operation, call.at,
                  fmt::format("search() in a value of the type {}; expected a vector or string",
                              name_of(call.arguments[1].type())));
    if (wanted.is_number()) return call.run.vector({}, call.at);
  }
  // As in OpenSCAD what is no finite number counts as 0, and a negative number as a large one.
  const auto whole = [&](std::size_t i, std::size_t otherwise) -> std::size_t {
    constexpr double kMax = 4294967295.0;
    if (i >= call.arguments.size()) return otherwise;
    const double x = has(call, i, Type::number) ? call.arguments[i].number() : 0.0;
    if (!std::isfinite(x) || x > kMax) return 0;
    return static_cast<std::size_t>(x <= -1.0 ? kMax : std::max(x, 0.0));
  };
  const SearchOptions options{whole(2, 1), whole(3, 0)};
  if (wanted.is(Type::string)) return search_text(call, options);
  if (!has(call, 1, Type::vector) && !wanted.is(Type::vector)) return call.run.vector({}, call.at);
  // In what is no vector, each value of a vector is not found.
  const auto table = has(call, 1, Type::vector) ? call.arguments[1].items() : std::span<const Value>();
  const auto find = [&](const Value& v) {
    return indices(call, table.size(), options,
                   [&](std::size_t i) { return is_match(call, table[i], v, options.column); });
  };
  if (wanted.is_number()) return call.run.vector(find(wanted), call.at);
  std::vector<Value> out;
  for (const Value& v : wanted.items()) {
    auto found = find(v);
    if (options.per_match == 1 && !found.empty())
      out.push_back(found[0]);
    else
      out.push_back(call.run.vector(std::move(found), call.at));
  }
  return call.run.vector(std::move(out), call.at);
}

// ---- types and the program

template <Type type>
Value is_type(BuiltinCall& call) {
  if (call.arguments.size() != 1) return wrong(call, "one value");
  return Value::truth(call.arguments[0].is(type) ||
                      (type == Type::undef && call.arguments[0].is(Type::unset)));
}
Value is_num(BuiltinCall& call) {
  if (call.arguments.size() != 1) return wrong(call, "one value");
  return Value::truth(call.arguments[0].is_number() && !std::isnan(call.arguments[0].number()));
}

Value version(BuiltinCall& call) { return call.run.vector({2021.0, 1.0, 0.0}, call.at); }
Value version_number(BuiltinCall& call) {
  if (call.arguments.empty()) return 20210100.0;
  const auto parts =
      call.arguments[0].is(Type::vector) ? call.arguments[0].items() : std::span<const Value>();
  if (parts.size() < 2 || parts.size() > 3) return wrong(call, "a vector of year, month and day");
  double number = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (i < parts.size() && !parts[i].is_number()) return wrong(call, "a vector of year, month and day");
    number = number * 100.0 + (i < parts.size() ? parts[i].number() : 0.0);
  }
  return number;
}

Value parent_module(BuiltinCall& call) {
  double n = has(call, 0, Type::number) ? call.arguments[0].number() : 1.0;
  const Activation* a = call.run.activation();
  for (; a != nullptr && n >= 1.0; --n) a = a->outer;
  if (a == nullptr || n < 0.0) {
    call.run.warn(codes::scad_operation, call.at, "parent_module(): there are fewer modules around the call");
    return {};
  }
  return call.run.string(a->module->name, call.at);
}

/// The arguments of dxf_dim() and dxf_cross(), by name: file, layer, name, origin, scale. Those without a
/// name are not used, as in OpenSCAD.
Measured measure_of(BuiltinCall& call) {
  Measured what;
  what.file.where = call.run.locate(call.at);
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const std::string& name = call.names[i].name;
    const Value& v = call.arguments[i];
    if (name == "file" && v.is(Type::string)) {
      what.file.path = call.run.files().path_beside(v.text(), call.at);
    } else if (name == "layer" && v.is(Type::string)) {
      what.file.layer = v.text();
    } else if (name == "name" && v.is(Type::string)) {
      what.name = v.text();
    } else if (name == "scale" && v.is_number()) {
      what.scale = v.number();
    } else if (name == "origin" && v.is(Type::vector) && v.items().size() == 2 && v.items()[0].is_number() &&
               v.items()[1].is_number() && std::isfinite(v.items()[0].number() + v.items()[1].number())) {
      what.origin = {v.items()[0].number(), v.items()[1].number()};
    } else {
      call.run.warn(codes::scad_operation, call.at,
                    fmt::format("{}(..., {}={}) could not be converted or is not supported", call.name, name,
                                to_string(v).substr(0, 60)));
    }
  }
  return what;
}

Value dxf_dimension(BuiltinCall& call) {
  const Measured what = measure_of(call);
  if (call.run.files().imports == nullptr) return {};
  const auto found = call.run.files().imports->dimension(what, call.run.diagnostics());
  if (!found) return {};
  call.run.files().paths.push_back(what.file.path);
  return *found;
}

Value dxf_crossing(BuiltinCall& call) {
  const Measured what = measure_of(call);
  if (call.run.files().imports == nullptr) return {};
  const auto found = call.run.files().imports->crossing(what, call.run.diagnostics());
  if (!found) return {};
  call.run.files().paths.push_back(what.file.path);
  return call.run.vector({found->x, found->y}, call.at);
}

}  // namespace

const std::vector<BuiltinFunction>& builtin_functions() {
  using enum BuiltinArguments;
  constexpr std::size_t kAny = BuiltinFunction::kAny;
  static const std::vector<BuiltinFunction> table{
      {"abs", not_one_number, [](double x) { return std::fabs(x); }, 1, 1},
      {"sign", not_one_number, sign_of, 1, 1},
      {"sin", not_one_number, sin_degrees, 1, 1},
      {"cos", not_one_number, cos_degrees, 1, 1},
      {"tan", not_one_number, tan_degrees, 1, 1},
      {"asin", not_one_number, asin_degrees, 1, 1},
      {"acos", not_one_number, acos_degrees, 1, 1},
      {"atan", not_one_number, atan_degrees, 1, 1},
      {"round", not_one_number, [](double x) { return std::round(x); }, 1, 1},
      {"ceil", not_one_number, [](double x) { return std::ceil(x); }, 1, 1},
      {"floor", not_one_number, [](double x) { return std::floor(x); }, 1, 1},
      {"sqrt", not_one_number, [](double x) { return std::sqrt(x); }, 1, 1},
      {"exp", not_one_number, [](double x) { return std::exp(x); }, 1, 1},
      {"ln", not_one_number, [](double x) { return std::log(x); }, 1, 1},
      {"log", logarithm, [](double x) { return std::log10(x); }, 1, 2, until_no_number},
      {"pow", power, nullptr, 2, 2},
      {"atan2", atan2_of, nullptr, 2, 2},
      {"min", minimum, nullptr, 0, kAny, until_no_number},
      {"max", maximum, nullptr, 0, kAny, until_no_number},
      {"rands", random_numbers, nullptr, 3, kAny, until_no_number},
      {"norm", norm, nullptr, 1, 1},
      {"cross", cross_product, nullptr, 2, 2},
      {"lookup", lookup, nullptr, 2, 2, key_first},
      {"len", length, nullptr, 1, 1},
      {"str", concatenated_text},
      {"concat", concatenated},
      {"chr", text_of_codes},
      {"ord", code_of, nullptr, 1, 1},
      {"search", search, nullptr, 2},
      {"is_undef", is_type<Type::undef>, nullptr, 1, 1},
      {"is_bool", is_type<Type::boolean>, nullptr, 1, 1},
      {"is_string", is_type<Type::string>, nullptr, 1, 1},
      {"is_list", is_type<Type::vector>, nullptr, 1, 1},
      {"is_function", is_type<Type::function>, nullptr, 1, 1},
      {"is_num", is_num, nullptr, 1, 1},
      {"version", version, nullptr, 0, 0},
      {"version_num", version_number, nullptr, 0, kAny, until_no_number},
      {"parent_module", parent_module, nullptr, 0, 1},
      {"dxf_dim", dxf_dimension},
      {"dxf_cross", dxf_crossing},
  };
  return table;
}

}  // namespace kerf::scad

// Numbers with units: the units of each kind of key, and what is wrong with a text.
#include "base/quantity.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/formula.h"
#include "base/names.h"
#include "base/number.h"

#include "kerf/base/units.h"

namespace kerf {
namespace {

struct Unit {
  std::string_view of_key, name;
  double factor;
};
constexpr double kInch = kMmPerInch;
constexpr std::array kUnits{
    Unit{"mm", "mm", 1},
    Unit{"mm", "cm", 10},
    Unit{"mm", "m", 1000},
    Unit{"mm", "um", 0.001},
    Unit{"mm", "in", kInch},
    Unit{"mm", "inch", kInch},
    Unit{"mm", "inches", kInch},
    Unit{"mm", "\"", kInch},
    Unit{"mm", "mil", 0.001 * kInch},
    Unit{"mm", "thou", 0.001 * kInch},
    Unit{"mm/min", "mm/min", 1},
    Unit{"mm/min", "mmpm", 1},
    Unit{"mm/min", "mm/s", 60},
    Unit{"mm/min", "m/min", 1000},
    Unit{"mm/min", "in/min", kInch},
    Unit{"mm/min", "ipm", kInch},
    Unit{"mm/min", "in/s", 60 * kInch},
    Unit{"mm/min", "ips", 60 * kInch},
    Unit{"degrees", "deg", 1},
    Unit{"degrees", "degree", 1},
    Unit{"degrees", "degrees", 1},
    Unit{"degrees", "rad", 180 / std::numbers::pi},
    Unit{"s", "s", 1},
    Unit{"s", "ms", 0.001},
    Unit{"s", "min", 60},
    Unit{"rpm", "rpm", 1},
    Unit{"rpm", "krpm", 1000},
    Unit{"%", "%", 1},
    Unit{"", "%", 0.01},
};

/// A unit of keys, the one in which its units are listed above, and its size in that one.
constexpr std::array kInchKeys{Unit{"mm", "inch", kInch}, Unit{"mm/min", "inch/min", kInch}};
Unit listed(std::string_view of_key) {
  for (const Unit& unit : kInchKeys)
    if (unit.name == of_key) return unit;
  return {of_key, of_key, 1};
}

std::string text_of(const FormulaFault& fault, std::string_view text, std::string_view of_key) {
  using Kind = FormulaFault::Kind;
  const std::string at = fmt::format(" at character {} of \"{}\"", fault.offset + 1, clipped(text, 60));
  switch (fault.kind) {
    case Kind::bracket_missing: return fmt::format("{} is missing", fault.symbol) + at;
    case Kind::unknown_variable: return fmt::format("unknown name {}", clipped(fault.symbol, 60)) + at;
    case Kind::not_finite: return fmt::format("\"{}\" is not finite", clipped(text, 60));
    case Kind::too_deep: return "too many brackets and signs" + at;
    case Kind::rest: return "expected an end, an operator or a unit" + at;
    case Kind::unexpected: return "expected a number" + at;
    case Kind::unknown_unit: break;
  }
  std::string known;
  for (const Unit& unit : kUnits)
    if (unit.of_key == listed(of_key).of_key) known += (known.empty() ? "" : ", ") + std::string(unit.name);
  return fmt::format("unknown unit {}{}{}", clipped(fault.symbol, 60), at,
                     known.empty() ? "; the key has no unit" : "; units are " + known);
}

}  // namespace

std::optional<double> unit_factor(std::string_view unit, std::string_view of_key) {
  const Unit key = listed(of_key);
  for (const Unit& known : kUnits)
    if (known.of_key == key.of_key && fold_name(known.name) == fold_name(unit))
      return known.factor / key.factor;
  return std::nullopt;
}

std::optional<double> read_quantity(std::string_view text, std::string_view of_key,
                                    const QuantityNames& names, std::string& fault) {
  if (const auto plain = parse_number(trim(text))) return plain;
  FormulaFault found;
  const FormulaWords words{.name = names ? names : [](std::string_view) { return std::optional<double>(); },
                           .unit = [&](std::string_view unit) { return unit_factor(unit, of_key); }};
  const auto value = evaluate_formula(text, words, found);
  if (!value) fault = text_of(found, text, of_key);
  return value;
}

}  // namespace kerf

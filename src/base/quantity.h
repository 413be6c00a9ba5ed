// Numbers with units and formulas, as keys and options have them: "1/4in", "60ipm", "stock.z + 0.2".
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace kerf {

/// The factor from `unit` ("in", "ipm", "%") to the unit of a key: "mm", "mm/min", "inch", "inch/min",
/// "degrees", "s", "rpm", "%", or empty for a fraction. Nothing: it is no such unit.
std::optional<double> unit_factor(std::string_view unit, std::string_view of_key);

using QuantityNames = std::function<std::optional<double>(std::string_view name)>;
/// The value of a text in the unit of a key; plain numbers are in that unit. Nothing, with `fault` set to
/// what is wrong with it, if it has none.
std::optional<double> read_quantity(std::string_view text, std::string_view of_key,
                                    const QuantityNames& names, std::string& fault);

}  // namespace kerf

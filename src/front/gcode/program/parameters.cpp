// Storage of parameters, with the scopes of names.
#include "front/gcode/program/parameters.h"

#include <algorithm>

namespace kerf::gcode {

std::string normal_name(std::string_view text) {
  std::string name;
  for (const char c : text) {
    if (c == ' ' || c == '\t') continue;
    name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return name;
}

std::optional<double> Parameters::number(int number) const {
  if (number < 1 || number > kLast) return std::nullopt;
  if (const auto value = system_.system_number(number)) return value;
  return slot(number) / system_.unit_of(number);
}

bool Parameters::set_number(int number, double value) {
  if (number < 1 || number > kLast) return false;
  slot(number) = value * system_.unit_of(number);
  return true;
}

std::optional<double> Parameters::name(const std::string& name) const {
  if (name.empty()) return std::nullopt;
  const bool global = name.front() == '_';
  const Names& names = global ? globals_ : frames_.back().names;
  if (const auto found = names.find(name); found != names.end()) return found->second;
  return global ? system_.system_name(name) : std::nullopt;
}

void Parameters::set_name(const std::string& name, double value) {
  (!name.empty() && name.front() == '_' ? globals_ : frames_.back().names).insert_or_assign(name, value);
}

void Parameters::enter(std::span<const double> arguments) {
  frames_.emplace_back();
  std::copy_n(numbers_.begin() + 1, kArguments, frames_.back().caller.begin());
  std::fill_n(numbers_.begin() + 1, kArguments, 0.0);
  std::copy_n(arguments.begin(), std::min(arguments.size(), kArguments), numbers_.begin() + 1);
}

void Parameters::leave() {
  std::copy(frames_.back().caller.begin(), frames_.back().caller.end(), numbers_.begin() + 1);
  frames_.pop_back();
}

}  // namespace kerf::gcode

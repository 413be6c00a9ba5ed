// Storage of parameters, with the scopes of names.
#include "front/gcode/program/parameters.h"

namespace kerf::gcode {

std::string normal_name(std::string_view text) {
  std::string name;
  for (const char c : text) {
    if (c == ' ' || c == '\t') continue;
    name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return name;
}

void Parameters::mark(int number, bool unknown) {
  if (unknown)
    unknown_.insert(number);
  else if (!unknown_.empty())
    unknown_.erase(number);
}

std::optional<ParameterValue> Parameters::number(int number) const {
  if (number < 1 || number > kLast) return std::nullopt;
  const bool unknown = unknown_.count(number) != 0 || system_.is_unknown_number(number);
  if (const auto value = system_.system_number(number)) return ParameterValue{*value, unknown};
  return ParameterValue{slot(number) / system_.unit_of(number), unknown};
}

bool Parameters::set_number(int number, ParameterValue value) {
  if (number < 1 || number > kLast) return false;
  slot(number) = value.value * system_.unit_of(number);
  mark(number, value.unknown);
  if (number >= kFirstStored) assigned_.insert(number);
  return true;
}

void Parameters::store(int number, double value) {
  slot(number) = value;
  mark(number, false);
  assigned_.erase(number);
}

std::optional<ParameterValue> Parameters::name(const std::string& name) const {
  if (name.empty()) return std::nullopt;
  const bool global = name.front() == '_';
  const Names& names = global ? globals_ : frames_.back().names;
  if (const auto found = names.find(name); found != names.end()) return found->second;
  const auto value = global ? system_.system_name(name) : std::nullopt;
  if (!value) return std::nullopt;
  return ParameterValue{*value, system_.is_unknown_name(name)};
}

void Parameters::set_name(const std::string& name, ParameterValue value) {
  (!name.empty() && name.front() == '_' ? globals_ : frames_.back().names).insert_or_assign(name, value);
}

void Parameters::enter(std::span<const ParameterValue> arguments) {
  frames_.emplace_back();
  for (std::size_t i = 0; i < kArguments; ++i) {
    const int number = static_cast<int>(i) + 1;
    frames_.back().caller[i] = {slot(number), unknown_.count(number) != 0};
    const ParameterValue argument = i < arguments.size() ? arguments[i] : ParameterValue{};
    slot(number) = argument.value;
    mark(number, argument.unknown);
  }
}

void Parameters::leave() {
  for (std::size_t i = 0; i < kArguments; ++i) {
    const int number = static_cast<int>(i) + 1;
    slot(number) = frames_.back().caller[i].value;
    mark(number, frames_.back().caller[i].unknown);
  }
  frames_.pop_back();
}

}  // namespace kerf::gcode

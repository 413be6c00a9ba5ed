// Storage of parameters, with the scopes of names.
#include "front/gcode/program/parameters.h"

namespace kerf::gcode {
namespace {

/// Fanuc's variables of the control itself (tool offsets, timers, modes), whose values Kerf does not know.
constexpr int kFirstSystem = 1000, kLastSystem = 5061;

}  // namespace

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

void Parameters::note_given(int number, const ParameterValue& value) {
  if (!has_vacant_) return;
  if (value.vacant)
    given_.erase(number);
  else
    given_.insert(number);
}

std::optional<ParameterValue> Parameters::number(int number) const {
  if (number == 0 && has_vacant_) return ParameterValue::nothing();
  if (number < 1 || number > kLast) return std::nullopt;
  const bool not_given = has_vacant_ && given_.count(number) == 0;
  if (not_given && number < kFirstSystem) return ParameterValue::nothing();
  const bool is_of_control = not_given && number < kLastSystem;
  const bool unknown = unknown_.count(number) != 0 || system_.is_unknown_number(number) || is_of_control;
  if (const auto value = system_.system_number(number)) return ParameterValue{*value, unknown};
  return ParameterValue{slot(number) / system_.unit_of(number), unknown};
}

bool Parameters::set_number(int number, ParameterValue value) {
  if (number < 1 || number > kLast) return false;
  slot(number) = value.value * system_.unit_of(number);
  mark(number, value.unknown);
  note_given(number, value);
  if (has_vacant_ && (number == kAlarm || number == kMessage)) stop_ = number;
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

/// Of a local variable.
void Parameters::put(int number, const ParameterValue& value) {
  slot(number) = value.value;
  mark(number, value.unknown);
  note_given(number, value);
}

ParameterValue Parameters::taken(int number) const {
  ParameterValue value{slot(number), unknown_.count(number) != 0};
  value.vacant = has_vacant_ && given_.count(number) == 0;
  return value;
}

void Parameters::enter(std::span<const ParameterValue> arguments) {
  frames_.emplace_back();
  const ParameterValue none = has_vacant_ ? ParameterValue::nothing() : ParameterValue{};
  for (std::size_t i = 0; i < locals(); ++i) {
    const int number = static_cast<int>(i) + 1;
    frames_.back().caller[i] = taken(number);
    put(number, i < arguments.size() ? arguments[i] : none);
  }
}

void Parameters::leave() {
  for (std::size_t i = 0; i < locals(); ++i) put(static_cast<int>(i) + 1, frames_.back().caller[i]);
  frames_.pop_back();
}

}  // namespace kerf::gcode

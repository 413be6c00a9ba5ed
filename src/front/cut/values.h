// Values of keys: numbers, texts, and names of choices.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "base/names.h"

#include "kerf/program/cut_job.h"

namespace kerf::cut_detail {

inline std::optional<double> number(const CutValue& value) {
  const double* given = std::get_if<double>(&value);
  return given != nullptr && std::isfinite(*given) ? std::optional(*given) : std::nullopt;
}

template <class Value, std::size_t N>
struct Names {
  std::array<std::pair<std::string_view, Value>, N> rows;
};

template <class Value, std::size_t N>
bool set_named(const Names<Value, N>& names, Value& target, const CutValue& value) {
  const auto* given = std::get_if<std::string>(&value);
  if (given == nullptr) return false;
  for (const auto& [name, meaning] : names.rows)
    if (fold_name(name) == fold_name(*given)) {
      target = meaning;
      return true;
    }
  return false;
}

inline bool set_list(std::vector<std::string>& target, const CutValue& value) {
  if (const auto* one = std::get_if<std::string>(&value)) target = {*one};
  const auto* many = std::get_if<std::vector<std::string>>(&value);
  if (many != nullptr) target = *many;
  return !std::holds_alternative<double>(value) && !target.empty();
}

/// "10, 20"
bool set_point(Point2& target, const CutValue& value);

inline bool set_text(std::string& target, const CutValue& value) {
  const auto* given = std::get_if<std::string>(&value);
  if (given != nullptr) target = *given;
  return given != nullptr && !given->empty();
}
/// Stores a number made by `make`, such as mm.
template <class Value, class Make>
bool set_number(Value& target, const CutValue& value, Make make) {
  const auto given = number(value);
  if (given) target = make(*given);
  return given.has_value();
}

}  // namespace kerf::cut_detail

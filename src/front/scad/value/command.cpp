// Calls of commands: typed arguments and messages.
#include "front/scad/value/command.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/scad.h"

namespace kerf::scad {

Call::Call(const Command& command, CommandState* state, CallSite& site, Diagnostics& diagnostics,
           std::vector<Value> arguments, const Object* object)
    : command_(command),
      state_(state),
      site_(site),
      diagnostics_(diagnostics),
      arguments_(std::move(arguments)),
      object_(object) {
  arguments_.resize(std::max(arguments_.size(), command.parameters.size()), Value::unset());
  given_.reserve(arguments_.size());
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    given_.push_back(!arguments_[i].is(Type::unset));
    if (!given_[i]) arguments_[i] = command.parameters[i].standard;
  }
}

std::size_t Call::index_of(std::string_view name) const {
  const auto& all = command_.parameters;
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& p) { return p.name == name; });
  assert(found != all.end());
  return static_cast<std::size_t>(found - all.begin());
}

void Call::wrong(std::size_t i, std::string_view expected) {
  const auto& all = command_.parameters;
  const std::string name = i < all.size() ? std::string(all[i].name) : fmt::format("argument {}", i + 1);
  constexpr std::size_t kShown = 60;
  std::string shown = arguments_[i].is(Type::vector) ? "a vector" : to_string(arguments_[i]);
  if (shown.size() > kShown) shown = std::string("a ") + std::string(name_of(arguments_[i].type()));
  error(codes::scad_argument,
        fmt::format("{}(): {} is {}; expected {}", command_.name, name, shown, expected));
}

std::optional<double> Call::number(std::size_t i) {
  const Value& v = arguments_[i];
  if (v.is_number() && std::isfinite(v.number())) return v.number();
  wrong(i, "a finite number");
  return std::nullopt;
}

std::optional<double> Call::number_in(std::size_t i, double low, double high) {
  const Value& v = arguments_[i];
  if (v.is_number() && v.number() >= low && v.number() <= high) return v.number();
  wrong(i, fmt::format("a number from {} to {}", to_string(low), to_string(high)));
  return std::nullopt;
}

std::optional<int> Call::integer(std::size_t i, int low, int high) {
  const Value& v = arguments_[i];
  if (v.is_number() && v.number() >= low && v.number() <= high && v.number() == std::floor(v.number()))
    return static_cast<int>(v.number());
  wrong(i, fmt::format("a whole number from {} to {}", low, high));
  return std::nullopt;
}

std::optional<std::string> Call::text(std::size_t i) {
  if (arguments_[i].is(Type::string)) return arguments_[i].text();
  wrong(i, "a string");
  return std::nullopt;
}

std::optional<bool> Call::truth(std::size_t i) {
  const Value& v = arguments_[i];
  if (v.is(Type::boolean) || (v.is_number() && std::isfinite(v.number()))) return v.is_true();
  wrong(i, "true or false");
  return std::nullopt;
}

std::optional<Point3> Call::point(std::size_t i) {
  const auto x = number(i), y = number(i + 1), z = number(i + 2);
  if (!x || !y || !z) return std::nullopt;
  return Point3{*x, *y, *z};
}

std::optional<std::vector<double>> Call::numbers(std::size_t i) {
  const auto is_finite = [](const Value& v) { return v.is_number() && std::isfinite(v.number()); };
  const Value& v = arguments_[i];
  if (!v.is(Type::vector) || !std::all_of(v.items().begin(), v.items().end(), is_finite)) {
    wrong(i, "a vector of finite numbers");
    return std::nullopt;
  }
  std::vector<double> list;
  for (const Value& item : v.items()) list.push_back(item.number());
  return list;
}

std::optional<std::vector<std::vector<double>>> Call::points(std::size_t i, std::size_t dimension) {
  const auto is_point = [&](const Value& p) {
    return p.is(Type::vector) && p.items().size() == dimension &&
           std::all_of(p.items().begin(), p.items().end(),
                       [](const Value& v) { return v.is_number() && std::isfinite(v.number()); });
  };
  const Value& v = arguments_[i];
  if (!v.is(Type::vector) || !std::all_of(v.items().begin(), v.items().end(), is_point)) {
    wrong(i, fmt::format("a vector of points, each of {} finite numbers", dimension));
    return std::nullopt;
  }
  std::vector<std::vector<double>> list;
  for (const Value& p : v.items()) {
    list.emplace_back();
    for (const Value& item : p.items()) list.back().push_back(item.number());
  }
  return list;
}

Diagnostic& Call::with_callers(Diagnostic& message) {
  for (DiagnosticNote& n : site_.callers()) message.notes.push_back(std::move(n));
  return message;
}
Diagnostic& Call::error(Code code, std::string message) {
  failed_ = true;
  return with_callers(diagnostics_.error(code, where(), std::move(message)));
}
Diagnostic& Call::warning(Code code, std::string message) {
  return with_callers(diagnostics_.warning(code, where(), std::move(message)));
}
Diagnostic& Call::note(Code code, std::string message) {
  return with_callers(diagnostics_.note(code, where(), std::move(message)));
}

}  // namespace kerf::scad

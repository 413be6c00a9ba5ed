// Calls of commands: typed arguments, parameters from text.
#include "design/call/call.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/names.h"
#include "base/number.h"

namespace kerf::design {
namespace {

constexpr std::size_t kMaxShown = 60;  // bytes of a value in a message

Value constant(std::string_view text) {
  if (text == "undef") return {};
  if (text == "true" || text == "false") return Value::truth(text == "true");
  if (text.front() == '"') return std::string(text.substr(1, text.size() - 2));
  const auto number = parse_number(text);
  assert(number);
  return *number;
}

std::string text_of(const Parameter& parameter) {
  std::string text(parameter.name);
  if (parameter.required) return text;
  const Value& v = parameter.standard;
  return text + "=" + (v.is(Type::text) ? "\"" + v.text() + "\"" : design::text_of(v));
}

}  // namespace

void refuse(std::string message) { throw Refusal{Problem::value, std::move(message)}; }
void refuse_type(std::string message) { throw Refusal{Problem::type, std::move(message)}; }
void refuse_now(std::string message) { throw Refusal{Problem::state, std::move(message)}; }

std::vector<Parameter> parameters_of(std::string_view signature) {
  std::vector<Parameter> parameters;
  while (!signature.empty()) {
    const std::size_t comma = std::min(signature.find(','), signature.size());
    const std::string_view one = trim(signature.substr(0, comma));
    signature.remove_prefix(std::min(comma + 1, signature.size()));
    const std::size_t equals = one.find('=');
    if (equals == std::string_view::npos)
      parameters.push_back({one, {}, true});
    else
      parameters.push_back({one.substr(0, equals), constant(one.substr(equals + 1)), false});
  }
  return parameters;
}

std::string signature_of(const Command& command) {
  std::string text;
  for (const Parameter& parameter : command.parameters)
    text += (text.empty() ? "" : ", ") + text_of(parameter);
  return fmt::format("{}({}{})", command.name, text, command.further == Further::taken ? ", ..." : "");
}

std::string forms_of(const Command& command) {
  if (!command.numbers_without_tool) return {};
  Command without = command;
  without.parameters.erase(without.parameters.begin());
  return fmt::format("{} or, with the number of a tool, {}", signature_of(without), signature_of(command));
}

std::size_t first_parameter(const Command& command, std::size_t numbers,
                            std::span<const std::string_view> names) {
  if (!command.numbers_without_tool) return 0;
  const std::size_t expected = *command.numbers_without_tool;
  const auto& all = command.parameters;
  if (std::find(names.begin(), names.end(), all.front().name) != names.end()) return 0;
  for (std::size_t i = 1; i <= expected; ++i)
    if (std::find(names.begin(), names.end(), all[i].name) != names.end()) ++numbers;
  return numbers == expected + 1 || numbers == all.size() ? 0 : 1;
}

void Call::wrong_type(std::size_t i, std::string_view expected) const {
  const std::string parameter = i < command_.parameters.size() ? std::string(command_.parameters[i].name)
                                                               : fmt::format("argument {}", i + 1);
  refuse_type(
      fmt::format("{} must be {}, not {}", parameter, expected, clipped(site_.shown((*this)[i]), kMaxShown)));
}

void Call::not_a_number(std::size_t i) const {
  if (!(*this)[i].is(Type::number)) wrong_type(i, "a number");
  refuse(fmt::format("{} must be a finite number, not {}", command_.parameters[i].name,
                     site_.shown((*this)[i])));
}

const std::string& Call::text(std::size_t i) const {
  if (!(*this)[i].is(Type::text)) wrong_type(i, "a text");
  return (*this)[i].text();
}

bool Call::truth(std::size_t i) const {
  const Value& v = (*this)[i];
  if (!v.is(Type::truth) && !(v.is(Type::number) && std::isfinite(v.number())))
    wrong_type(i, "true or false");
  return v.is_true();
}

std::optional<double> Call::optional_number(std::size_t i) const {
  if ((*this)[i].is(Type::undefined)) return std::nullopt;
  return number(i);
}

std::optional<std::string> Call::optional_text(std::size_t i) const {
  if ((*this)[i].is(Type::undefined)) return std::nullopt;
  return text(i);
}

}  // namespace kerf::design

// Rows of the table of commands: parameters from text, arguments, errors.
#include "front/scad/commands/bindings.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/names.h"
#include "base/number.h"

#include "kerf/base/limits.h"

namespace kerf::scad {
namespace {

Value constant(std::string_view text) {
  if (text == "undef") return {};
  if (text == "true" || text == "false") return Value::truth(text == "true");
  if (text.front() == '"') return Value::string(std::string(text.substr(1, text.size() - 2)));
  const auto number = parse_number(text);
  assert(number);
  return *number;
}

template <class T>
T required(const std::optional<T>& value) {
  if (!value) throw Reported{};
  return *value;
}

std::string text_of(const CommandParameter& parameter) {
  std::string text(parameter.name);
  if (parameter.required) return text;
  const Value& v = parameter.standard;
  return text + "=" + (v.is(Type::string) ? "\"" + v.text() + "\"" : to_string(v));
}

Rows make_table() {
  Rows rows;
  add_object_commands(rows);
  add_motion_commands(rows);
  add_arc_commands(rows);
  add_tool_commands(rows);
  add_stock_commands(rows);
  add_drawing_commands(rows);
  add_rectangle_commands(rows);
  add_joint_commands(rows);
  add_printing_commands(rows);
  add_shape_commands(rows);
  add_text_commands(rows);
  add_surface_commands(rows);
  add_file_commands(rows);
  return rows;
}

}  // namespace

std::vector<CommandParameter> parameters_of(std::string_view signature) {
  std::vector<CommandParameter> parameters;
  while (!signature.empty()) {
    const std::size_t comma = std::min(signature.find(','), signature.size());
    const std::string_view one = trim(signature.substr(0, comma));
    signature.remove_prefix(std::min(comma + 1, signature.size()));
    const std::size_t equals = one.find('=');
    if (equals == std::string_view::npos)
      parameters.emplace_back(one);
    else
      parameters.emplace_back(one.substr(0, equals), constant(one.substr(equals + 1)));
  }
  return parameters;
}

double number(Call& call, std::size_t i) { return required(call.number(i)); }
std::string text(Call& call, std::size_t i) { return required(call.text(i)); }
bool truth(Call& call, std::size_t i) { return required(call.truth(i)); }
Point2 point2(Call& call, std::size_t i) {
  const auto x = call.number(i), y = call.number(i + 1);
  return {required(x), required(y)};
}
Point3 point3(Call& call, std::size_t i) { return required(call.point(i)); }
int tool_number(Call& call, std::size_t i) { return required(call.integer(i, 0, limits::kMaxToolNumber)); }
std::optional<double> optional_number(Call& call, std::size_t i) {
  if (call[i].is_undef()) return std::nullopt;
  return number(call, i);
}
std::optional<std::string> optional_text(Call& call, std::size_t i) {
  if (call[i].is_undef()) return std::nullopt;
  return text(call, i);
}

Value run_guarded(Call& call, Question question, Needs needs) {
  MachineState& machine = call.state<MachineState>();
  const MachineState::Running running(machine, call);
  try {
    if (!machine.started() && needs == Needs::machine) refuse_now("gcp = gcodepreview(...) must come first");
    return question(machine, call);
  } catch (const CommandError& error) {
    call.error(error.code, std::string(call.command().name) + ": " + error.message);
  } catch (const Reported&) {  // by the call, or by what the command has used
  }
  return {};
}

const std::vector<Command>& commands() {
  static const std::vector<Command> table = make_table();
  return table;
}

std::string signature_of(const Command& command) {
  std::string text;
  for (const CommandParameter& parameter : command.parameters)
    text += (text.empty() ? "" : ", ") + text_of(parameter);
  return fmt::format("{}({}{})", command.name, text,
                     command.further == FurtherArguments::taken ? ", ..." : "");
}

std::unique_ptr<CommandState> make_state(const CommandOptions& options) {
  return std::make_unique<MachineState>(options);
}

}  // namespace kerf::scad

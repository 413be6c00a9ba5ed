// The tables of commands by family, and how a row of them is made.
//
//   constexpr const char* kEnd = "ex, ey, ez";
//   void rapid(Machine& machine, Call& call) { machine.rapid(call.point3(0)); }
//   rows.push_back(motion<rapid>("rapidXYZ", kEnd, "As rapid."));
//
// A row is a name, its parameters, what it does, and a function. Python's methods and OpenSCAD's modules are
// made from the rows: their texts are the docstrings of the former.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "design/machine/machine.h"

namespace kerf::design {

/// A number of a tool; where it is left out, that of the tool in use.
int tool_number(const Machine& machine, const Call& call, std::size_t i);

using Action = void (*)(Machine&, Call&);
using Question = Value (*)(Machine&, Call&);

template <Action action>
Value run_action(Machine& machine, Call& call) {
  action(machine, call);
  return {};
}
/// A command without a value.
template <Action action>
Command row(std::string_view name, std::string_view signature, std::string text = {}) {
  return {name, parameters_of(signature), run_action<action>, std::move(text)};
}
/// A command that moves the tool.
template <Action action>
Command motion(std::string_view name, std::string_view signature, std::string text = {}) {
  return {name, parameters_of(signature), run_action<action>, std::move(text), Gives::motions};
}
/// A command with a value.
template <Question question>
Command asking(std::string_view name, std::string_view signature, std::string text = {}) {
  return {name, parameters_of(signature), question, std::move(text), Gives::value};
}
/// A command that may precede gcodepreview().
inline Command without_start(Command command) {
  command.needs_start = false;
  return command;
}
/// A command with a value, which may precede gcodepreview(): those of shapes.
template <Question question>
Command making(std::string_view name, std::string_view signature, std::string text = {}) {
  return without_start(asking<question>(name, signature, std::move(text)));
}
/// A command whose first parameter, the number of a tool, may be left out; `numbers` come first then.
inline Command tool_may_be_left_out(Command command, std::size_t numbers) {
  command.numbers_without_tool = numbers;
  return command;
}
/// With further positional arguments.
inline Command with_further(Command command) {
  command.further = Further::taken;
  return command;
}

/// The G-code file of the following motions, and its end.
void open_gcode_file(Machine& machine, const std::string& name);
void close_gcode_file(Machine& machine);

using Rows = std::vector<Command>;
void add_object_commands(Rows& rows);
void add_motion_commands(Rows& rows);
void add_arc_commands(Rows& rows);
void add_tool_commands(Rows& rows);
void add_tool_descriptions(Rows& rows);
void add_stock_commands(Rows& rows);
void add_drawing_commands(Rows& rows);
void add_rectangle_commands(Rows& rows);
void add_joint_commands(Rows& rows);
void add_printing_commands(Rows& rows);
void add_shape_commands(Rows& rows);
void add_text_commands(Rows& rows);
void add_surface_commands(Rows& rows);
void add_file_commands(Rows& rows);

}  // namespace kerf::design

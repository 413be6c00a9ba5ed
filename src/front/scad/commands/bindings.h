// The tables of commands by family, and how a row of them is made.
//
//   constexpr const char* kEnd = "ex, ey, ez";
//   void rapid(MachineState& machine, Call& call) { machine.rapid(point(call, 0)); }
//   rows.push_back(row<rapid>("rapid", kEnd));
//
// A command has the name and the parameters of the method of the Python module, in its order.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "front/scad/commands/machine_state.h"

namespace kerf::scad {

/// The parameters of "ex, ey, laser=0, name="Default", outline=undef, joined=true". The text must outlive
/// them.
std::vector<CommandParameter> parameters_of(std::string_view signature);

/// Arguments; a wrong one is reported and ends the command.
double number(Call& call, std::size_t i);
std::string text(Call& call, std::size_t i);
bool truth(Call& call, std::size_t i);
Point2 point2(Call& call, std::size_t i);
Point3 point3(Call& call, std::size_t i);
/// A number of a tool.
int tool_number(Call& call, std::size_t i);
/// The argument, or nothing for undef.
std::optional<double> optional_number(Call& call, std::size_t i);
std::optional<std::string> optional_text(Call& call, std::size_t i);

using Action = void (*)(MachineState&, Call&);
using Question = Value (*)(MachineState&, Call&);

/// Whether a command requires gcodepreview() before it.
enum class Needs : unsigned char { machine, nothing };
/// Runs what a command does, and reports its error.
Value run_guarded(Call& call, Question question, Needs needs);

template <Question question, Needs needs>
Value run_question(Call& call) {
  return run_guarded(call, question, needs);
}
template <Action action>
Value run_action(Call& call) {
  const auto run = [](MachineState& machine, Call& inner) {
    action(machine, inner);
    return Value();
  };
  return run_guarded(call, run, Needs::machine);
}
template <Action action>
Command row(std::string_view name, std::string_view signature) {
  return {name, parameters_of(signature), run_action<action>, FurtherArguments::refused};
}
/// A command with a value.
template <Question question, Needs needs = Needs::machine>
Command asking(std::string_view name, std::string_view signature,
               FurtherArguments further = FurtherArguments::refused) {
  return {name, parameters_of(signature), run_question<question, needs>, further};
}

using Rows = std::vector<Command>;
void add_object_commands(Rows& rows);
void add_motion_commands(Rows& rows);
void add_arc_commands(Rows& rows);
void add_tool_commands(Rows& rows);
void add_stock_commands(Rows& rows);
void add_drawing_commands(Rows& rows);
void add_rectangle_commands(Rows& rows);
void add_joint_commands(Rows& rows);
void add_printing_commands(Rows& rows);
void add_shape_commands(Rows& rows);
void add_text_commands(Rows& rows);
void add_surface_commands(Rows& rows);
void add_file_commands(Rows& rows);

}  // namespace kerf::scad

// The table of all commands, and what runs one of them.
#include "design/commands/rows.h"

#include <cmath>
#include <fmt/format.h>

#include "design/commands/commands.h"

#include "kerf/base/limits.h"

namespace kerf::design {
namespace {

Rows make_table() {
  Rows rows;
  add_object_commands(rows);
  add_motion_commands(rows);
  add_arc_commands(rows);
  add_tool_commands(rows);
  add_tool_descriptions(rows);
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

int tool_number(const Machine& machine, const Call& call, std::size_t i) {
  const bool two_forms = i == 0 && call.command().numbers_without_tool.has_value();
  if (two_forms && call[i].is(Type::undefined)) return machine.tool().given;
  const double number = call.number(i);
  if (two_forms && !(number == std::floor(number) && number >= 0.0))
    refuse(fmt::format("{:g} is no number of a tool; the forms are {}", number, forms_of(call.command())));
  return whole(number, call.name(i), 0, limits::kMaxToolNumber);
}

const std::vector<Command>& commands() {
  static const std::vector<Command> table = make_table();
  return table;
}

Value run(Machine& machine, Call& call) {
  const Command& command = call.command();
  const Machine::Running running(machine, call);
  try {
    if (command.needs_start && !machine.started()) refuse_now("gcp = gcodepreview(...) must come first");
    return command.run(machine, call);
  } catch (const Refusal& refusal) {
    call.site().error(refusal.problem, std::string(command.name) + ": " + refusal.message);
  } catch (const Reported&) {  // by what the command has used
  }
  return {};
}

}  // namespace kerf::design

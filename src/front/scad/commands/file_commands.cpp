// The files of a program: G-code and drawings. They are collected here and written by what runs the program.
#include <fmt/format.h>

#include "base/codes/scad.h"
#include "front/scad/commands/bindings.h"

namespace kerf::scad {
namespace {

std::string file_name(Call& call) {
  std::string name = text(call, 0);
  if (name.empty()) refuse("basefilename must be a file name");
  return name;
}

/// basefilename, currenttoolnum, toolradius, plunge, feed, speed
void opengcodefile(MachineState& machine, Call& call) {
  const std::string name = file_name(call);
  machine.plunge = positive(number(call, 3), "plunge");
  machine.feed = positive(number(call, 4), "feed");
  not_negative(number(call, 5), "speed");
  if (!machine.settings.gcode) return;
  if (machine.gcode_name) refuse_now("the file before is still open; call closegcodefile");
  machine.gcode_name = name + machine.settings.ending;
  machine.note("Design File: " + name);
}

/// The tool is lifted to the retract height, or what is on is switched off; the post writes the end.
void gcodepostamble(MachineState& machine, Call&) { machine.end_program(); }

void closegcodefile(MachineState& machine, Call&) {
  if (!machine.settings.gcode) return;
  if (!machine.gcode_name) refuse_now("no file is open");
  machine.end_program();
  machine.close_program(*machine.gcode_name);
  machine.gcode_name.reset();
}

void opendxffile(MachineState& machine, Call& call) {
  const std::string name = file_name(call) + ".dxf";
  if (!machine.settings.dxf) return;
  if (machine.dxf_name) refuse_now("the file before is still open; call closedxffile");
  machine.dxf_name = name;
  machine.set_colour("Black");
  machine.forget_drawing();
}

void closedxffile(MachineState& machine, Call&) {
  if (!machine.settings.dxf) return;
  if (!machine.dxf_name) refuse_now("no file is open");
  if (machine.polyline) refuse_now("a polyline is open; call closepolyline");
  machine.add_file(*machine.dxf_name, machine.dxf());
  machine.dxf_name.reset();
}

void opendxffiles(MachineState& machine, Call& call) {
  machine.tools_base = file_name(call);
  std::vector<int> tools;
  for (std::size_t i = 1; i < call.size(); ++i) tools.push_back(tool_number(call, i));
  machine.sketch_tools(tools);
}

void closedxffiles(MachineState& machine, Call&) {
  for (const auto& [number, sketch] : machine.tool_sketches())
    machine.add_file(fmt::format("{}{}.dxf", machine.tools_base, number), machine.dxf_of(sketch));
  machine.tool_sketches().clear();
}

}  // namespace

void add_file_commands(Rows& rows) {
  constexpr const char* kName = "basefilename=\"export\"";
  rows.push_back(row<opengcodefile>(
      "opengcodefile",
      "basefilename=\"export\", currenttoolnum=102, toolradius=3.175, plunge=400, feed=1600, speed=10000"));
  rows.push_back(row<gcodepostamble>("gcodepostamble", ""));
  rows.push_back(row<closegcodefile>("closegcodefile", ""));
  rows.push_back(row<opendxffile>("opendxffile", kName));
  rows.push_back(row<closedxffile>("closedxffile", ""));
  rows.push_back(row<opendxffiles>(
      "opendxffiles",
      "basefilename=\"export\", large_square_tool_num=0, small_square_tool_num=0, large_ball_tool_num=0, "
      "small_ball_tool_num=0, large_V_tool_num=0, small_V_tool_num=0, DT_tool_num=0, KH_tool_num=0, "
      "Roundover_tool_num=0, MISC_tool_num=0"));
  rows.push_back(row<closedxffiles>("closedxffiles", ""));
}

CommandResult finish(CommandState& state, Diagnostics& diagnostics) {
  MachineState& machine = static_cast<MachineState&>(state);
  const auto warn_open = [&](const std::optional<std::string>& name, const char* close) {
    if (name)
      diagnostics.warning(codes::scad_call, {},
                          fmt::format("{} is not written: {}() was not called", *name, close));
  };
  warn_open(machine.gcode_name, "closegcodefile");
  warn_open(machine.dxf_name, "closedxffile");
  return machine.take();
}

}  // namespace kerf::scad

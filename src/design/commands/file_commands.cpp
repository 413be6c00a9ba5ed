// The files of a program: G-code and drawings. They are collected here and written by what runs the program.
#include <fmt/format.h>

#include "design/commands/commands.h"
#include "design/commands/rows.h"

namespace kerf::design {
namespace {

std::string file_name(Call& call) {
  std::string name = call.text(0);
  if (name.empty()) refuse("basefilename must be a file name");
  return name;
}

void check_output(Machine& machine, const std::string& name) {
  if (!machine.options().check_output) return;
  const std::size_t errors = machine.diagnostics().errors();
  machine.options().check_output(name, machine.diagnostics());
  machine.stop_after_errors(errors);
}

/// basefilename, currenttoolnum, toolradius, plunge, feed, speed
void opengcodefile(Machine& machine, Call& call) {
  const std::string name = file_name(call);
  machine.plunge = positive(call.number(3), "plunge");
  machine.feed = positive(call.number(4), "feed");
  not_negative(call.number(5), "speed");
  if (!machine.settings.gcode) return;
  if (machine.gcode_name) refuse_now("the file before is still open; call closegcodefile");
  open_gcode_file(machine, name);
}

/// The tool is lifted to the retract height, or what is on is switched off; the post writes the end.
void gcodepostamble(Machine& machine, Call&) { machine.end_program(); }

void closegcodefile(Machine& machine, Call&) {
  if (!machine.settings.gcode) return;
  if (!machine.gcode_name) refuse_now("no file is open");
  close_gcode_file(machine);
}

void opendxffile(Machine& machine, Call& call) {
  const std::string name = file_name(call) + ".dxf";
  if (!machine.settings.dxf) return;
  if (machine.dxf_name) refuse_now("the file before is still open; call closedxffile");
  machine.dxf_name = name;
  machine.set_colour("Black");
  machine.forget_drawing();
}

void closedxffile(Machine& machine, Call&) {
  if (!machine.settings.dxf) return;
  if (!machine.dxf_name) refuse_now("no file is open");
  if (machine.polyline) refuse_now("a polyline is open; call closepolyline");
  machine.add_file(*machine.dxf_name, machine.dxf());
  machine.dxf_name.reset();
}

void opendxffiles(Machine& machine, Call& call) {
  machine.tools_base = file_name(call);
  std::vector<int> tools;
  for (std::size_t i = 1; i < call.size(); ++i) tools.push_back(tool_number(machine, call, i));
  machine.sketch_tools(tools);
}

void closedxffiles(Machine& machine, Call&) {
  for (const auto& [number, sketch] : machine.tool_sketches())
    machine.add_file(fmt::format("{}{}.dxf", machine.tools_base, number), machine.dxf_of(sketch));
  machine.tool_sketches().clear();
}

}  // namespace

void open_gcode_file(Machine& machine, const std::string& name) {
  if (name.empty()) refuse("basefilename must be a file name");
  check_output(machine, name + machine.settings.ending);
  machine.open_program(name + machine.settings.ending);
  machine.note("Design File: " + name);
  machine.write_further_lines(Moment::file_opened);
}

void close_gcode_file(Machine& machine) {
  machine.end_program();
  machine.write_further_lines(Moment::file_closed);
  machine.close_program();
}

void add_file_commands(Rows& rows) {
  constexpr const char* kName = "basefilename=\"export\"";
  rows.push_back(row<opengcodefile>(
      "opengcodefile",
      "basefilename=\"export\", currenttoolnum=102, toolradius=3.175, plunge=400, feed=1600, speed=10000",
      "Open the G-code file of the following motions, and set the feeds, mm/min."));
  rows.push_back(row<gcodepostamble>(
      "gcodepostamble", "",
      "The post writes the end of the program; before it the tool is lifted to the retract "
      "height.\n"
      "\n"
      "After a print, what is on is switched off, bed and chamber too, and X runs to its end "
      "switch."));
  rows.push_back(row<closegcodefile>("closegcodefile", "", "Write the G-code file."));
  rows.push_back(row<opendxffile>("opendxffile", kName, "Open the DXF file of the following entities."));
  rows.push_back(row<closedxffile>("closedxffile", "", "Write the DXF file."));
  rows.push_back(row<opendxffiles>(
      "opendxffiles",
      "basefilename=\"export\", large_square_tool_num=0, small_square_tool_num=0, large_ball_tool_num=0, "
      "small_ball_tool_num=0, large_V_tool_num=0, small_V_tool_num=0, DT_tool_num=0, KH_tool_num=0, "
      "Roundover_tool_num=0, MISC_tool_num=0",
      "Also write one drawing for each of these tools, named by its number; 0: none."));
  rows.push_back(row<closedxffiles>("closedxffiles", "", "Write the drawings of opendxffiles."));
}

Results finish(Machine& machine, const std::function<void(std::string)>& warn) {
  const auto warn_open = [&](const std::optional<std::string>& name, const char* close) {
    if (name) warn(fmt::format("{} is not written: {}() was not called", *name, close));
  };
  warn_open(machine.gcode_name, "closegcodefile");
  warn_open(machine.dxf_name, "closedxffile");
  return machine.take();
}

}  // namespace kerf::design

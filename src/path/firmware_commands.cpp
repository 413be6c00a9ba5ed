// The tables of commands. Sources: Marlin's list of G-codes; Klipper's page "G-Codes"; Duet's "GCode
// dictionary"; Prusa's pages "Prusa-specific G-codes"; start programs of Bambu's printers and their comments.
#include "path/firmware_commands.h"

#include <algorithm>
#include <cctype>

#include "base/number.h"

namespace kerf {
namespace {

constexpr std::string_view kReports = "reports to the host", kDisplay = "the display",
                           kTimer = "the timer of the print", kCheck = "a check of the printer's kind",
                           kPlanner = "limits of motions", kAdvance = "pressure advance",
                           kMotors = "motors and their drivers", kLights = "lights",
                           kObjects = "names of the printed objects", kSensors = "sensors of the filament",
                           kPause = "a pause";

struct Code {
  int number;  // of M
  std::string_view what;
  CommandEffect effect = CommandEffect::harmless;
};
constexpr Code kCodes[] = {
    {16, kCheck},
    {17, kMotors},
    {18, kMotors},
    {25, kPause, CommandEffect::pause},
    {27, kReports},
    {31, kReports},
    {73, "the progress on the display"},
    {74, "the mass of the print"},
    {75, kTimer},
    {76, kTimer},
    {77, kTimer},
    {78, kTimer},
    {85, kMotors},
    {92, "steps of the motors"},
    {105, kReports},
    {110, "line numbers of the host"},
    {111, kReports},
    {113, kReports},
    {114, kReports},
    {115, kReports},
    {117, kDisplay},
    {118, kReports},
    {119, kReports},
    {122, kReports},
    {123, kReports},
    {142, "the temperature of the heat break"},
    {150, kLights},
    {154, kReports},
    {155, kReports},
    {201, kPlanner},
    {202, kPlanner},
    {203, kPlanner},
    {204, kPlanner},
    {205, kPlanner},
    {211, "end stops of the software"},
    {226, kPause, CommandEffect::pause},
    {240, "a camera"},
    {250, kDisplay},
    {255, kDisplay},
    {256, kDisplay},
    {300, "a beep"},
    {301, "the control of a heater"},
    {302, "the lowest temperature for extruding"},
    {304, "the control of a heater"},
    {355, kLights},
    {400, "waiting for the motions before it"},
    {405, kSensors},
    {406, kSensors},
    {407, kSensors},
    {408, kReports},
    {409, kReports},
    {412, kSensors},
    {413, "recovery after a loss of power"},
    {420, "the stored surface of the bed"},
    {486, kObjects},
    {500, "stored settings"},
    {503, kReports},
    {555, "the bounds of the print"},
    {566, kPlanner},
    {569, kMotors},
    {572, kAdvance},
    {591, kSensors},
    {593, "input shaping"},
    {600, "a pause to change the filament", CommandEffect::pause},
    {601, kPause, CommandEffect::pause},
    {862, kCheck},
    {900, kAdvance},
    {906, kMotors},
    {907, kMotors},
    {913, kMotors},
    {914, kMotors},
    {960, kLights},
    {981, "a camera"},
    {991, kDisplay},
    {1002, "flags and the display"},
    {1003, "recovery after a loss of power"},
    {1006, "a beep"},
    {1007, "the mass of the print"},
};

struct Word {
  std::string_view name;
  std::string_view what;
  CommandEffect effect = CommandEffect::harmless;
};
constexpr Word kWords[] = {
    {"BED_MESH_CLEAR", "the stored surface of the bed"},
    {"BED_MESH_PROFILE", "the stored surface of the bed"},
    {"CLEAR_PAUSE", kTimer},
    {"ECHO", kReports},
    {"EXCLUDE_OBJECT_DEFINE", kObjects},
    {"EXCLUDE_OBJECT_END", kObjects},
    {"EXCLUDE_OBJECT_START", kObjects},
    {"G29.2", "the correction by the stored surface of the bed"},
    {"G392", "the detection of clogs"},
    {"PAUSE", kPause, CommandEffect::pause},
    {"RESPOND", kReports},
    {"SET_DISPLAY_TEXT", kDisplay},
    {"SET_FAN_SPEED", "a fan"},
    {"SET_FILAMENT_SENSOR", kSensors},
    {"SET_GCODE_OFFSET", kReports},  // without values
    {"SET_GCODE_VARIABLE", "variables of macros"},
    {"SET_HEATER_TEMPERATURE", "a heater", CommandEffect::heat},
    {"SET_IDLE_TIMEOUT", kTimer},
    {"SET_INPUT_SHAPER", "input shaping"},
    {"SET_LED", kLights},
    {"SET_PRESSURE_ADVANCE", kAdvance},
    {"SET_PRINT_STATS_INFO", kDisplay},
    {"SET_RETRACTION", "retraction by the firmware"},
    {"SET_TMC_CURRENT", kMotors},
    {"SET_VELOCITY_LIMIT", kPlanner},
    {"TEMPERATURE_WAIT", "a heater", CommandEffect::heat},
    {"TIMELAPSE_TAKE_FRAME", "a camera"},
};

constexpr std::size_t kLongestName = 60;

/// "M117", "G392".
bool is_code(std::string_view name) {
  return name.size() > 1 && (name[0] == 'M' || name[0] == 'G') && name[1] >= '0' && name[1] <= '9';
}

}  // namespace

bool is_macro(const FirmwareCommand& command) {
  return command.effect == CommandEffect::unknown && !is_code(command.name);
}

FirmwareCommand firmware_command(std::string_view line) {
  FirmwareCommand command;
  for (const char c : line.substr(0, std::min(line.find_first_of(" \t;"), kLongestName)))
    command.name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto take = [&](const auto& row) { command.what = row.what, command.effect = row.effect; };
  for (const Word& row : kWords)
    if (row.name == command.name) take(row);
  if (!command.name.starts_with('M')) return command;
  const std::size_t end = std::min(command.name.find_first_not_of("0123456789", 1), command.name.size());
  const auto number = parse_number(std::string_view(command.name).substr(1, end - 1));
  if (!number) return command;
  // "M117Ready", and "M862.3", a part of M862.
  const bool is_part = end < command.name.size() && command.name[end] == '.';
  if (!is_part) command.name.resize(end);
  for (const Code& row : kCodes)
    if (row.number == *number) take(row);
  return command;
}

}  // namespace kerf
